//! A store in a database, whichever it is: the statements, once.
//!
//! A [`Database`] runs statements and transactions; [`SqlStore`] is the [`HostStore`] of each.
//!
//! Rules:
//!
//! - **Statements are in the language that the databases share.** Parameters are `?1`, `?2` and so on; a row
//!   in place of another is `ON CONFLICT … DO UPDATE`. What differs is in the module of the database: its
//!   tables, its transactions and its failures.
//! - **Values are bound, never written into a statement.**
//! - **A change that reads before it writes is a transaction.** It may run more than once, until it meets no
//!   other, so it does nothing but statements.
//!
//! A trait with a method for each statement was refused: each database would repeat all of them, and they
//! would differ in time.

mod accounts;
mod bans;
mod results;
mod value;

pub(crate) use value::{Row, Value, values};

use super::{
    Account, AccountId, AccountKey, AccountSettings, Ban, BanTarget, DailyScore, DailyTry, Day,
    HostStore, LevelBoard, LevelScore, Name, Origin, Refusal, StoreFailure, UnixTime,
    VerifiedDescent, VerifiedLevel,
};
use cellcaster::app::store::{Best, Improved};

/// What runs statements, in a transaction or outside of one.
pub trait Statements {
    /// Runs a statement, and returns the number of rows that it changed.
    ///
    /// # Errors
    /// If the database refuses it or is not there.
    fn execute(&self, sql: &str, values: &[Value]) -> Result<u64, StoreFailure>;

    /// The rows of a statement.
    ///
    /// # Errors
    /// If the database refuses it or is not there.
    fn rows(&self, sql: &str, values: &[Value]) -> Result<Vec<Row>, StoreFailure>;

    /// The first row of a statement.
    ///
    /// # Errors
    /// If the database refuses it or is not there.
    fn row(&self, sql: &str, values: &[Value]) -> Result<Option<Row>, StoreFailure> {
        Ok(self.rows(sql, values)?.into_iter().next())
    }
}

/// A database with the tables of a host.
pub trait Database: Send {
    /// Runs a statement that may as well run twice: one that reads, or one that sets what it would set again.
    ///
    /// # Errors
    /// Those of `act`.
    fn once<T, E: From<StoreFailure>>(
        &mut self,
        act: impl FnMut(&dyn Statements) -> Result<T, E>,
    ) -> Result<T, E>;

    /// Runs a transaction, which is undone if `act` fails. Transactions have the effect of one after the
    /// other.
    ///
    /// # Errors
    /// Those of `act`, and if the transaction can't be kept.
    fn change<T, E: From<StoreFailure>>(
        &mut self,
        act: impl FnMut(&dyn Statements) -> Result<T, E>,
    ) -> Result<T, E>;

    /// Copies what is in a log of its own into the place where it stays.
    ///
    /// # Errors
    /// If it can't be written. Nothing is lost then.
    fn checkpoint(&mut self) -> Result<(), StoreFailure> {
        Ok(())
    }
}

/// The store in a database.
#[derive(Debug)]
pub struct SqlStore<D> {
    pub(crate) database: D,
}

impl<D: Database> HostStore for SqlStore<D> {
    fn account(&mut self, key: &AccountKey) -> Result<Option<Account>, StoreFailure> {
        self.database.once(|it| accounts::of_key(it, key))
    }

    fn account_named(&mut self, name: &Name) -> Result<Option<Account>, StoreFailure> {
        self.database.once(|it| accounts::named(it, name))
    }

    fn create_account_from(
        &mut self,
        origin: Option<&Origin>,
        key: &AccountKey,
        name: &Name,
        now: UnixTime,
    ) -> Result<Account, Refusal> {
        self.database.change(|it| accounts::create(it, origin, key, name, now))
    }

    fn rename(
        &mut self,
        account: AccountId,
        name: &Name,
        now: UnixTime,
    ) -> Result<Account, Refusal> {
        self.database.change(|it| accounts::rename(it, account, name, now))
    }

    fn note_visit(&mut self, account: AccountId, now: UnixTime) -> Result<(), StoreFailure> {
        self.database.once(|it| accounts::note_visit(it, account, now))
    }

    fn settings(&mut self, account: AccountId) -> Result<AccountSettings, StoreFailure> {
        self.database.once(|it| accounts::settings(it, account))
    }

    fn set_settings(
        &mut self,
        account: AccountId,
        settings: &AccountSettings,
    ) -> Result<(), StoreFailure> {
        let settings = settings.checked()?;
        self.database.once(|it| accounts::set_settings(it, account, settings))
    }

    fn ban(&mut self, ban: &Ban) -> Result<(), StoreFailure> {
        self.database.change(|it| bans::add(it, ban))
    }

    fn unban(&mut self, target: &BanTarget) -> Result<bool, StoreFailure> {
        self.database.change(|it| bans::remove(it, target))
    }

    fn bans(&mut self, now: UnixTime) -> Result<Vec<Ban>, StoreFailure> {
        self.database.once(|it| bans::in_force(it, now))
    }

    fn record(
        &mut self,
        account: AccountId,
        run: &VerifiedLevel,
        now: UnixTime,
    ) -> Result<Improved, StoreFailure> {
        self.database.change(|it| results::record(it, account, run, now))
    }

    fn begin_daily(
        &mut self,
        account: AccountId,
        day: Day,
        now: UnixTime,
    ) -> Result<Option<DailyTry>, StoreFailure> {
        self.database.change(|it| results::begin_daily(it, account, day, now))
    }

    fn record_daily(
        &mut self,
        daily: &DailyTry,
        run: &VerifiedDescent,
        now: UnixTime,
    ) -> Result<bool, StoreFailure> {
        self.database.change(|it| results::record_daily(it, daily, run, now))
    }

    fn bests(&mut self, account: AccountId) -> Result<Vec<(LevelBoard, Best)>, StoreFailure> {
        self.database.once(|it| results::bests(it, account))
    }

    fn level_boards(&mut self) -> Result<Vec<LevelBoard>, StoreFailure> {
        self.database.once(results::level_boards)
    }

    fn level_scores(
        &mut self,
        board: &LevelBoard,
        most: usize,
    ) -> Result<Vec<LevelScore>, StoreFailure> {
        self.database.once(|it| results::level_scores(it, board, most))
    }

    fn daily_scores(&mut self, day: Day, most: usize) -> Result<Vec<DailyScore>, StoreFailure> {
        self.database.once(|it| results::daily_scores(it, day, most))
    }

    fn script(
        &mut self,
        account: AccountId,
        board: &LevelBoard,
    ) -> Result<Option<String>, StoreFailure> {
        self.database.once(|it| results::script(it, account, board))
    }

    fn checkpoint(&mut self) -> Result<(), StoreFailure> {
        self.database.checkpoint()
    }
}
