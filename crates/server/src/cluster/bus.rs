//! The message bus of a cluster: logs, values by key, and broadcasts.
//!
//! # Rules
//!
//! - **A room has a log.** A message is appended only if the writer states the number of the newest message (compare
//!   and append). So a sequencer that was replaced cannot write, however late it notices.
//! - **A broadcast may be lost**, and is not stored. A host that misses one reads the log.
//! - **A request reaches all present hosts**, or only some of them. Each host answers for itself.
//! - **A value has a key and a revision.** A host can replace only the revision that it saw last.
//!
//! Rejected: a `JetStream` consumer for each room and host. It is state in the server, and notices a loss after
//! seconds. Instead, the sequencer broadcasts the messages that it has appended, and a host reads the log only if a
//! number is missing.

use std::pin::Pin;

use tokio::sync::{mpsc, oneshot};

use crate::accounts::AccountKey;
use crate::rooms::summary::RoomId;

/// The bus that the hosts of a cluster share.
pub(crate) trait Bus: Send + Sync {
    /// Appends a message to the log of a room. `last` is the number of the log's last message, 0 for none. Returns the
    /// number of the new message.
    fn append(&self, room: RoomId, last: u64, message: Vec<u8>) -> BusAnswer<'_, u64>;

    /// The first message of a room's log after number `after`, with its number.
    fn read(&self, room: RoomId, after: u64) -> BusAnswer<'_, Option<(u64, Vec<u8>)>>;

    /// Drops the messages of a room's log before number `first`.
    fn drop_before(&self, room: RoomId, first: u64) -> BusAnswer<'_, ()>;

    /// Drops the log of a room.
    fn drop_log(&self, room: RoomId) -> BusAnswer<'_, ()>;

    /// Sends a message to all hosts that have subscribed to the room.
    fn broadcast(&self, room: RoomId, message: Vec<u8>) -> BusAnswer<'_, ()>;

    /// Receives the broadcasts to a room from now on.
    fn subscribe(&self, room: RoomId) -> BusAnswer<'_, mpsc::Receiver<Vec<u8>>>;

    /// Asks all hosts, including this one. Returns their answers.
    fn ask_hosts(&self, request: Vec<u8>) -> BusAnswer<'_, mpsc::Receiver<Vec<u8>>>;

    /// Receives the requests to all hosts from now on.
    fn host_requests(&self) -> BusAnswer<'_, mpsc::Receiver<HostRequest>>;

    /// A number that was never returned before, on any host.
    fn next_number(&self) -> BusAnswer<'_, u32>;

    /// Replaces the value that this host last read or put. If another host has put a value since, this call fails, but
    /// the next one does not.
    fn put(&self, key: Key, value: Vec<u8>) -> BusAnswer<'_, ()>;

    /// Stores a value if there is none.
    fn create(&self, key: Key, value: Vec<u8>) -> BusAnswer<'_, ()>;

    /// The value of a key.
    fn get(&self, key: Key) -> BusAnswer<'_, Option<Vec<u8>>>;

    /// Removes the value of a key.
    fn remove(&self, key: Key) -> BusAnswer<'_, ()>;

    /// The records of all rooms, and then their changes: `None` for a room that is closed.
    fn watch(&self) -> BusAnswer<'_, mpsc::Receiver<(RoomId, Option<Vec<u8>>)>>;
}

/// A request to all hosts.
#[derive(Debug)]
pub(crate) struct HostRequest {
    pub(crate) bytes: Vec<u8>,
    /// If this is dropped, the request gets no answer.
    pub(crate) reply: oneshot::Sender<Vec<u8>>,
}

/// The answer of a bus, which arrives in bounded time.
pub(crate) type BusAnswer<'a, T> = Pin<Box<dyn Future<Output = Result<T, BusFault>> + Send + 'a>>;

/// The reason why a call failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BusFault {
    /// The log continues after the stated message, or the key has another value. Nothing was stored.
    Refused,
    /// There is no answer. The value may be stored or not, even later.
    Unknown,
}

/// The key of a value.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Key {
    /// The record of a room.
    Room(RoomId),
    /// The newest checkpoint of a room.
    Checkpoint(RoomId),
    /// The number of a standing room.
    Standing(String),
    /// The place of the player with a key: the room and the member.
    Place(AccountKey),
}
