//! The settings of a file: keys, comments, ranges and values. Rooms are in [`standing`](super::standing).

use std::net::SocketAddr;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::time::Duration;

use toml::de::DeValue;

use super::Config;
use crate::ops::logging::{LogFilter, UnknownLogFilter};
use cellcaster::app::parts::{Field, Setting, reject_range, toml_string};
use cellcaster::fault::document::Entry;
use cellcaster::fault::quoted;

/// In characters: the longest message of the day.
const LONGEST_MESSAGE: usize = 200;
/// In characters: the longest name of a host.
const LONGEST_NAME: usize = 40;

/// Examples of entries.
const LISTEN_EXAMPLE: &str = "listen = \"127.0.0.1:2222\"";
const LOG_EXAMPLE: &str = "log = \"info,connections=warn\"";
pub(crate) const MAPS_EXAMPLE: &str = "maps = \"/var/lib/cellcaster/maps\"";
pub(crate) const METRICS_EXAMPLE: &str = "listen = \"127.0.0.1:9464\"";

pub(crate) const LISTEN: Setting<Config> = Setting {
    key: "listen",
    about: "the address and port to listen at",
    value: &Text {
        at: |it| &mut it.listen,
        read: |entry| address(entry, LISTEN_EXAMPLE),
        write: |listen| format!("\"{listen}\""),
    },
};

/// Without a value, nothing is written.
pub(crate) const MAPS: Setting<Config> = Setting {
    key: "maps",
    about: "the folder of the host's own maps; none without this line",
    value: &Text {
        at: |it| &mut it.maps,
        read: |entry| folder(entry).map(Some),
        write: |maps| {
            maps.as_ref().map_or_else(String::new, |it| toml_string(&it.to_string_lossy()))
        },
    },
};

/// The only setting in the table `[metrics]`. Without a value, nothing is written.
pub(crate) const METRICS_LISTEN: Setting<Config> = Setting {
    key: "listen",
    about: "where Prometheus reads metrics; nowhere without this line",
    value: &Text {
        at: |it| &mut it.metrics,
        read: |entry| Some(address(entry, METRICS_EXAMPLE)),
        write: |metrics| metrics.map_or_else(String::new, |address| format!("\"{address}\"")),
    },
};

/// The settings that are texts, in the order of a file.
pub(crate) const TEXTS: [Setting<Config>; 5] = [
    LISTEN,
    Setting {
        key: "name",
        about: "the name of the host, which the lobby shows",
        value: &Text { at: |it| &mut it.name, read: name, write: |name| toml_string(name) },
    },
    Setting {
        key: "message",
        about: "the message of the day, which the lobby shows",
        value: &Text { at: |it| &mut it.message, read: message, write: |text| toml_string(text) },
    },
    Setting {
        key: "log",
        about: "what is logged: off, error, warn, info, debug or trace, and others for the topics host, \
                connections, rooms, results and admin",
        value: &Text { at: |it| &mut it.log, read: log, write: |log| format!("\"{log}\"") },
    },
    MAPS,
];

