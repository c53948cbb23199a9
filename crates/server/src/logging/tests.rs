use std::io::{self, Write};
use std::net::IpAddr;
use std::sync::{Arc, Mutex};

use super::*;
use crate::accounts::AccountKey;
use crate::admission::{Outcome, Refusal};

/// A writer that stores its input.
#[derive(Clone, Default)]
struct Kept(Arc<Mutex<Vec<u8>>>);

impl Write for Kept {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap().extend(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The lines that this thread logs while `act` runs.
pub(crate) fn logged(format: LogFormat, filter: &str, act: impl FnOnce(&Logging)) -> String {
    let kept = Kept::default();
    let writer = kept.clone();
    let (subscriber, logging) =
        subscriber(format, &filter.parse().unwrap(), move || writer.clone());
    tracing::subscriber::with_default(subscriber, || act(&logging));
    String::from_utf8(kept.0.lock().unwrap().clone()).unwrap()
}

/// A text that ends the line, forges another one, and clears the screen.
const EVIL: &str = "a\n2026 ERROR host: fault\u{1b}[2J\u{9b}2J\u{202e}\"";

fn name_evilly(_: &Logging) {
    named(Some(&AccountKey::new([1; 32])), EVIL);
    room_opened(1, EVIL, "roam");
    round_ended(1, 60, Some(EVIL));
    result_refused(EVIL, EVIL, EVIL);
    fault("record", EVIL);
    configuration_fault(EVIL);
}

#[test]
fn typed_text_cannot_add_lines_or_control_characters() {
    for format in [LogFormat::Text, LogFormat::Json] {
        let text = logged(format, "trace", name_evilly);
        assert_eq!(text.lines().count(), 6, "{text}");
        let lines = text.replace('\n', "");
        assert!(!lines.contains(|char: char| char.is_control() || char == '\u{202e}'), "{text:?}");
    }
}

#[test]
fn json_has_a_field_for_each_part() {
    let text = logged(LogFormat::Json, "info", |_| {
        let network = AddressPrefix::network_of("203.0.113.7".parse().unwrap());
        connections(Some(network), ConnectionEvent::Refused(Refusal::Penalty), 4);
    });
    let line: serde_json::Value = serde_json::from_str(&text).unwrap();
    for (field, value) in [
        ("level", "INFO".into()),
        ("target", "connections".into()),
        ("message", "refused".into()),
        ("network", "203.0.113.0/24".into()),
        ("reason", "penalty".into()),
        ("count", serde_json::Value::from(4)),
    ] {
        assert_eq!(line[field], value, "{text}");
    }
    assert!(line["timestamp"].as_str().is_some_and(|time| time.ends_with('Z')));
}

#[test]
fn addresses_are_logged_as_networks() {
    let text = logged(LogFormat::Text, "info", |_| {
        for address in ["203.0.113.7", "::ffff:203.0.113.7", "2001:db8:1:2:3:4:5:6"] {
            authenticated(address.parse::<IpAddr>().unwrap(), None);
        }
    });
    let networks: Vec<&str> = text.lines().filter_map(|line| line.split('"').nth(1)).collect();
    assert_eq!(networks, ["203.0.113.0/24", "203.0.113.0/24", "2001:db8:1:2::/64"], "{text}");
}

#[test]
fn the_filter_sets_topic_levels_and_can_be_changed() {
    let one_each = || {
        ended();
        authenticated([192, 0, 2, 1].into(), None);
        room_closed(1);
        tracing::warn!("without a topic");
        tracing::error!(target: "russh", "not of this program");
    };
    let text = logged(LogFormat::Text, "info,connections=warn", |logging| {
        one_each();
        logging.set_filter(&"off,connections=info".parse().unwrap());
        one_each();
    });
    let topics: Vec<&str> =
        text.lines().filter_map(|line| line.split_whitespace().nth(2)).collect();
    let own = concat!(module_path!(), ":");
    assert_eq!(topics, ["host:", "rooms:", own, "connections:"], "{text}");
}

#[test]
fn a_filter_has_a_default_level_and_levels_for_topics() {
    let parsed = |text: &str| text.parse::<LogFilter>();
    for (text, same) in [
        ("warn", "warn"),
        ("rooms=debug", "info,rooms=debug"),
        ("off, admin=info", "off,admin=info"),
        ("info,rooms=off,rooms=warn", "info,rooms=warn"),
    ] {
        assert_eq!(parsed(text).unwrap(), parsed(same).unwrap());
    }
    for text in ["", "INFO!", "lobby=info", "rooms=loud", "rooms", "=info", "info,"] {
        assert!(parsed(text).is_err(), "{text}");
    }
}

/// The log lines of one second with `connections` from `networks`. The server refuses every third
/// connection. The others leave early.
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
        // The next second has nothing left to log.
        throttle.end_second();
    });
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn a_flood_logs_a_few_lines_a_second_with_correct_counts() {
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
fn a_summary_line_names_its_network() {
    let lines = lines(3000, 1);
    let known = lines.iter().all(|line| line["network"] == "10.0.0.0/24");
    assert!(known && lines.len() == 6, "{lines:#?}");
}

#[test]
fn occasional_connections_are_logged_one_per_line() {
    assert!(lines(2, 2).iter().all(|line| line["count"] == 1));
    assert_eq!(lines(2, 2).len(), 3);
}
