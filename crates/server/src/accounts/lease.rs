//! Leases: which host has a room.
//!
//! Rules:
//!
//! - **A room has one holder at most.** A lease ends when it is released, or when its time is over without a
//!   renewal. Nobody else takes it before, its own holder neither: a host that was started again waits.
//! - **A lease has an epoch**, which is greater than that of all earlier leases of the room and is not
//!   repeated while there is the room, so that what a host does with a lease that is over can be told from what its successor does.
//! - **A lease that is over and that nobody has taken can be renewed**, with its epoch.
//! - **Time is that of the store.** A host whose clock is wrong keeps no lease too long and loses none.
//!
//! Locks that end with the connection of their holder were refused: a connection outlives a host that hangs,
//! and a host outlives a connection that was cut.

mod memory;

use std::time::Duration;

pub use memory::MemoryLeases;

use super::StoreFailure;

/// The right to have a room, for a while.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lease {
    pub(crate) room: String,
    pub(crate) host: String,
    pub(crate) epoch: u64,
    pub(crate) time: Duration,
}

/// Where leases are kept.
pub trait Leases: Send {
    /// Takes the lease of a room for `time`, with an epoch above `above` and all earlier ones; `None` if the
    /// room has a holder. A store that was restored from a backup may know fewer epochs than its callers do.
    ///
    /// # Errors
    /// Where the store can't be asked; so for each method. If it says that a change may be kept or not, the
    /// room may have a holder until `time` is over.
    fn acquire(
        &mut self,
        room: &str,
        host: &str,
        time: Duration,
        above: u64,
    ) -> Result<Option<Lease>, StoreFailure>;

    /// Makes leases last for their times from now on, and returns for each whether it does: it does not if it
    /// was released or taken. That of many costs the store little more than that of one.
    ///
    /// # Errors
    /// See [`acquire`](Self::acquire).
    fn renew(&mut self, leases: &[Lease]) -> Result<Vec<bool>, StoreFailure>;

    /// Ends a lease, and returns whether there was one to end.
    ///
    /// # Errors
    /// See [`acquire`](Self::acquire).
    fn release(&mut self, lease: &Lease) -> Result<bool, StoreFailure>;

    /// Ends the lease of a room that is closed for ever, and forgets its epochs. Returns whether there was one to
    /// end.
    ///
    /// # Errors
    /// See [`acquire`](Self::acquire).
    fn forget(&mut self, lease: &Lease) -> Result<bool, StoreFailure>;

    /// The lease of a room that is in force.
    ///
    /// # Errors
    /// See [`acquire`](Self::acquire).
    fn holder(&mut self, room: &str) -> Result<Option<Lease>, StoreFailure>;
}

impl Lease {
    /// The room.
    pub fn room(&self) -> &str {
        &self.room
    }

    /// The host that has it.
    pub fn host(&self) -> &str {
        &self.host
    }

    /// Its number among the leases of the room.
    pub fn epoch(&self) -> u64 {
        self.epoch
    }

    /// How long it lasts without a renewal.
    pub fn time(&self) -> Duration {
        self.time
    }
}
