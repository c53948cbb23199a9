//! A store in a SQLite file.
//!
//! Rules:
//!
//! - **A change is on the disk when its method returns.** The file has a write-ahead log, which is
//!   synchronised with each transaction (`journal_mode = WAL`, `synchronous = FULL`). A process that is
//!   killed loses at most the change that has not returned.
//! - **Others can read at the same time**, such as `cellcaster scores`.
//! - **A damaged file is kept.** [`open`](SqliteStore::open) checks the whole file. A damaged one is renamed
//!   to `host.db.damaged-1` with its log, all rows that can be read are copied into a new file, and a
//!   sentence says so.
//! - **A file of a newer version is left alone**, and so is one of another program.
//! - **Nobody else on the machine reads it**: the file has the mode 0600, and the folder 0700 where it is
//!   created.
//! - **Values are bound, never written into a statement.**
//!
//! SQLite's own table of statements is not used (rusqlite's feature `cache`): a host prepares some ten
//! statements a second.

mod accounts;
mod bans;
mod opening;
mod results;
mod salvage;
mod schema;

use std::path::Path;

use rusqlite::{Connection, TransactionBehavior};

use super::{
    Account, AccountId, AccountKey, AccountSettings, Ban, BanTarget, DailyScore, DailyTry, Day,
    HostStore, LevelBoard, LevelScore, Name, Refusal, StoreFailure, UnixTime, VerifiedDescent,
    VerifiedLevel,
};
use crate::store::{Best, Improved};

/// A store in the file `host.db` of a folder.
#[derive(Debug)]
pub struct SqliteStore {
    connection: Connection,
}

impl SqliteStore {
    /// The store in `folder`, which is created if it does not exist; and a sentence if its file was
    /// damaged.
    ///
    /// # Errors
    /// If the folder can't be used, or the file is of a newer version or of another program.
    pub fn open(folder: &Path) -> Result<(Self, Option<String>), StoreFailure> {
        let (connection, sentence) = opening::open(folder)?;
        Ok((Self { connection }, sentence))
    }

    /// The store in `folder` to read from while a host uses it. `None` if there is none. All methods that
    /// change something fail.
    ///
    /// # Errors
    /// If it can't be read, or is of another version.
    pub fn open_to_read(folder: &Path) -> Result<Option<Self>, StoreFailure> {
        Ok(opening::open_to_read(folder)?.map(|connection| Self { connection }))
    }

    /// Runs `act` in a transaction, which is undone if it fails.
    fn change<T, E: From<rusqlite::Error>>(
        &mut self,
        act: impl FnOnce(&Connection) -> Result<T, E>,
    ) -> Result<T, E> {
        let behavior = TransactionBehavior::Immediate;
        let transaction = self.connection.transaction_with_behavior(behavior)?;
        let result = act(&transaction)?;
        transaction.commit()?;
        Ok(result)
    }
}

impl From<rusqlite::Error> for StoreFailure {
    fn from(error: rusqlite::Error) -> Self {
        Self::new(format!("the host's store failed: {error}"))
    }
}

impl From<rusqlite::Error> for Refusal {
    fn from(error: rusqlite::Error) -> Self {
        Self::Failed(error.into())
    }
}

impl HostStore for SqliteStore {
    fn account(&mut self, key: &AccountKey) -> Result<Option<Account>, StoreFailure> {
        Ok(accounts::of_key(&self.connection, key)?)
    }

    fn account_named(&mut self, name: &Name) -> Result<Option<Account>, StoreFailure> {
        Ok(accounts::named(&self.connection, name)?)
    }

    fn create_account(
        &mut self,
        key: &AccountKey,
        name: &Name,
        now: UnixTime,
    ) -> Result<Account, Refusal> {
        self.change(|connection| accounts::create(connection, key, name, now))
    }

    fn rename(
        &mut self,
        account: AccountId,
        name: &Name,
        now: UnixTime,
    ) -> Result<Account, Refusal> {
        self.change(|connection| accounts::rename(connection, account, name, now))
    }

    fn note_visit(&mut self, account: AccountId, now: UnixTime) -> Result<(), StoreFailure> {
        Ok(accounts::note_visit(&self.connection, account, now)?)
    }

    fn settings(&mut self, account: AccountId) -> Result<AccountSettings, StoreFailure> {
        Ok(accounts::settings(&self.connection, account)?)
    }

    fn set_settings(
        &mut self,
        account: AccountId,
        settings: &AccountSettings,
    ) -> Result<(), StoreFailure> {
        Ok(accounts::set_settings(&self.connection, account, settings.checked()?)?)
    }

    fn ban(&mut self, ban: &Ban) -> Result<(), StoreFailure> {
        self.change(|connection| Ok(bans::add(connection, ban)?))
    }

    fn unban(&mut self, target: &BanTarget) -> Result<bool, StoreFailure> {
        self.change(|connection| Ok(bans::remove(connection, target)?))
    }

    fn bans(&mut self, now: UnixTime) -> Result<Vec<Ban>, StoreFailure> {
        Ok(bans::in_force(&self.connection, now)?)
    }

    fn record(
        &mut self,
        account: AccountId,
        run: &VerifiedLevel,
        now: UnixTime,
    ) -> Result<Improved, StoreFailure> {
        self.change(|connection| Ok(results::record(connection, account, run, now)?))
    }

    fn begin_daily(
        &mut self,
        account: AccountId,
        day: Day,
        now: UnixTime,
    ) -> Result<Option<DailyTry>, StoreFailure> {
        Ok(results::begin_daily(&self.connection, account, day, now)?)
    }

    fn record_daily(
        &mut self,
        daily: &DailyTry,
        run: &VerifiedDescent,
        now: UnixTime,
    ) -> Result<bool, StoreFailure> {
        self.change(|connection| Ok(results::record_daily(connection, daily, run, now)?))
    }

    fn bests(&mut self, account: AccountId) -> Result<Vec<(LevelBoard, Best)>, StoreFailure> {
        Ok(results::bests(&self.connection, account)?)
    }

    fn level_boards(&mut self) -> Result<Vec<LevelBoard>, StoreFailure> {
        Ok(results::level_boards(&self.connection)?)
    }

    fn level_scores(
        &mut self,
        board: &LevelBoard,
        most: usize,
    ) -> Result<Vec<LevelScore>, StoreFailure> {
        Ok(results::level_scores(&self.connection, board, most)?)
    }

    fn daily_scores(&mut self, day: Day, most: usize) -> Result<Vec<DailyScore>, StoreFailure> {
        Ok(results::daily_scores(&self.connection, day, most)?)
    }

    fn script(
        &mut self,
        account: AccountId,
        board: &LevelBoard,
    ) -> Result<Option<String>, StoreFailure> {
        Ok(results::script(&self.connection, account, board)?)
    }
}

#[cfg(any(test, fuzzing))]
impl SqliteStore {
    /// A store without a file.
    ///
    /// # Panics
    /// Without memory for it.
    #[doc(hidden)]
    pub fn in_memory() -> Self {
        let mut connection = Connection::open_in_memory().unwrap();
        connection.execute_batch("PRAGMA foreign_keys = ON").unwrap();
        schema::migrate(&mut connection, schema::MIGRATIONS).unwrap();
        Self { connection }
    }
}
