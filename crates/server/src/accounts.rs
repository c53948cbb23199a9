//! The store of a host: accounts, their names and settings, bans, and results.
//!
//! [`HostStore`] is the interface. [`SqliteStore`] keeps everything in one file, `host.db`, `PostgresStore`
//! (feature `cluster`) in a PostgreSQL database that several hosts share, and [`MemoryStore`] in memory, for
//! tests. All pass the same tests.
//!
//! Rules:
//!
//! - **An account is a public key.** Its [`AccountKey`] is the SHA-256 of the key's data, which does not
//!   contain the comment.
//! - **A name is a [`Name`]:** one to read, print and tell from all others. It is chosen once, and can be
//!   changed after [`RENAME_WAIT`]. The name before is held for the account for [`NAME_HELD`].
//! - **A result is a [`VerifiedRun`]:** one that [`verify`] has replayed. For each account, level and
//!   difficulty the fastest run is kept with its script, beside the highest rank. To record a run again changes
//!   nothing, so what may be recorded or not is recorded again: see [`WaitingResults`].
//! - **Methods block** for as long as the disk or the network does. Callers use a worker thread. A method that has
//!   returned `Ok` is on the disk.
//! - **Time is an argument.** A store has no clock.
//!
//! Files as in the store at home were refused: a host has thousands of accounts, and a board needs the
//! best of all of them.

mod account;
mod ban;
mod failure;
mod lease;
mod memory;
mod name;
mod postgres;
mod presence;
mod rate;
mod score;
mod sql;
mod sqlite;
mod time;
mod verify;
mod waiting;

pub use account::{Account, AccountId, AccountKey, AccountSettings};
pub use ban::{AddressPrefix, Ban, BanTarget, Identity};
pub use failure::{Refusal, StoreFailure};
pub use lease::{Lease, Leases, MemoryLeases};
pub use memory::MemoryStore;
pub use name::{Name, NameFault, printable};
pub use postgres::PostgresStore;
pub use presence::{
    HostNotice, HostRow, MemoryPresence, Presence, Visit, VisitBegin, VisitId, Visitor,
};
pub use rate::{AccountRate, Origin};
pub use score::{DailyScore, DailyTry, LevelBoard, LevelScore};
#[cfg(fuzzing)]
#[doc(hidden)]
pub use sqlite::ColumnValue;
pub use sqlite::SqliteStore;
pub use time::{Day, UnixTime};
pub use verify::{
    MOST_SCRIPT_BYTES, MOST_SCRIPT_STEPS, Unverified, VerifiedDescent, VerifiedLevel, VerifiedRun,
    verify, verify_with,
};
pub use waiting::{Late, WaitingResult, WaitingResults};

use cellcaster::app::store::{Best, Improved};

/// The seconds from the choice of a name to the next one.
pub const RENAME_WAIT: u64 = 7 * 24 * 60 * 60;
/// The seconds for which a name that was changed remains with its account.
pub const NAME_HELD: u64 = 30 * 24 * 60 * 60;

/// What a host keeps.
pub trait HostStore: Send {
    /// The account of a key.
    ///
    /// # Errors
    /// Where the store can't be read; so for each method.
    fn account(&mut self, key: &AccountKey) -> Result<Option<Account>, StoreFailure>;

    /// The account that has `name`, or one that looks like it.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    fn account_named(&mut self, name: &Name) -> Result<Option<Account>, StoreFailure>;

    /// Creates the account of a key, whatever others were created.
    ///
    /// # Errors
    /// [`Refusal`].
    fn create_account(
        &mut self,
        key: &AccountKey,
        name: &Name,
        now: UnixTime,
    ) -> Result<Account, Refusal> {
        self.create_account_from(None, key, name, now)
    }

    /// Creates the account of a key, if its network has not made too many. One that is refused for another reason
    /// does not count.
    ///
    /// # Errors
    /// [`Refusal`].
    fn create_account_from(
        &mut self,
        origin: Option<&Origin>,
        key: &AccountKey,
        name: &Name,
        now: UnixTime,
    ) -> Result<Account, Refusal>;

    /// Changes the name of an account.
    ///
    /// # Errors
    /// [`Refusal`].
    fn rename(
        &mut self,
        account: AccountId,
        name: &Name,
        now: UnixTime,
    ) -> Result<Account, Refusal>;

    /// Notes that the player of an account is here.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    fn note_visit(&mut self, account: AccountId, now: UnixTime) -> Result<(), StoreFailure>;

    /// The settings of an account; the defaults if it has none.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    fn settings(&mut self, account: AccountId) -> Result<AccountSettings, StoreFailure>;

    /// Replaces the settings of an account.
    ///
    /// # Errors
    /// If the configuration is too long; and see [`account`](Self::account).
    fn set_settings(
        &mut self,
        account: AccountId,
        settings: &AccountSettings,
    ) -> Result<(), StoreFailure>;

    /// Bans, in place of an earlier ban of the same target.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    fn ban(&mut self, ban: &Ban) -> Result<(), StoreFailure>;

    /// Ends the ban of a target, and returns whether there was one.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    fn unban(&mut self, target: &BanTarget) -> Result<bool, StoreFailure>;

    /// The bans in force, in the order in which they were made.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    fn bans(&mut self, now: UnixTime) -> Result<Vec<Ban>, StoreFailure>;

    /// The ban in force that applies to somebody; of several, the one that ends last.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    fn ban_of(
        &mut self,
        identity: &Identity<'_>,
        now: UnixTime,
    ) -> Result<Option<Ban>, StoreFailure> {
        Ok(ban::applying(self.bans(now)?, identity))
    }

    /// Records a run in a level, and returns what it improved.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    fn record(
        &mut self,
        account: AccountId,
        run: &VerifiedLevel,
        now: UnixTime,
    ) -> Result<Improved, StoreFailure>;

    /// Begins the daily run of an account. The first try of a day counts; for later ones it returns
    /// `None`.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    fn begin_daily(
        &mut self,
        account: AccountId,
        day: Day,
        now: UnixTime,
    ) -> Result<Option<DailyTry>, StoreFailure>;

    /// Records how far the daily run has come, and returns whether that is farther than before. A
    /// descent of another day does not count.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    fn record_daily(
        &mut self,
        daily: &DailyTry,
        run: &VerifiedDescent,
        now: UnixTime,
    ) -> Result<bool, StoreFailure>;

    /// The best results of an account, by level and difficulty.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    fn bests(&mut self, account: AccountId) -> Result<Vec<(LevelBoard, Best)>, StoreFailure>;

    /// The boards that have results, in the order of levels and difficulties.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    fn level_boards(&mut self) -> Result<Vec<LevelBoard>, StoreFailure>;

    /// The first `most` entries of a board: the fastest run of each account. Of equally fast ones the
    /// earlier is first.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    fn level_scores(
        &mut self,
        board: &LevelBoard,
        most: usize,
    ) -> Result<Vec<LevelScore>, StoreFailure>;

    /// The first `most` daily runs of a day that have reached an exit.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    fn daily_scores(&mut self, day: Day, most: usize) -> Result<Vec<DailyScore>, StoreFailure>;

    /// The script of the fastest run of an account.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    fn script(
        &mut self,
        account: AccountId,
        board: &LevelBoard,
    ) -> Result<Option<String>, StoreFailure>;

    /// Brings what is kept into the form in which it rests while no host runs.
    ///
    /// # Errors
    /// If it can't be written. Nothing is lost then.
    fn checkpoint(&mut self) -> Result<(), StoreFailure> {
        Ok(())
    }
}

#[cfg(test)]
mod tests;