/// The settings that are numbers, in the order of a file. They follow the texts.
pub(crate) const NUMBERS: [Setting<Config>; 21] = [
    Setting {
        key: "connections",
        about: "the most visitors at a time who have logged in",
        value: &Number(1..=100_000, Place::U32(|it| &mut it.admission.connections)),
    },
    Setting {
        key: "connections-per-address",
        about: "the most connections of one address, or of one /64 of IPv6; behind a proxy, all\n\
                visitors have the same",
        value: &Number(1..=100_000, Place::U32(|it| &mut it.admission.per_address)),
    },
    Setting {
        key: "connections-per-key",
        about: "the most connections with one public key",
        value: &Number(1..=1000, Place::U32(|it| &mut it.admission.per_key)),
    },
    Setting {
        key: "startups",
        about: "the most connections at a time that have not logged in, besides; one more displaces\n\
                the oldest one of the busiest network",
        value: &Number(1..=10_000, Place::U32(|it| &mut it.admission.startups)),
    },
    Setting {
        key: "failures",
        about: "failed connections of one network after which nearly all of its new ones are\n\
                refused for a while; successful ones make up for failed ones",
        value: &Number(2..=1_000_000, Place::U32(|it| &mut it.admission.failures)),
    },
    Setting {
        key: "forget-seconds",
        about: "the time after which one of them is forgotten",
        value: &Number(1..=86_400, Place::Seconds(|it| &mut it.admission.forget)),
    },
    Setting {
        key: "accounts-per-hour",
        about: "the new accounts that one network (/24, /64) may make in an hour",
        value: &Number(1..=1_000_000, Place::U32(|it| &mut it.accounts.per_hour)),
    },
    Setting {
        key: "accounts-at-once",
        about: "how many of them at once",
        value: &Number(1..=1_000_000, Place::U32(|it| &mut it.accounts.at_once)),
    },
    Setting {
        key: "handshake-seconds",
        about: "the time in which a client exchanges keys; its version has to arrive within 3",
        value: &Number(1..=600, Place::Seconds(|it| &mut it.handshake)),
    },
    Setting {
        key: "login-seconds",
        about: "the time in which a session begins; people look at a host key, and type a passphrase",
        value: &Number(1..=3600, Place::Seconds(|it| &mut it.login)),
    },
    Setting {
        key: "login-bytes",
        about: "the most bytes of a client before it is authenticated",
        value: &Number(8192..=16 << 20, Place::U32(|it| &mut it.login_bytes)),
    },
    Setting {
        key: "bytes-per-second",
        about: "the most bytes that a client sends in a second after that; more have to wait",
        value: &Number(1024..=1 << 30, Place::U32(|it| &mut it.bytes_per_second)),
    },
    Setting {
        key: "silence-seconds",
        about: "the time after which a client that answers nothing has gone",
        value: &Number(2..=3600, Place::Seconds(|it| &mut it.silence)),
    },
    Setting {
        key: "stall-seconds",
        about: "the time after which a client that takes nothing is disconnected",
        value: &Number(2..=86_400, Place::Seconds(|it| &mut it.stall)),
    },
    Setting {
        key: "columns",
        about: "the largest window",
        value: &Number(20..=2048, Place::U16(|it| &mut it.columns)),
    },
    Setting { key: "rows", about: "", value: &Number(10..=1024, Place::U16(|it| &mut it.rows)) },
    Setting {
        key: "drain-seconds",
        about: "the time for which sessions go on when the server ends",
        value: &Number(0..=3600, Place::Seconds(|it| &mut it.drain)),
    },
    Setting {
        key: "rooms",
        about: "the most rooms at a time",
        value: &Number(2..=10_000, Place::U32(|it| &mut it.rooms)),
    },
    Setting {
        key: "watchers",
        about: "the most visitors who watch one room",
        value: &Number(0..=10_000, Place::U32(|it| &mut it.watchers)),
    },
    Setting {
        key: "empty-room-seconds",
        about: "the time after which a room without members is closed",
        value: &Number(0..=86_400, Place::Seconds(|it| &mut it.empty_room)),
    },
    Setting {
        key: "frames-per-second",
        about: "the most frames that a visitor gets in a second; fewer, if the processor is busy",
        value: &Number(5..=60, Place::U32(|it| &mut it.frames_per_second)),
    },
];

/// A value that is read and written by functions of its own.
struct Text<T> {
    at: fn(&mut Config) -> &mut T,
    read: fn(&Entry<'_, '_>) -> Option<T>,
    write: fn(&T) -> String,
}

impl<T> Text<T> {
    fn get(&self, of: &Config) -> T
    where
        T: Clone,
    {
        (self.at)(&mut of.clone()).clone()
    }
}

impl<T: Clone + PartialEq> Field<Config> for Text<T> {
    fn read(&self, entry: &Entry<'_, '_>, into: &mut Config) {
        if let Some(value) = (self.read)(entry) {
            *(self.at)(into) = value;
        }
    }

    fn write(&self, of: &Config) -> String {
        (self.write)(&self.get(of))
    }

    fn differs(&self, one: &Config, other: &Config) -> bool {
        self.get(one) != self.get(other)
    }

    fn copy(&self, from: &Config, into: &mut Config) {
        *(self.at)(into) = self.get(from);
    }
}

