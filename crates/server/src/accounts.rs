//! The store of a host: accounts, their names and settings, bans, and results.
//!
//! [`HostStore`] keeps them in one file, `host.db`, or in a PostgreSQL database that several hosts share, with the
//! same statements.
//!
//! Rules:
//!
//! - **An account is a public key.** Its [`AccountKey`] is the SHA-256 of the key's data, which does not
//!   contain the comment.
//! - **A name is a [`Name`]:** readable, printable, and distinct to the eye. It can be
//!   changed after [`RENAME_WAIT`]. The previous name is held for the account for [`NAME_HELD`].
//! - **A result is a [`VerifiedRun`]:** a run that [`verify`] has replayed. For each account, level and
//!   difficulty the fastest run is kept with its script, beside the highest rank. To record a run again changes
//!   nothing, so a run that may or may not have been recorded is recorded again: see [`WaitingResults`].
//! - **Methods block** for as long as the disk or the network does. Callers use a worker thread. A method that has
//!   returned `Ok` is on the disk.
//! - **Time is an argument**, except for leases, visits and hosts: these go by the database's own clock.
//!
//! Rejected: files as in the player's own store. A host has thousands of accounts, and a board needs the
//! best of all of them.

mod account;
mod ban;
mod failure;
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
pub use ban::{AddressPrefix, Ban, BanTarget, Identity};
pub use failure::{Refusal, StoreFailure};
pub use lease::Lease;
pub use name::{Name, NameFault, printable};
pub use presence::{HostNotice, HostRow, Visit, VisitId};
pub use rate::{AccountRate, Origin};
pub use results::{
    LevelBoard, LevelScore, MOST_SCRIPT_BYTES, MOST_SCRIPT_STEPS, Unverified, VerifiedRun, verify,
};
pub use store::HostStore;
pub use waiting::{Late, WaitingResult, WaitingResults};

/// The seconds from the choice of a name to the next one.
pub const RENAME_WAIT: u64 = 7 * 24 * 60 * 60;
/// The seconds for which a name that was changed remains with its account.
pub const NAME_HELD: u64 = 30 * 24 * 60 * 60;

#[cfg(test)]
mod tests;
