//! The log of a server: events, as lines on standard error.
//!
//! # Rules
//!
//! - Each event has a function in this module. Operators can rely on the names of the events.
//! - **No key and no address is logged in full:** a key appears as its fingerprint, an address as its network.
//! - **Text that a player typed is data:** it appears in a field, quoted and escaped. Chat is not logged, except for the
//!   lines that a visitor reports.
//! - A flood of connections takes a few lines a second: `Throttle` sums the events before a login by network and
//!   second.
//!
//! An event has a topic: `host`, `connections`, `rooms`, `results` or `admin`. The topic is the event's target in
//! `tracing`. A [`LogFilter`] contains a level for each topic.

use std::collections::BTreeMap;
use std::fmt::Display;
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

/// The format of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, ValueEnum)]
pub enum LogFormat {
    /// For people: time, level, topic, event and fields.
    #[default]
    Text,
    /// For programs: a JSON object.
    Json,
}

/// A log that has begun. Its filter can change.
#[derive(Debug)]
pub struct Logging {
    filter: Handle<Targets, Registry>,
}

/// The topics of events.
pub(crate) const TOPICS: [&str; 5] = ["host", "connections", "rooms", "results", "admin"];

/// The beginning of targets without a topic: module paths of this program.
const PROGRAM: &str = env!("CARGO_CRATE_NAME");

