//! A limit of lines for events that a flood of connections repeats.
//!
//! Within a second, the first [`MOST`] pairs of an event and a network have a line of their own at once. What follows
//! is counted, and is logged when the second is over: a line with the sum for each of these pairs, and one for
//! each event with the sum of all other networks.

use std::collections::BTreeMap;
use std::mem;
use std::net::IpAddr;

use super::events;
use crate::accounts::AddressPrefix;
use crate::ssh::admission::{Outcome, Refusal};

/// What a client brings about without logging in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum ConnectionEvent {
    /// A connection was accepted.
    Accepted,
    /// A connection was refused.
    Refused(Refusal),
    /// A connection has ended before its login.
    Ended(Outcome),
}

/// Lets a few events a second through, and sums the others.
#[derive(Debug, Default)]
pub(crate) struct Throttle {
    /// The events of this second without a line; without a network, those of all that have no line.
    unlogged: BTreeMap<(ConnectionEvent, Option<AddressPrefix>), u64>,
}

/// The pairs that have a line of their own in a second.
const MOST: usize = 4;

impl Throttle {
    /// Logs an event of a client at `address`, at once or with the second.
    pub(crate) fn log(&mut self, event: ConnectionEvent, address: IpAddr) {
        let network = Some(AddressPrefix::network_of(address));
        let with_line = self.unlogged.keys().filter(|(_, network)| network.is_some()).count();
        if let Some(count) = self.unlogged.get_mut(&(event, network)) {
            *count += 1;
        } else if with_line < MOST {
            self.unlogged.insert((event, network), 0);
            write(event, network, 1);
        } else {
            *self.unlogged.entry((event, None)).or_default() += 1;
        }
    }

    /// Logs the sums of the second that is over.
    pub(crate) fn end_second(&mut self) {
        for ((event, network), count) in mem::take(&mut self.unlogged) {
            if count > 0 {
                write(event, network, count);
            }
        }
    }
}

fn write(event: ConnectionEvent, network: Option<AddressPrefix>, count: u64) {
    match event {
        ConnectionEvent::Accepted => events::accepted(network, count),
        ConnectionEvent::Refused(reason) => events::refused(network, reason, count),
        ConnectionEvent::Ended(outcome) => events::ended_early(network, outcome, count),
    }
}

#[cfg(test)]
mod tests {
    use crate::ops::logging::LogFormat;
    use crate::ops::logging::tests::logged;

    use super::*;

    /// The lines of a second in which `connections` are accepted, of so many networks, and leave early; the
    /// others are refused.
    fn lines(connections: u32, networks: u32) -> Vec<serde_json::Value> {
        let text = logged(LogFormat::Json, "info", |_| {
            let mut throttle = Throttle::default();
            for number in 0..connections {
                let address = IpAddr::from(((10 << 24) + ((number % networks) << 8)).to_be_bytes());
                let events = if number % 3 == 0 {
                    &[ConnectionEvent::Refused(Refusal::Penalty)] as &[_]
                } else {
                    &[ConnectionEvent::Accepted, ConnectionEvent::Ended(Outcome::LeftEarly)]
                };
                for event in events {
                    throttle.log(*event, address);
                }
            }
            throttle.end_second();
            // Nothing is left for the next one.
            throttle.end_second();
        });
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    }

    #[test]
    fn a_flood_is_a_few_lines_a_second_whose_sums_are_right() {
        for networks in [1, 8, 5000] {
            let lines = lines(6000, networks);
            assert!(lines.len() <= 12, "{lines:#?}");
            for (event, count) in [("accepted", 4000), ("refused", 2000), ("disconnected", 4000)] {
                let of_event = lines.iter().filter(|line| line["message"] == event);
                let sum: u64 = of_event.filter_map(|line| line["count"].as_u64()).sum();
                assert_eq!(sum, count, "{lines:#?}");
            }
        }
    }

    #[test]
    fn a_sum_names_its_network() {
        let lines = lines(3000, 1);
        let known = lines.iter().all(|line| line["network"] == "10.0.0.0/24");
        assert!(known && lines.len() == 6, "{lines:#?}");
    }

    #[test]
    fn connections_that_come_now_and_then_have_lines_of_their_own() {
        assert!(lines(2, 2).iter().all(|line| line["count"] == 1));
        assert_eq!(lines(2, 2).len(), 3);
    }
}
