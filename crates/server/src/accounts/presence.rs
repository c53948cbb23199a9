//! Hosts of a cluster, and who is on each of them.
//!
//! Rules:
//!
//! - **A host is there while it announces itself.** One that has ended without a word is gone some seconds later.
//! - **A visit counts on all hosts, while its host is there**, so that a limit of visits by a key or by addresses
//!   holds for all hosts together. A host that was late has its visitors none the less: then its visits count
//!   again, and for a while there may be more than the limit.
//! - **Who is refused learns how fresh that is.** The visits in the way may be those of a host that was just
//!   killed.
//! - **Time is that of the store**, as with [leases](super::Leases).
//!
//! A counter for each visitor was refused: what a host has counted when it is killed would be there for ever. So
//! was a time for each visit that the host renews: a host with a thousand visitors would write a thousand rows
//! each time.

mod memory;

use std::fmt;
use std::time::Duration;

pub use memory::MemoryPresence;

use super::{AccountKey, AddressPrefix, StoreFailure};

/// By what the visits of somebody are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Visitor {
    /// The account of a key.
    Key(AccountKey),
    /// The addresses of a network.
    Addresses(AddressPrefix),
}

/// The number of a visit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct VisitId(pub(crate) i64);

/// A visit that counts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Visit {
    /// Its number.
    pub id: VisitId,
    /// The host.
    pub host: String,
    /// Who is there.
    pub visitor: Visitor,
    /// How long already.
    pub since: Duration,
}

/// Whether a visit has begun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VisitBegin {
    /// It counts now.
    Begun(VisitId),
    /// There are as many as allowed, counting only hosts that have announced themselves in this time.
    TooMany(Duration),
}

/// What a host says of itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HostNotice {
    /// Its name, which no other host of the cluster has.
    pub name: String,
    /// The version of its program.
    pub version: String,
    /// Where players reach it.
    pub address: String,
    /// Its visitors.
    pub load: u32,
}

/// A host that is there.
#[derive(Clone, Debug, PartialEq)]
pub struct HostRow {
    /// What it said last.
    pub notice: HostNotice,
    /// How long ago that was.
    pub ago: Duration,
}

/// Where visits and hosts are kept. In each method, a host is there that has announced itself in the last `time`.
pub trait Presence: Send {
    /// Begins a visit, if fewer than `most` of the visitor count.
    ///
    /// # Errors
    /// Where the store can't be asked; so for each method. If it says that a change may be kept or not, the visit
    /// may count.
    fn begin_visit(
        &mut self,
        host: &str,
        visitor: &Visitor,
        most: u32,
        time: Duration,
    ) -> Result<VisitBegin, StoreFailure>;

    /// Ends a visit.
    ///
    /// # Errors
    /// See [`begin_visit`](Self::begin_visit).
    fn end_visit(&mut self, visit: VisitId) -> Result<(), StoreFailure>;

    /// The visits that count, in the order in which they were begun.
    ///
    /// # Errors
    /// See [`begin_visit`](Self::begin_visit).
    fn visits(&mut self, time: Duration) -> Result<Vec<Visit>, StoreFailure>;

    /// Keeps what a host says of itself, in place of what it said before.
    ///
    /// # Errors
    /// See [`begin_visit`](Self::begin_visit).
    fn announce(&mut self, notice: &HostNotice) -> Result<(), StoreFailure>;

    /// Forgets a host that ends, with all of its visits.
    ///
    /// # Errors
    /// See [`begin_visit`](Self::begin_visit).
    fn leave(&mut self, host: &str) -> Result<(), StoreFailure>;

    /// The hosts that are there, by name.
    ///
    /// # Errors
    /// See [`begin_visit`](Self::begin_visit).
    fn hosts(&mut self, time: Duration) -> Result<Vec<HostRow>, StoreFailure>;
}

impl Visitor {
    /// The visitor of a text that it was written as.
    pub fn parse(text: &str) -> Option<Self> {
        let of_key = AccountKey::parse(text).map(Self::Key);
        of_key.or_else(|| AddressPrefix::parse(text).map(Self::Addresses))
    }
}

impl fmt::Display for Visitor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Key(key) => key.fmt(f),
            Self::Addresses(prefix) => prefix.fmt(f),
        }
    }
}
