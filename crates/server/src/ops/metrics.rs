//! Figures about a running server, in Prometheus' text format.
//!
//! [`Metrics`] has a field for each figure. Parts of the server add to it without a lock, and
//! [`text`](Metrics::text) writes all of them, with those of the transport and of the process. A
//! responder on an address of its own answers `GET /metrics` with that text.
//!
//! A library of metrics was refused: it finds each figure by its name in a map, at each frame.

mod histogram;
mod process;
mod responder;
mod rooms;
mod text;

use std::sync::OnceLock;
use std::sync::atomic::{AtomicI64, AtomicU64, Ordering};

pub use histogram::Histogram;
pub use responder::respond;
pub use rooms::{EachRoom, RoomFigures};

/// The figures of a server, apart from those that its transport counts.
#[derive(Debug, Default)]
pub struct Metrics {
    /// The name of the host in a cluster, which every line has then.
    pub host: OnceLock<String>,
    /// The figures of each room that this host of a cluster runs.
    pub each_room: EachRoom,
    /// Rooms that are open.
    pub rooms: Gauge,
    /// Members of all rooms.
    pub members: Gauge,
    /// Visitors who watch a room.
    pub watchers: Gauge,
    /// Entries of the logs of all rooms.
    pub entries: Counter,
    /// Checksums of rooms that were the same on another host.
    pub checks_equal: Counter,
    /// Checksums of rooms that differed from those of another host, which is a bug.
    pub checks_different: Counter,
    /// Steps of rooms that went on while the bus of the cluster did not answer.
    pub steps_alone: Counter,
    /// How late the steps of rooms are.
    pub step_lateness: Histogram,
    /// The time in which a frame is drawn and encoded.
    pub frame_time: Histogram,
    /// The time from the arrival of a key to the departure of the frame that shows its effect.
    pub key_time: Histogram,
    /// Results that a replay has confirmed.
    pub results_verified: Counter,
    /// Results that a replay has refuted.
    pub results_refused: Counter,
    /// Results that wait for a store that is away.
    pub results_waiting: Gauge,
    /// Calls of the store that failed.
    pub store_errors: Counter,
}

/// A number that only grows.
#[derive(Debug, Default)]
pub struct Counter(AtomicU64);

/// A number that grows and shrinks.
#[derive(Debug, Default)]
pub struct Gauge(AtomicI64);

impl Counter {
    /// Adds 1.
    pub fn count(&self) {
        self.add(1);
    }

    /// Adds `number`.
    pub fn add(&self, number: u64) {
        self.0.fetch_add(number, Ordering::Relaxed);
    }

    /// The number.
    pub fn get(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}

impl Gauge {
    /// Adds `number`, which may be negative.
    pub fn add(&self, number: i64) {
        self.0.fetch_add(number, Ordering::Relaxed);
    }

    /// Replaces the number.
    pub fn set(&self, number: i64) {
        self.0.store(number, Ordering::Relaxed);
    }

    /// The number.
    pub fn get(&self) -> i64 {
        self.0.load(Ordering::Relaxed)
    }
}

#[cfg(test)]
mod tests;
