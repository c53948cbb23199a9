//! The bus: what hosts of a cluster keep together and tell each other.
//!
//! # Rules
//!
//! - **A room has a log.** A message is appended to it only if the writer names the number of the message
//!   before. So who was replaced without noticing it cannot write, however late they are.
//! - **What is said in a room may be lost**, and nobody keeps it. Who misses something reads the log.
//! - **Values have keys.** A new value is kept only if there is none.
//!
//! Consumers of the log that the engine keeps for each room and host were refused: they are state in the
//! engine, and notice a loss after seconds. What is appended is said in the room instead, and a host reads
//! the log only where something is missing.

use std::pin::Pin;

use tokio::sync::mpsc;

use crate::server::summary::RoomId;

/// What hosts share.
pub(super) trait Bus: Send + Sync {
    /// Appends a message to the log of a room, whose last message is number `last`, 0 for none; returns its
    /// number.
    fn publish(&self, room: RoomId, last: u64, message: Vec<u8>) -> Answer<'_, u64>;

    /// The first message of a room's log after number `after`, with its number.
    fn read(&self, room: RoomId, after: u64) -> Answer<'_, Option<(u64, Vec<u8>)>>;

    /// Drops the messages of a room's log before number `first`.
    fn drop_before(&self, room: RoomId, first: u64) -> Answer<'_, ()>;

    /// Drops the log of a room.
    fn drop_log(&self, room: RoomId) -> Answer<'_, ()>;

    /// Says something to all hosts that have the room.
    fn say(&self, room: RoomId, talk: Vec<u8>) -> Answer<'_, ()>;

    /// What is said in a room from now on.
    fn hear(&self, room: RoomId) -> Answer<'_, mpsc::Receiver<Vec<u8>>>;

    /// A number that nobody has got before.
    fn number(&self) -> Answer<'_, u32>;

    /// Keeps a value in place of the one that this host has got or put last. If another host has put one
    /// since, it is refused, and the next one is not.
    fn put(&self, key: Key, value: Vec<u8>) -> Answer<'_, ()>;

    /// Keeps a value if there is none.
    fn create(&self, key: Key, value: Vec<u8>) -> Answer<'_, ()>;

    /// The value of a key.
    fn get(&self, key: Key) -> Answer<'_, Option<Vec<u8>>>;

    /// Removes the value of a key.
    fn remove(&self, key: Key) -> Answer<'_, ()>;

    /// The records of all rooms, then those that change: `None` for a room that is closed.
    fn watch(&self) -> Answer<'_, mpsc::Receiver<(RoomId, Option<Vec<u8>>)>>;
}

/// The answer of a bus, which comes in bounded time.
pub(super) type Answer<'a, T> = Pin<Box<dyn Future<Output = Result<T, BusFault>> + Send + 'a>>;

/// Why a bus has not done something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BusFault {
    /// The log goes on after the message that was named, or the key has a value. Nothing was kept.
    Refused,
    /// There is no answer. What was to be kept may be kept or not, even later.
    Unknown,
}

/// The key of a value.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Key {
    /// The record of a room.
    Room(RoomId),
    /// The newest checkpoint of a room.
    Checkpoint(RoomId),
    /// The number of a standing room.
    Standing(String),
}
