//! The events of a server's log.

use std::fmt::Display;
use std::net::{IpAddr, SocketAddr};
use std::path::Path;

use tracing::{error, info, warn};

use crate::accounts::{AccountKey, AddressPrefix, BanTarget};
use crate::sessions::visitors::SessionId;
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
