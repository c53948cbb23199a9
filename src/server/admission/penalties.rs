//! Failures of networks, in token buckets.

use std::collections::{BTreeMap, BTreeSet};
use std::net::IpAddr;
use std::time::Duration;

use super::Outcome;

/// A network that is penalised as one: a /24 of IPv4, a /64 of IPv6.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::server) enum Network {
    V4([u8; 3]),
    V6([u8; 8]),
}

/// The failures of networks that are not forgotten.
#[derive(Debug)]
pub(super) struct Penalties {
    networks: BTreeMap<Network, Failures>,
    /// The same networks in the order of their last failure or login.
    order: BTreeSet<(Duration, Network)>,
    /// The size of a bucket.
    most: f64,
    forget: Duration,
}

/// The tokens that are missing in a bucket.
#[derive(Clone, Copy, Debug)]
struct Failures {
    count: f64,
    since: Duration,
}

/// The most networks that are remembered; that is about a megabyte.
const MOST_NETWORKS: usize = 1 << 14;
/// Failures up to this share of the bucket have no effect.
const FREE_SHARE: f64 = 0.5;
/// The share of connections that is refused of a network whose bucket is empty. A person who tries
/// again a few times gets in.
const REFUSED_SHARE: f64 = 0.9;

impl Network {
    pub(in crate::server) fn of(address: IpAddr) -> Self {
        match address.to_canonical() {
            IpAddr::V4(address) => {
                let [a, b, c, _] = address.octets();
                Self::V4([a, b, c])
            }
            IpAddr::V6(address) => {
                let [a, b, c, d, e, f, g, h, ..] = address.octets();
                Self::V6([a, b, c, d, e, f, g, h])
            }
        }
    }
}

impl Penalties {
    pub(super) fn new(failures: u32, forget: Duration) -> Self {
        let (networks, order) = (BTreeMap::new(), BTreeSet::new());
        Self { networks, order, most: f64::from(failures), forget }
    }

    pub(super) fn set_limits(&mut self, failures: u32, forget: Duration) {
        (self.most, self.forget) = (f64::from(failures), forget);
    }

    /// The share of a network's connections that is refused.
    pub(super) fn refused_share(&self, network: Network, now: Duration) -> f64 {
        let failures = self.networks.get(&network).map_or(0.0, |known| self.left(*known, now));
        let free = self.most * FREE_SHARE;
        ((failures - free) / (self.most - free)).clamp(0.0, 1.0) * REFUSED_SHARE
    }

    /// Counts a connection that has ended.
    pub(super) fn charge(&mut self, network: Network, outcome: Outcome, now: Duration) {
        let cost = match outcome {
            Outcome::Served => return,
            Outcome::LeftEarly => 1.0,
            Outcome::TimedOut => 2.0,
            Outcome::BrokeProtocol => 3.0,
        };
        self.change(network, cost, now);
    }

    /// Counts a successful login.
    pub(super) fn repay(&mut self, network: Network, now: Duration) {
        if self.networks.contains_key(&network) {
            self.change(network, -1.0, now);
        }
    }

    fn change(&mut self, network: Network, cost: f64, now: Duration) {
        let before = self.networks.get(&network).map_or(0.0, |known| self.left(*known, now));
        let count = (before + cost).min(self.most);
        self.remove(network);
        if count <= 0.0 {
            return;
        }
        if self.networks.len() >= MOST_NETWORKS
            && let Some(&(_, oldest)) = self.order.first()
        {
            self.remove(oldest);
        }
        self.networks.insert(network, Failures { count, since: now });
        self.order.insert((now, network));
    }

    fn remove(&mut self, network: Network) {
        if let Some(failures) = self.networks.remove(&network) {
            self.order.remove(&(failures.since, network));
        }
    }

    /// What is not forgotten of failures.
    fn left(&self, failures: Failures, now: Duration) -> f64 {
        let time = now.saturating_sub(failures.since).as_secs_f64();
        (failures.count - time / self.forget.as_secs_f64()).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use std::net::{Ipv4Addr, Ipv6Addr};

    use super::*;

    #[test]
    fn a_mapped_address_is_in_the_network_of_its_address() {
        let address = Ipv4Addr::new(192, 0, 2, 7);
        let mapped = IpAddr::V6(address.to_ipv6_mapped());
        assert_eq!(Network::of(mapped), Network::of(IpAddr::V4(address)));
        let v6 = |text: &str| Network::of(IpAddr::V6(text.parse::<Ipv6Addr>().unwrap()));
        assert_eq!(v6("2001:db8:1:2::1"), v6("2001:db8:1:2:ffff::9"));
        assert_ne!(v6("2001:db8:1:2::1"), v6("2001:db8:1:3::1"));
    }

    /// The networks that have failed longest ago are dropped first.
    #[test]
    fn memory_for_networks_is_bounded() {
        let mut penalties = Penalties::new(20, Duration::from_secs(1000));
        let network = |number: u64| Network::V6(number.to_be_bytes());
        let time = |number: u64| Duration::from_millis(number);
        for number in 0..3 * MOST_NETWORKS as u64 {
            penalties.charge(network(number), Outcome::LeftEarly, time(number));
            penalties.charge(network(0), Outcome::LeftEarly, time(number));
        }
        assert_eq!(penalties.networks.len(), MOST_NETWORKS);
        assert_eq!(penalties.order.len(), MOST_NETWORKS);
        let last = 3 * MOST_NETWORKS as u64 - 1;
        assert!(penalties.refused_share(network(0), time(last)) > 0.8);
        for (number, is_known) in
            [(1, false), (last + 1 - MOST_NETWORKS as u64, false), (last, true)]
        {
            assert_eq!(penalties.networks.contains_key(&network(number)), is_known, "{number}");
        }
    }
}
