//! In-memory stores for tests.

use std::time::Duration;

use rusqlite::Connection;
#[cfg(feature = "fuzzing")]
use rusqlite::params_from_iter;
#[cfg(feature = "fuzzing")]
use rusqlite::types::Value;

#[cfg(test)]
use super::StoreFailure;
use super::sqlite::make_tables;
use super::store::Database;
use super::{HostStore, LevelBoard, VerifiedRun};
use cellcaster::game::{Rank, Tally};

impl HostStore {
    /// A store that ends with the program. Its clock stands still until a test lets time [pass](Self::pass).
    ///
    /// # Panics
    /// If there is not enough memory.
    #[doc(hidden)]
    pub fn in_memory() -> Self {
        let mut connection = Connection::open_in_memory().unwrap();
        connection.execute_batch("PRAGMA foreign_keys = ON").unwrap();
        make_tables(&mut connection).unwrap();
        let clock = "DROP VIEW clock; CREATE TABLE clock (ms INTEGER); \
                     INSERT INTO clock VALUES (1000000000000)";
        connection.execute_batch(clock).unwrap();
        Self { database: Database::File(connection) }
    }

    /// A store whose calls all fail.
    #[cfg(test)]
    pub(crate) fn failing(failure: StoreFailure) -> Self {
        Self { database: Database::Failing(failure) }
    }

    /// The SQLite connection.
    ///
    /// # Panics
    /// If the store is in another kind of database.
    pub(crate) fn connection(&self) -> &Connection {
        let Database::File(connection) = &self.database else { panic!("not a file") };
        connection
    }

    /// Advances the clock for leases, hosts and visits.
    pub(crate) fn pass(&mut self, time: Duration) {
        let time = i64::try_from(time.as_millis()).unwrap();
        self.connection().execute("UPDATE clock SET ms = ms + ?1", [time]).unwrap();
    }

    /// Removes all rows.
    ///
    /// # Panics
    /// If there is not enough memory.
    #[cfg(feature = "fuzzing")]
    #[doc(hidden)]
    pub fn clear(&mut self) {
        let connection = self.connection();
        let tables = tables(connection).unwrap().into_iter().rev().map(|(table, _)| table);
        for table in tables.filter(|it| it != "clock").chain(["sqlite_sequence".to_owned()]) {
            connection.execute_batch(&format!("DELETE FROM {table}")).unwrap();
        }
    }

    /// Inserts a row into a table, whatever the references and constraints are. Returns true if the table accepts
    /// it.
    ///
    /// # Panics
    /// If the database does not turn off its checks.
    #[cfg(feature = "fuzzing")]
    #[doc(hidden)]
    pub fn put(&mut self, table: usize, values: &[Value]) -> bool {
        let connection = self.connection();
        let open = "PRAGMA foreign_keys = OFF; PRAGMA ignore_check_constraints = ON";
        connection.execute_batch(open).unwrap();
        let tables = tables(connection).unwrap();
        let (table, columns) = &tables[table % tables.len()];
        let count = columns.split(", ").count();
        let parameters = vec!["?"; count].join(", ");
        let sql = format!("INSERT OR REPLACE INTO {table} ({columns}) VALUES ({parameters})");
        let values = values.iter().chain(std::iter::repeat(&Value::Null)).take(count);
        connection.execute(&sql, params_from_iter(values)).is_ok()
    }
}

impl VerifiedRun {
    /// A run that was not verified.
    #[doc(hidden)]
    pub fn made_up(board: LevelBoard, tally: Tally, rank: Rank, script: &str) -> Self {
        Self { board, tally, rank, script: script.to_owned() }
    }
}

/// The tables and their columns. A table comes after the tables that it refers to.
#[cfg(feature = "fuzzing")]
fn tables(connection: &Connection) -> rusqlite::Result<Vec<(String, String)>> {
    let sql = "SELECT name, (SELECT group_concat(name, ', ') FROM pragma_table_info(tables.name)) \
               FROM sqlite_schema AS tables WHERE type = 'table' AND name NOT LIKE 'sqlite_%' \
               ORDER BY rowid";
    let mut statement = connection.prepare(sql)?;
    statement.query_map([], |row| Ok((row.get(0)?, row.get(1)?)))?.collect()
}
