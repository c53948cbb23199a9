//! A store in a PostgreSQL database, which several hosts share.
//!
//! Rules:
//!
//! - **A change is on the server's disk when its method returns**, unless the server is told not to wait for
//!   its disk (`fsync = off`).
//! - **Transactions are serializable**, but for those whose statements each do all by themselves. One that meets another is run again, after a random wait that doubles,
//!   up to [`MOST_CONFLICTS`] times.
//! - **Each call ends after [`PATIENCE`]**, whatever the server or the network does. The limit is kept on both
//!   sides: by a timer here, and by `statement_timeout` there.
//! - **A lost connection is made again.** A call that lost it before it asked to keep its change is run once
//!   more. One that lost it after that fails, and its sentence says that the change may be kept or not.
//!   After a connection that could not be made, calls fail at once for [`PAUSE`].
//! - **The tables are made by the first host**, under a lock, and have a version. Those of a newer version are
//!   left alone, and so is a database in which another program has tables of these names.
//! - **A password is never shown.** Sentences have neither the address as it was given nor a part of it that
//!   may belong to a misspelt password.
//! - **A text may have any character**, also the one with the number 0, which PostgreSQL's texts have not: it
//!   is escaped.
//!
//! A pool of connections was refused: a host has one thread for its store. The crate `postgres` was refused:
//! its calls wait without limit for a server that has stopped without closing its connections.

mod address;
mod lease;
mod presence;
mod schema;
mod session;
mod tls;
mod value;

use std::fmt;
use std::thread;
use std::time::{Duration, Instant};

use self::address::Address;
use self::session::{Call, Fault, Link};
use super::StoreFailure;
use super::sql::{Database, SqlStore, Statements};

/// The most time that a call takes.
const PATIENCE: Duration = Duration::from_secs(5);
/// The most time that the end of a failed transaction takes.
const UNDO_PATIENCE: Duration = Duration::from_secs(1);
/// The most time that making the tables takes, also while another host makes them.
const SCHEMA_PATIENCE: Duration = Duration::from_secs(30);
/// The time after a connection that could not be made in which none is tried.
const PAUSE: Duration = Duration::from_secs(1);
/// How often a transaction is run again because it met others.
const MOST_CONFLICTS: u32 = 12;
/// The longest wait before a transaction is run again.
const LONGEST_WAIT: Duration = Duration::from_millis(128);

/// A store in a PostgreSQL database.
pub type PostgresStore = SqlStore<PostgresDatabase>;

/// The database of a [`PostgresStore`].
pub struct PostgresDatabase {
    link: Link,
}

impl PostgresStore {
    /// The store at an address such as `postgres://user@host/database`, whose tables are made if there are
    /// none.
    ///
    /// # Errors
    /// If the server can't be reached, or the database is of a newer version or of another program.
    pub fn open(address: &str) -> Result<Self, StoreFailure> {
        let mut link = Link::new(Address::parse(address)?, false)?;
        let call = link.call(SCHEMA_PATIENCE)?;
        schema::migrate(&call, schema::MIGRATIONS)?;
        Ok(Self { database: PostgresDatabase { link } })
    }

    /// The store at an address to read from. `None` if there is none. All methods that change something
    /// fail.
    ///
    /// # Errors
    /// If the server can't be reached, or the database is of another version.
    pub fn open_to_read(address: &str) -> Result<Option<Self>, StoreFailure> {
        let mut link = Link::new(Address::parse(address)?, true)?;
        let has_tables = schema::check_to_read(&link.call(PATIENCE)?)?;
        Ok(has_tables.then_some(Self { database: PostgresDatabase { link } }))
    }
}

impl Database for PostgresDatabase {
    fn once<T, E: From<StoreFailure>>(
        &mut self,
        act: impl FnMut(&dyn Statements) -> Result<T, E>,
    ) -> Result<T, E> {
        self.run(Kind::Repeatable, act)
    }

    fn change<T, E: From<StoreFailure>>(
        &mut self,
        act: impl FnMut(&dyn Statements) -> Result<T, E>,
    ) -> Result<T, E> {
        self.run(Kind::Serializable, act)
    }
}

/// How statements are run.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// A statement by itself, which may as well run twice.
    Repeatable,
    /// A transaction whose statements each see what others have kept until then.
    Committed,
    /// A transaction as if there were no other.
    Serializable,
}

impl PostgresDatabase {
    /// Runs a transaction whose statements each see what others have kept until then, and wait for those who
    /// change the same row.
    fn change_rows<T>(
        &mut self,
        act: impl FnMut(&dyn Statements) -> Result<T, StoreFailure>,
    ) -> Result<T, StoreFailure> {
        self.run(Kind::Committed, act)
    }

    fn run<T, E: From<StoreFailure>>(
        &mut self,
        kind: Kind,
        mut act: impl FnMut(&dyn Statements) -> Result<T, E>,
    ) -> Result<T, E> {
        let deadline = Instant::now() + PATIENCE;
        let (mut conflicts, mut was_lost) = (0, false);
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            let call = self.link.call(left)?;
            let result = match kind {
                Kind::Repeatable => act(&call),
                Kind::Committed => in_transaction(&call, "READ COMMITTED", &mut act),
                Kind::Serializable => in_transaction(&call, "SERIALIZABLE", &mut act),
            };
            let failure = match result {
                Ok(value) => return Ok(value),
                Err(failure) => failure,
            };
            match call.fault() {
                Some(Fault::Lost) if !was_lost => {
                    self.link.close();
                    was_lost = true;
                }
                Some(Fault::Lost | Fault::Unknown) => {
                    self.link.close();
                    return Err(failure);
                }
                Some(Fault::Conflict) if conflicts < MOST_CONFLICTS => {
                    self.undo(kind);
                    thread::sleep(wait(conflicts));
                    conflicts += 1;
                }
                Some(Fault::Conflict | Fault::Full | Fault::Refused) | None => {
                    self.undo(kind);
                    return Err(failure);
                }
            }
        }
    }

    /// Ends a transaction that has failed. If that fails, too, the connection is given up, and the
    /// transaction with it.
    fn undo(&mut self, kind: Kind) {
        if kind == Kind::Repeatable {
            return;
        }
        let is_undone =
            self.link.call(UNDO_PATIENCE).is_ok_and(|call| call.batch("ROLLBACK").is_ok());
        if !is_undone {
            self.link.close();
        }
    }
}

fn in_transaction<T, E: From<StoreFailure>>(
    call: &Call<'_>,
    isolation: &str,
    act: &mut impl FnMut(&dyn Statements) -> Result<T, E>,
) -> Result<T, E> {
    call.batch(&format!("BEGIN ISOLATION LEVEL {isolation}"))?;
    let value = act(call)?;
    call.commit()?;
    Ok(value)
}

/// A random wait of up to 1 ms, 2 ms, 4 ms and so on.
fn wait(conflicts: u32) -> Duration {
    let longest = (Duration::from_millis(1) * (1 << conflicts.min(10))).min(LONGEST_WAIT);
    // Without chance, two that met would meet again.
    let share = getrandom::u32().map_or(1.0, |number| f64::from(number) / f64::from(u32::MAX));
    longest.mul_f64(share)
}

impl fmt::Debug for PostgresDatabase {
    /// Without what may be secret.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PostgresDatabase").finish_non_exhaustive()
    }
}
