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

use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::net::{IpAddr, SocketAddr};
use std::path::Path;
use std::str::FromStr;
use std::{io, mem};

use clap::ValueEnum;
use tracing::{error, info, warn};
use tracing_subscriber::filter::{LevelFilter, Targets};
use tracing_subscriber::fmt::MakeWriter;
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::reload::Handle;
use tracing_subscriber::{Layer, Registry, reload};

use crate::accounts::{AccountKey, AddressPrefix, BanTarget};
use crate::admission::{Outcome, Refusal};
use crate::visitors::SessionId;

/// The form of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, ValueEnum)]
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
/// use cellcaster_server::logging::LogFilter;
///
/// let filter: LogFilter = "info,connections=warn".parse()?;
/// assert_eq!(filter.to_string(), "info,connections=warn");
/// assert!("info,conections=warn".parse::<LogFilter>().is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogFilter {
    level: LevelFilter,
    topics: Vec<(&'static str, LevelFilter)>,
}

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
    /// The part that is no level.
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut filter = Self::default();
        for part in text.split(',').map(str::trim) {
            let unknown = || part.to_owned();
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

impl Display for LogFilter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.level)?;
        self.topics.iter().try_for_each(|(topic, level)| write!(f, ",{topic}={level}"))
    }
}

impl Throttle {
    /// Logs an event of a client at `address`, at once or with the second.
    pub(crate) fn log(&mut self, event: ConnectionEvent, address: IpAddr) {
        let network = Some(AddressPrefix::network_of(address));
        let with_line = self.unlogged.keys().filter(|(_, network)| network.is_some()).count();
        if let Some(count) = self.unlogged.get_mut(&(event, network)) {
            *count += 1;
        } else if with_line < MOST {
            self.unlogged.insert((event, network), 0);
            connections(network, event, 1);
        } else {
            *self.unlogged.entry((event, None)).or_default() += 1;
        }
    }

    /// Logs the sums of the second that is over.
    pub(crate) fn end_second(&mut self) {
        for ((event, network), count) in mem::take(&mut self.unlogged) {
            if count > 0 {
                connections(network, event, count);
            }
        }
    }
}

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

const HOST: &str = "host";
const CONNECTIONS: &str = "connections";
const ROOMS: &str = "rooms";
const RESULTS: &str = "results";
const ADMIN: &str = "admin";

/// The server accepts connections.
pub(crate) fn listening(address: SocketAddr, fingerprint: &str) {
    info!(target: HOST, %address, host_key = fingerprint, "listening");
}

/// Metrics can be read.
pub(crate) fn metrics_listening(address: SocketAddr) {
    info!(target: HOST, %address, "metrics listening");
}

/// The configuration was read again, from `file` if there is one. Settings that are in `fixed` stay as
/// they are until the next start.
pub(crate) fn reloaded(file: Option<&Path>, fixed: &[&str]) {
    let file = file.map(|file| clean(file.display()));
    if fixed.is_empty() {
        info!(target: HOST, file, "configuration reloaded");
    } else {
        let fixed = fixed.join(", ");
        warn!(target: HOST, file, needs_restart = fixed, "configuration reloaded");
    }
}

/// A part of the report of a file's faults. The configuration before stays in force.
pub(crate) fn configuration_fault(line: &str) {
    error!(target: HOST, fault = clean(line), "configuration not reloaded");
}

/// The server accepts no more connections, and ends after `seconds` at most.
pub(crate) fn draining(seconds: u64) {
    info!(target: HOST, seconds, "draining");
}

/// The server has ended.
pub(crate) fn ended() {
    info!(target: HOST, "ended");
}

/// Something in the server failed.
pub(crate) fn fault(what: &str, error: impl Display) {
    error!(target: HOST, what, error = clean(error), "fault");
}

/// A call of the store failed.
pub(crate) fn store_failed(error: impl Display) {
    error!(target: HOST, error = clean(error), "store failed");
}

/// `count` clients of a network, or of several other networks, have brought about an event.
pub(crate) fn connections(network: Option<AddressPrefix>, event: ConnectionEvent, count: u64) {
    let network = network.map_or_else(|| "others".to_owned(), |network| network.to_string());
    match event {
        ConnectionEvent::Accepted => info!(target: CONNECTIONS, network, count, "accepted"),
        ConnectionEvent::Refused(reason) => {
            info!(target: CONNECTIONS, network, reason = reason.name(), count, "refused");
        }
        ConnectionEvent::Ended(outcome) => {
            info!(target: CONNECTIONS, network, outcome = outcome.name(), count, "disconnected");
        }
    }
}

