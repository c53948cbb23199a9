//! The log of a server: what happens, as lines on standard error.
//!
//! # Rules
//!
//! - The events are in one place, a function each. An operator can rely on their names.
//! - **No key and no address is logged whole:** a key as its fingerprint, an address as its network.
//! - **What a player typed is data:** it stands in a field, quoted and escaped, and what they say to
//!   each other is not logged at all.
//! - A flood of connections is a few lines a second: `Throttle` sums what precedes a login, by network and second.
//!
//! An event has a topic, which is the target that `tracing` knows: `host`, `connections`, `rooms`,
//! `results` or `admin`. A [`LogFilter`] has a level for each.

pub(crate) mod events;

use std::collections::BTreeMap;
use std::net::IpAddr;
use std::str::FromStr;
use std::{fmt, io, mem};

use tracing_subscriber::filter::{LevelFilter, Targets};
use tracing_subscriber::fmt::MakeWriter;
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::reload::Handle;
use tracing_subscriber::{Layer, Registry, reload};

use crate::accounts::AddressPrefix;
pub(crate) use events::ConnectionEvent;

/// The form of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum LogFormat {
    /// For people: time, level, topic, event, fields.
    #[default]
    Text,
    /// For programs: an object of JSON.
    Json,
}

/// A log that has begun. Its filter can be changed.
#[derive(Debug)]
pub struct Logging {
    filter: Handle<Targets, Registry>,
}

/// The topics of events.
pub(crate) const TOPICS: [&str; 5] = ["host", "connections", "rooms", "results", "admin"];

/// The beginning of targets without a topic: the paths of modules.
const PROGRAM: &str = env!("CARGO_CRATE_NAME");

/// The least level of events that are logged, and that of some topics.
///
/// ```
/// use cellcaster_server::ops::logging::LogFilter;
///
/// let filter: LogFilter = "info,connections=warn".parse()?;
/// assert_eq!(filter.to_string(), "info,connections=warn");
/// assert!("info,conections=warn".parse::<LogFilter>().is_err());
/// # Ok::<(), cellcaster_server::ops::logging::UnknownLogFilter>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogFilter {
    level: LevelFilter,
    topics: Vec<(&'static str, LevelFilter)>,
}

/// A part of a text that is no part of a filter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownLogFilter(pub String);

/// Lets a few events a second through, and sums the others, so that a flood of connections is a few lines a second.
///
/// Within a second, the first [`MOST`] pairs of an event and a network have a line of their own at once. What follows
/// is counted, and is logged when the second is over: a line with the sum for each of these pairs, and one for
/// each event with the sum of all other networks.
#[derive(Debug, Default)]
pub(crate) struct Throttle {
    /// The events of this second without a line; without a network, those of all that have no line.
    unlogged: BTreeMap<(ConnectionEvent, Option<AddressPrefix>), u64>,
}

/// The pairs that have a line of their own in a second.
const MOST: usize = 4;

impl Logging {
    /// Begins the log of this process on standard error. A second call has no effect.
    pub fn begin(format: LogFormat, filter: &LogFilter) -> Self {
        let (subscriber, logging) = subscriber(format, filter, io::stderr);
        // Another log, of a test or an embedding program, stays.
        _ = tracing::subscriber::set_global_default(subscriber);
        logging
    }

    /// Changes what is logged.
    pub fn set_filter(&self, filter: &LogFilter) {
        // It fails only when nothing is logged any more.
        _ = self.filter.reload(filter.targets());
    }
}

/// A log that writes to `writer`.
fn subscriber(
    format: LogFormat,
    filter: &LogFilter,
    writer: impl for<'a> MakeWriter<'a> + Send + Sync + 'static,
) -> (impl tracing::Subscriber + Send + Sync, Logging) {
    let (filter, handle) = reload::Layer::new(filter.targets());
    let lines = tracing_subscriber::fmt::layer().with_writer(writer).with_ansi(false);
    let lines = match format {
        LogFormat::Text => lines.boxed(),
        LogFormat::Json => lines.json().flatten_event(true).boxed(),
    };
    let subscriber = tracing_subscriber::registry().with(lines.with_filter(filter));
    (subscriber, Logging { filter: handle })
}

impl LogFilter {
    /// The grammar in a sentence.
    pub const GRAMMAR: &str = "off, error, warn, info, debug or trace, and others for the topics host, \
                               connections, rooms, results and admin";

    /// The filter for a subscriber. Events of this program without a topic count as those of `host`, and
    /// events of libraries are not logged.
    pub(crate) fn targets(&self) -> Targets {
        let of_topic = |topic| {
            let own = self.topics.iter().find(|(other, _)| *other == topic);
            own.map_or(self.level, |(_, level)| *level)
        };
        let topics = TOPICS.map(|topic| (topic, of_topic(topic)));
        Targets::new().with_targets(topics).with_target(PROGRAM, of_topic("host"))
    }
}

impl Default for LogFilter {
    /// `info` for all.
    fn default() -> Self {
        Self { level: LevelFilter::INFO, topics: Vec::new() }
    }
}

impl FromStr for LogFilter {
    type Err = UnknownLogFilter;

    fn from_str(text: &str) -> Result<Self, UnknownLogFilter> {
        let mut filter = Self::default();
        for part in text.split(',').map(str::trim) {
            let unknown = || UnknownLogFilter(part.to_owned());
            match part.split_once('=') {
                None => filter.level = level(part).ok_or_else(unknown)?,
                Some((topic, name)) => {
                    let known = TOPICS.into_iter().find(|known| *known == topic);
                    let topic = known.ok_or_else(unknown)?;
                    filter.topics.retain(|(other, _)| *other != topic);
                    filter.topics.push((topic, level(name).ok_or_else(unknown)?));
                }
            }
        }
        Ok(filter)
    }
}

fn level(name: &str) -> Option<LevelFilter> {
    // It also knows numbers and capitals.
    name.parse().ok().filter(|level: &LevelFilter| level.to_string() == name)
}

impl fmt::Display for LogFilter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.level)?;
        self.topics.iter().try_for_each(|(topic, level)| write!(f, ",{topic}={level}"))
    }
}

impl fmt::Display for UnknownLogFilter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} is no level of the log; a filter is {}", self.0, LogFilter::GRAMMAR)
    }
}

impl std::error::Error for UnknownLogFilter {}

impl Throttle {
    /// Logs an event of a client at `address`, at once or with the second.
    pub(crate) fn log(&mut self, event: ConnectionEvent, address: IpAddr) {
        let network = Some(AddressPrefix::network_of(address));
        let with_line = self.unlogged.keys().filter(|(_, network)| network.is_some()).count();
        if let Some(count) = self.unlogged.get_mut(&(event, network)) {
            *count += 1;
        } else if with_line < MOST {
            self.unlogged.insert((event, network), 0);
            events::connections(network, event, 1);
        } else {
            *self.unlogged.entry((event, None)).or_default() += 1;
        }
    }

    /// Logs the sums of the second that is over.
    pub(crate) fn end_second(&mut self) {
        for ((event, network), count) in mem::take(&mut self.unlogged) {
            if count > 0 {
                events::connections(network, event, count);
            }
        }
    }
}

#[cfg(test)]
pub(crate) mod tests;