/// A whole number in a range.
struct Number(RangeInclusive<u32>, Place);

/// The place of a number.
enum Place {
    U16(fn(&mut Config) -> &mut u16),
    U32(fn(&mut Config) -> &mut u32),
    Seconds(fn(&mut Config) -> &mut Duration),
}

impl Number {
    fn get(&self, of: &Config) -> u32 {
        let mut of = of.clone();
        match self.1 {
            Place::U16(at) => u32::from(*at(&mut of)),
            Place::U32(at) => *at(&mut of),
            Place::Seconds(at) => u32::try_from(at(&mut of).as_secs()).unwrap_or(u32::MAX),
        }
    }

    fn set(&self, of: &mut Config, value: u32) {
        match self.1 {
            Place::U16(at) => *at(of) = value as u16,
            Place::U32(at) => *at(of) = value,
            Place::Seconds(at) => *at(of) = Duration::from_secs(u64::from(value)),
        }
    }
}

impl Field<Config> for Number {
    fn read(&self, entry: &Entry<'_, '_>, into: &mut Config) {
        let example = format!("{} = {}", entry.key, self.get(&Config::default()));
        let DeValue::Integer(_) = entry.value else {
            return entry.faults.push(entry.wrong_type("a whole number", &example));
        };
        let (least, most) = (*self.0.start(), *self.0.end());
        let in_range = |number: &f64| (f64::from(least)..=f64::from(most)).contains(number);
        let wanted = format!("a whole number from {least} to {most}");
        match entry.number().filter(in_range) {
            Some(number) => self.set(into, number as u32),
            None => _ = reject_range::<()>(entry, &wanted, &example),
        }
    }

    fn write(&self, of: &Config) -> String {
        self.get(of).to_string()
    }

    fn differs(&self, one: &Config, other: &Config) -> bool {
        self.get(one) != self.get(other)
    }

    fn copy(&self, from: &Config, into: &mut Config) {
        self.set(into, self.get(from));
    }
}

fn address(entry: &Entry<'_, '_>, example: &str) -> Option<SocketAddr> {
    let text = entry.string(example)?;
    text.parse().ok().or_else(|| {
        let help = format!("write {example}; [::] is all addresses of this machine");
        entry.reject(format!("{} is no address with a port", quoted(text)), "", help)
    })
}

fn message(entry: &Entry<'_, '_>) -> Option<String> {
    let text = entry.string("message = \"Welcome\"")?;
    line(entry, text, "the message of the day", LONGEST_MESSAGE)
}

fn name(entry: &Entry<'_, '_>) -> Option<String> {
    let text = entry.string("name = \"Cellcaster\"")?;
    if text.trim().is_empty() {
        let help = "leave the setting out for \"Cellcaster\"";
        return entry.reject("the name of the host is empty", "", help);
    }
    line(entry, text, "the name of the host", LONGEST_NAME)
}

/// `text`, if it is one line of at most `longest` characters. `what` names it in the fault.
fn line(entry: &Entry<'_, '_>, text: &str, what: &str, longest: usize) -> Option<String> {
    if text.chars().count() > longest || text.contains(char::is_control) {
        return entry.reject(format!("{what} is one line of at most {longest} characters"), "", "");
    }
    Some(text.to_owned())
}

fn folder(entry: &Entry<'_, '_>) -> Option<PathBuf> {
    let path = Path::new(entry.string(MAPS_EXAMPLE)?);
    // A service starts in a folder that nobody thinks of.
    if !path.is_absolute() {
        let message = format!("{} is not an absolute path", quoted(&path.to_string_lossy()));
        return entry.reject(message, "", format!("write {MAPS_EXAMPLE}"));
    }
    Some(path.to_owned())
}

fn log(entry: &Entry<'_, '_>) -> Option<LogFilter> {
    entry.string(LOG_EXAMPLE)?.parse().map_or_else(
        |UnknownLogFilter(part)| {
            let help = format!("write {LOG_EXAMPLE}; {}", LogFilter::GRAMMAR);
            entry.reject(format!("{} is no level of the log", quoted(&part)), "", help)
        },
        Some,
    )
}
