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
mod filter;
mod throttle;

use std::io;

use tracing_subscriber::filter::Targets;
use tracing_subscriber::fmt::MakeWriter;
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::reload::Handle;
use tracing_subscriber::{Layer, Registry, fmt, reload};

pub use filter::{LogFilter, UnknownLogFilter};
pub(crate) use throttle::{ConnectionEvent, Throttle};

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
    let lines = fmt::layer().with_writer(writer).with_ansi(false);
    let lines = match format {
        LogFormat::Text => lines.boxed(),
        LogFormat::Json => lines.json().flatten_event(true).boxed(),
    };
    let subscriber = tracing_subscriber::registry().with(lines.with_filter(filter));
    (subscriber, Logging { filter: handle })
}

#[cfg(test)]
pub(crate) mod tests;