/// The lowest level of the events that are logged, and other levels for some topics.
///
/// ```
/// use cellcaster_server::logging::LogFilter;
///
/// assert!("info,connections=warn".parse::<LogFilter>().is_ok());
/// assert!("info,conections=warn".parse::<LogFilter>().is_err());
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogFilter {
    level: LevelFilter,
    topics: Vec<(&'static str, LevelFilter)>,
}

/// Keeps the log readable during a flood of connections: a few lines a second, and sums of all other events.
///
/// Within a second, the first [`MAX`] pairs of an event and a network are each logged at once, in a line of their
/// own. Later events are counted. When the second is over, they are logged as a line with the sum for each of these
/// pairs, and a line for each event with the sum of all other networks.
#[derive(Debug, Default)]
pub(crate) struct Throttle {
    /// The events of this second that no line contains yet. An entry without a network counts all networks without a
    /// line.
    unlogged: BTreeMap<(ConnectionEvent, Option<AddressPrefix>), u64>,
}

/// The number of pairs that have a line of their own in a second.
const MAX: usize = 4;

impl Logging {
    /// Begins the log of this process on standard error. A second call has no effect.
    pub fn begin(format: LogFormat, filter: &LogFilter) -> Self {
        let (subscriber, logging) = subscriber(format, filter, io::stderr);
        // If a test or an embedding program has set another log, that one stays.
        _ = tracing::subscriber::set_global_default(subscriber);
        logging
    }

    /// Changes the filter.
    pub fn set_filter(&self, filter: &LogFilter) {
        // This fails only when the log is gone.
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
    /// The grammar of a filter, in a sentence.
    pub const GRAMMAR: &str = "a level is off, error, warn, info, debug or trace, and a topic is host, \
                               connections, rooms, results or admin";

    /// The filter for a subscriber. Events of this program without a topic belong to `host`. Events of libraries are
    /// not logged.
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
    /// `info` for all topics.
    fn default() -> Self {
        Self { level: LevelFilter::INFO, topics: Vec::new() }
    }
}

impl FromStr for LogFilter {
    /// The part that is not a valid level or topic.
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
    // `parse` also accepts numbers and capitals.
    name.parse().ok().filter(|level: &LevelFilter| level.to_string() == name)
}

impl Throttle {
    /// Logs an event of a client at `address`, at once or at the end of the second.
    pub(crate) fn log(&mut self, event: ConnectionEvent, address: IpAddr) {
        let network = Some(AddressPrefix::network_of(address));
        let with_line = self.unlogged.keys().filter(|(_, network)| network.is_some()).count();
        if let Some(count) = self.unlogged.get_mut(&(event, network)) {
            *count += 1;
        } else if with_line < MAX {
            self.unlogged.insert((event, network), 0);
            connections(network, event, 1);
        } else {
            *self.unlogged.entry((event, None)).or_default() += 1;
        }
    }

    /// Logs the sums of the second that has ended.
    pub(crate) fn end_second(&mut self) {
        for ((event, network), count) in mem::take(&mut self.unlogged) {
            if count > 0 {
                connections(network, event, count);
            }
        }
    }
}

/// An event that a client causes without logging in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum ConnectionEvent {
    /// A connection was accepted.
    Accepted,
    /// A connection was refused.
    Refused(Refusal),
    /// A connection ended before its login.
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

/// Browsers can watch rooms.
pub(crate) fn web_listening(address: SocketAddr) {
    info!(target: HOST, %address, "web listening");
}

/// The configuration was read again, from `file` if there is one. The settings in `fixed` stay unchanged until the
/// next start.
pub(crate) fn reloaded(file: Option<&Path>, fixed: &[&str]) {
    let file = file.map(|file| clean(file.display()));
    if fixed.is_empty() {
        info!(target: HOST, file, "configuration reloaded");
    } else {
        let fixed = fixed.join(", ");
        warn!(target: HOST, file, needs_restart = fixed, "configuration reloaded");
    }
}

/// A line of the report about a file's faults. The previous configuration stays in force.
pub(crate) fn configuration_fault(line: &str) {
    error!(target: HOST, fault = clean(line), "configuration not reloaded");
}

/// The server accepts no more connections, and ends after at most `seconds`.
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

/// A call to the store failed.
pub(crate) fn store_failed(error: impl Display) {
    error!(target: HOST, error = clean(error), "store failed");
}

/// `count` clients of a network caused an event; `None` stands for several other networks.
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

/// A client was authenticated, as a guest if it has no key.
pub(crate) fn authenticated(address: IpAddr, key: Option<AccountKey>) {
    let key = or_guest(key);
    info!(target: CONNECTIONS, network = network(address), key, "authenticated");
}

/// A connection ended normally after `seconds`.
pub(crate) fn disconnected(address: IpAddr, seconds: u64) {
    let (network, outcome) = (network(address), Outcome::Served.name());
    info!(target: CONNECTIONS, network, outcome, seconds, "disconnected");
}

/// A visitor was turned away because of a ban.
pub(crate) fn banned_visitor(address: IpAddr, target: &BanTarget) {
    let (network, target) = (network(address), clean(target));
    info!(target: CONNECTIONS, network, ban = target, "banned visitor");
}

/// A visitor received a name.
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

/// A round ended with standings. `winner` comes first in them.
pub(crate) fn round_ended(room: u32, steps: u64, winner: Option<&str>) {
    info!(target: ROOMS, room, steps, winner = winner.map(clean), "round ended");
}

/// A room ended because of a bug.
pub(crate) fn room_failed(room: u32, error: impl Display) {
    error!(target: ROOMS, room, error = clean(error), "failed");
}

/// A result was replayed and recorded.
pub(crate) fn result_verified(name: &str, level: &str, steps: u64, rank: &str) {
    info!(target: RESULTS, name = clean(name), level = clean(level), steps, rank, "verified");
}

/// The replay did not produce the claimed result.
pub(crate) fn result_refused(name: &str, level: &str, reason: impl Display) {
    warn!(target: RESULTS, name = clean(name), level = clean(level), reason = clean(reason), "refused");
}

/// A result was replayed, and waits because the store is unavailable or full.
pub(crate) fn result_waits(name: &str, level: &str) {
    warn!(target: RESULTS, name = clean(name), level = clean(level), "waits for the store");
}

/// A waiting result was lost.
pub(crate) fn result_lost(key: &AccountKey, reason: impl Display) {
    let (key, reason) = (key.to_string(), clean(reason));
    error!(target: RESULTS, key, reason, "lost");
}

/// An operator ended the sessions of `count` visitors, and possibly banned them.
pub(crate) fn removed(target: &BanTarget, count: usize, is_banned: bool) {
    let who = clean(target);
    if is_banned {
        info!(target: ADMIN, who, count, "banned");
    } else {
        info!(target: ADMIN, who, count, "removed");
    }
}

/// An operator ended a session. `count` is 0 if there was no such session.
pub(crate) fn removed_session(session: SessionId, count: usize) {
    info!(target: ADMIN, %session, count, "removed");
}

/// An operator sent a line to `count` visitors.
pub(crate) fn said(count: usize) {
    info!(target: ADMIN, count, "said");
}

/// A visitor reported a player. `lines` are the last lines of the player that the visitor has seen.
pub(crate) fn reported(
    (reporter, reporter_key): (&str, Option<AccountKey>),
    (player, key): (&str, Option<AccountKey>),
    room: Option<&str>,
    reason: &str,
    lines: &[String],
) {
    let (reporter, player, reason) = (clean(reporter), clean(player), clean(reason));
    let (reporter_key, key) = (or_guest(reporter_key), or_guest(key));
    let (room, lines) = (clean(room.unwrap_or("lobby")), clean(lines.join(" | ")));
    warn!(target: ADMIN, player, key, reporter, reporter_key, room, reason, lines, "reported");
}

/// A moderator muted a player for some seconds.
pub(crate) fn muted(moderator: &str, player: &str, target: &BanTarget, seconds: u64) {
    let (moderator, player) = (clean(moderator), clean(player));
    // The log contains no address in full.
    let key = match target {
        BanTarget::Key(key) => or_guest(Some(*key)),
        BanTarget::Name(_) | BanTarget::Addresses(_) => or_guest(None),
    };
    info!(target: ADMIN, moderator, player, key, seconds, "muted");
}

/// A moderator ended the mute of a player.
pub(crate) fn unmuted(moderator: &str, player: &str) {
    let (moderator, player) = (clean(moderator), clean(player));
    info!(target: ADMIN, moderator, player, "unmuted");
}

/// A moderator ended the sessions of a player.
pub(crate) fn kicked(moderator: &str, player: &str, reason: &str) {
    let (moderator, player, reason) = (clean(moderator), clean(player), clean(reason));
    info!(target: ADMIN, moderator, player, reason, "kicked");
}

/// The text of a value, with escapes for characters that a terminal would interpret or not show.
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

/// The network of an address: the /24 or /64 that admission uses.
fn network(address: IpAddr) -> String {
    AddressPrefix::network_of(address).to_string()
}

fn or_guest(key: Option<AccountKey>) -> String {
    key.map_or_else(|| "guest".to_owned(), |key| key.to_string())
}

#[cfg(test)]
pub(crate) mod tests;
