//! The store of a host: accounts, their names and settings, bans, and results.
//!
//! [`HostStore`] keeps them in one file, `host.db`, or in a PostgreSQL database that several hosts share. Both use
//! the same statements.
//!
//! Rules:
//!
//! - **An account is a public key.** Its [`AccountKey`] is the SHA-256 of the key's data, without the comment.
//! - **A name is a [`Name`]:** readable, printable, and distinct to the eye. A player can change it after
//!   [`RENAME_INTERVAL`]. The previous name stays reserved for the account for [`NAME_HELD`].
//! - **A result is a [`VerifiedRun`]:** a run that [`verify`] has replayed. For each account, level and
//!   difficulty, the store keeps the fastest run with its script, and the highest rank. Recording a run twice
//!   changes nothing. So if it is unknown whether a run was recorded, it is recorded again: see
//!   [`WaitingResults`].
//! - **Methods block** on the disk or the network, so callers use a worker thread. When a method returns `Ok`, its
//!   change is on the disk.
//! - **Time is an argument**, except for leases, visits, hosts and the removal of old boards. These use the database's
//!   own clock.
//!
//! Rejected: files as in the player's own store. A host has thousands of accounts, and a board needs the best
//! results of all of them.

mod account;
mod ban;
mod day;
mod failure;
pub(crate) mod known;
mod lease;
mod name;
mod postgres;
mod presence;
mod rate;
mod results;
mod sqlite;
mod statements;
mod store;
#[cfg(any(test, feature = "fuzzing"))]
mod testing;
mod waiting;
pub(crate) mod worker;

#[cfg(feature = "fuzzing")]
#[doc(hidden)]
pub use rusqlite::types::Value as ColumnValue;

pub use account::{Account, AccountId, AccountKey, AccountSettings, UnixTime};
pub(crate) use account::{serialized_as_text, time_text};
pub(crate) use ban::applying;
pub use ban::{AddressPrefix, Ban, BanScope, BanTarget, Identity};
pub use day::Day;
pub(crate) use day::KEPT_DAYS;
pub use failure::{AccountRefusal, StoreFailure};
pub use known::KnownPlayers;
pub use lease::Lease;
pub use name::{Name, NameFault, printable};
pub use presence::{HostNotice, HostRow, VisitId};
pub use rate::{AccountRate, Origin};
pub use results::{
    LevelBoard, LevelScore, MAX_SCRIPT_BYTES, MAX_SCRIPT_STEPS, Unverified, VerifiedRun, verify,
};
pub(crate) use results::{ScoredBoards, verify_at};
pub use store::HostStore;
pub use waiting::{LateOutcome, WaitingResult, WaitingResults};

/// How long a player must keep a name before changing it, in seconds.
pub const RENAME_INTERVAL: u64 = 7 * 24 * 60 * 60;
/// How long an account's previous name stays reserved for it, in seconds.
pub const NAME_HELD: u64 = 30 * 24 * 60 * 60;

#[cfg(test)]
mod tests;