/// A client is authenticated; without a key as a guest.
pub(crate) fn authenticated(address: IpAddr, key: Option<AccountKey>) {
    let key = or_guest(key);
    info!(target: CONNECTIONS, network = network(address), key, "authenticated");
}

/// A connection has ended in order, after so many seconds.
pub(crate) fn disconnected(address: IpAddr, seconds: u64) {
    let (network, outcome) = (network(address), Outcome::Served.name());
    info!(target: CONNECTIONS, network, outcome, seconds, "disconnected");
}

/// A visitor was sent away because of a ban.
pub(crate) fn banned_visitor(address: IpAddr, target: &BanTarget) {
    let (network, target) = (network(address), clean(target));
    info!(target: CONNECTIONS, network, ban = target, "banned visitor");
}

/// A visitor has a name.
pub(crate) fn named(key: Option<&AccountKey>, name: &str) {
    let key = or_guest(key.copied());
    info!(target: CONNECTIONS, key, name = clean(name), "named");
}

/// A room was opened.
pub(crate) fn room_opened(room: u32, level: &str, mode: &str) {
    info!(target: ROOMS, room, level = clean(level), mode, "opened");
}

/// A room was closed.
pub(crate) fn room_closed(room: u32) {
    info!(target: ROOMS, room, "closed");
}

/// A round has ended with standings, the winner first.
pub(crate) fn round_ended(room: u32, steps: u64, winner: Option<&str>) {
    info!(target: ROOMS, room, steps, winner = winner.map(clean), "round ended");
}

/// A room has ended by a defect.
pub(crate) fn room_failed(room: u32, error: impl Display) {
    error!(target: ROOMS, room, error = clean(error), "failed");
}

/// A result was replayed and kept.
pub(crate) fn result_verified(name: &str, level: &str, steps: u64, rank: &str) {
    info!(target: RESULTS, name = clean(name), level = clean(level), steps, rank, "verified");
}

/// A result was replayed, and is none.
pub(crate) fn result_refused(name: &str, level: &str, reason: impl Display) {
    warn!(target: RESULTS, name = clean(name), level = clean(level), reason = clean(reason), "refused");
}

/// A result was replayed, and waits for the store, which is away or full.
pub(crate) fn result_waits(name: &str, level: &str) {
    warn!(target: RESULTS, name = clean(name), level = clean(level), "waits for the store");
}

/// A result that has waited is lost.
pub(crate) fn result_lost(key: &AccountKey, reason: impl Display) {
    let (key, reason) = (key.to_string(), clean(reason));
    error!(target: RESULTS, key, reason, "lost");
}

/// An operator has ended the sessions of `count` visitors, and may have banned them.
pub(crate) fn removed(target: &BanTarget, count: usize, is_banned: bool) {
    let who = clean(target);
    if is_banned {
        info!(target: ADMIN, who, count, "banned");
    } else {
        info!(target: ADMIN, who, count, "removed");
    }
}

/// An operator has ended a session, if `count` is 1 and not 0.
pub(crate) fn removed_session(session: SessionId, count: usize) {
    info!(target: ADMIN, %session, count, "removed");
}

/// An operator has said a line to `count` visitors.
pub(crate) fn said(count: usize) {
    info!(target: ADMIN, count, "said");
}

/// The text of a value, with escapes for characters that a terminal would obey or not show.
fn clean(value: impl Display) -> String {
    let mut escaped = String::new();
    for char in value.to_string().chars() {
        match char {
            '"' | '\'' | '\\' => escaped.push(char),
            _ => escaped.extend(char.escape_debug()),
        }
    }
    escaped
}

/// The network of an address, as admission knows it: /24 or /64.
fn network(address: IpAddr) -> String {
    AddressPrefix::network_of(address).to_string()
}

fn or_guest(key: Option<AccountKey>) -> String {
    key.map_or_else(|| "guest".to_owned(), |key| key.to_string())
}

#[cfg(test)]
pub(crate) mod tests;
