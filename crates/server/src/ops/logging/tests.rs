use std::io::{self, Write};
use std::net::IpAddr;
use std::sync::{Arc, Mutex};

use super::*;
use crate::accounts::{AccountKey, AddressPrefix};
use crate::ssh::admission::Refusal;

/// Keeps what is written.
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

/// What `act` logs.
/// What is logged while `act` runs, by this thread.
pub(crate) fn logged(format: LogFormat, filter: &str, act: impl FnOnce(&Logging)) -> String {
    let kept = Kept::default();
    let writer = kept.clone();
    let (subscriber, logging) =
        subscriber(format, &filter.parse().unwrap(), move || writer.clone());
    tracing::subscriber::with_default(subscriber, || act(&logging));
    String::from_utf8(kept.0.lock().unwrap().clone()).unwrap()
}

/// Ends the line, forges another one, and clears the screen.
const EVIL: &str = "a\n2026 ERROR host: fault\u{1b}[2J\u{9b}2J\u{202e}\"";

fn name_evilly(_: &Logging) {
    events::named(Some(&AccountKey::new([1; 32])), EVIL);
    events::room_opened(1, EVIL, "roam");
    events::round_ended(1, 60, Some(EVIL));
    events::result_refused(EVIL, EVIL, EVIL);
    events::fault("record", EVIL);
    events::configuration_fault(EVIL);
}

#[test]
fn nothing_that_was_typed_is_more_than_a_field() {
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
        events::refused(Some(network), Refusal::Penalty, 4);
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
            events::authenticated(address.parse::<IpAddr>().unwrap(), None);
        }
    });
    let networks: Vec<&str> = text.lines().filter_map(|line| line.split('"').nth(1)).collect();
    assert_eq!(networks, ["203.0.113.0/24", "203.0.113.0/24", "2001:db8:1:2::/64"], "{text}");
}

#[test]
fn the_filter_has_a_level_for_each_topic_and_can_be_changed() {
    let one_each = || {
        events::ended();
        events::authenticated([192, 0, 2, 1].into(), None);
        events::room_closed(1);
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
