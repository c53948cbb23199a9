//! A store in a SQLite file.
//!
//! Rules:
//!
//! - **A change is on the disk when its method returns.** The file has a write-ahead log, which is
//!   synchronised with each transaction (`journal_mode = WAL`, `synchronous = FULL`). A process that is
//!   killed loses at most the change that has not returned.
//! - **Others can read at the same time**, such as `cellcaster scores`.
//! - **The log is short.** What is in it is copied into the file at each start and end.
//! - **A damaged file is kept.** [`open`](SqliteStore::open) checks the whole file, and refuses a damaged one.
//!   [`open_or_salvage`](SqliteStore::open_or_salvage) renames it to `host.db.damaged-1` with its log, copies
//!   all rows that can be read into a new file, and says so in a sentence. That is never done unasked: names
//!   would be free to take, and bans gone.
//! - **A file of a newer version is left alone**, and so is one of another program.
//! - **Nobody else on the machine reads it**: the file has the mode 0600, and the folder 0700 where it is
//!   created.
//!
//! SQLite's own table of statements is not used (rusqlite's feature `cache`): a host prepares some ten
//! statements a second.

mod opening;
mod salvage;
mod schema;

use std::path::Path;

use rusqlite::types::{ToSqlOutput, Value as SqliteValue, ValueRef};
use rusqlite::{Connection, ErrorCode, ToSql, TransactionBehavior, params_from_iter};

#[cfg(fuzzing)]
pub use rusqlite::types::Value as ColumnValue;

use super::StoreFailure;
use super::sql::{Database, Row, SqlStore, Statements, Value};

/// A store in the file `host.db` of a folder.
pub type SqliteStore = SqlStore<SqliteFile>;

/// The file of a [`SqliteStore`].
#[derive(Debug)]
pub struct SqliteFile {
    pub(crate) connection: Connection,
}

impl SqliteStore {
    /// The store in `folder`, which is created if it does not exist.
    ///
    /// # Errors
    /// If the folder can't be used, or the file is damaged, of a newer version or of another program.
    pub fn open(folder: &Path) -> Result<Self, StoreFailure> {
        let connection = opening::open(folder)?;
        Ok(Self { database: SqliteFile { connection } })
    }

    /// The store in `folder`; if its file was damaged, a new one with the rows that can be read, and a sentence
    /// about it.
    ///
    /// # Errors
    /// If the folder can't be used, or the file is of a newer version or of another program.
    pub fn open_or_salvage(folder: &Path) -> Result<(Self, Option<String>), StoreFailure> {
        let (connection, sentence) = opening::open_or_salvage(folder)?;
        Ok((Self { database: SqliteFile { connection } }, sentence))
    }

    /// The store in `folder` to read from while a host uses it. `None` if there is none. All methods that
    /// change something fail.
    ///
    /// # Errors
    /// If it can't be read, or is of another version.
    pub fn open_to_read(folder: &Path) -> Result<Option<Self>, StoreFailure> {
        let connection = opening::open_to_read(folder)?;
        Ok(connection.map(|connection| Self { database: SqliteFile { connection } }))
    }
}

impl Database for SqliteFile {
    fn once<T, E: From<StoreFailure>>(
        &mut self,
        mut act: impl FnMut(&dyn Statements) -> Result<T, E>,
    ) -> Result<T, E> {
        act(&self.connection)
    }

    fn change<T, E: From<StoreFailure>>(
        &mut self,
        mut act: impl FnMut(&dyn Statements) -> Result<T, E>,
    ) -> Result<T, E> {
        // One that begins by reading could not wait for another one that writes.
        let behavior = TransactionBehavior::Immediate;
        let transaction = self.connection.transaction_with_behavior(behavior);
        let transaction = transaction.map_err(StoreFailure::from)?;
        let result = act(&*transaction)?;
        transaction.commit().map_err(StoreFailure::from)?;
        Ok(result)
    }

    fn checkpoint(&mut self) -> Result<(), StoreFailure> {
        Ok(opening::checkpoint(&self.connection)?)
    }
}

impl Statements for Connection {
    fn execute(&self, sql: &str, values: &[Value]) -> Result<u64, StoreFailure> {
        Ok(Self::execute(self, sql, params_from_iter(values))? as u64)
    }

    fn rows(&self, sql: &str, values: &[Value]) -> Result<Vec<Row>, StoreFailure> {
        let mut statement = self.prepare(sql)?;
        let count = statement.column_count();
        let mut found = statement.query(params_from_iter(values))?;
        let mut rows = Vec::new();
        while let Some(row) = found.next()? {
            let values = (0..count).map(|column| value(row.get_ref(column)?));
            rows.push(Row(values.collect::<Result<_, StoreFailure>>()?));
        }
        Ok(rows)
    }
}

impl ToSql for Value {
    fn to_sql(&self) -> rusqlite::Result<ToSqlOutput<'_>> {
        Ok(match self {
            Self::Null => ToSqlOutput::Owned(SqliteValue::Null),
            Self::Integer(number) => ToSqlOutput::Owned(SqliteValue::Integer(*number)),
            Self::Text(text) => ToSqlOutput::Borrowed(ValueRef::Text(text.as_bytes())),
            Self::Bytes(bytes) => ToSqlOutput::Borrowed(ValueRef::Blob(bytes)),
        })
    }
}

fn value(value: ValueRef<'_>) -> Result<Value, StoreFailure> {
    let unknown = |what: &str| StoreFailure::new(format!("the host's store has {what}"));
    Ok(match value {
        ValueRef::Null => Value::Null,
        ValueRef::Integer(number) => Value::Integer(number),
        ValueRef::Text(text) => match str::from_utf8(text) {
            Ok(text) => text.into(),
            Err(_) => return Err(unknown("a text that is not UTF-8")),
        },
        ValueRef::Blob(bytes) => bytes.into(),
        ValueRef::Real(_) => return Err(unknown("a number that is not whole")),
    })
}

impl From<rusqlite::Error> for StoreFailure {
    fn from(error: rusqlite::Error) -> Self {
        let sentence = format!("the host's store failed: {error}");
        match error.sqlite_error_code() {
            Some(ErrorCode::DiskFull) => Self::full(sentence),
            _ => Self::new(sentence),
        }
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
        Self { database: SqliteFile { connection } }
    }
}

#[cfg(fuzzing)]
impl SqliteStore {
    /// Removes all rows.
    ///
    /// # Panics
    /// Without memory for it.
    #[doc(hidden)]
    pub fn clear(&mut self) {
        let tables = schema::TABLES.iter().rev().map(|(table, _)| *table);
        for table in tables.chain(["sqlite_sequence"]) {
            let sql = format!("DELETE FROM {table}");
            self.database.connection.execute_batch(&sql).unwrap();
        }
    }

    /// Puts a row into the table with that number, whatever refers to what. Returns whether the table takes it.
    ///
    /// # Panics
    /// If the database does not stop to look at references.
    #[doc(hidden)]
    pub fn put(&mut self, table: usize, values: &[ColumnValue]) -> bool {
        let connection = &self.database.connection;
        let open = "PRAGMA foreign_keys = OFF; PRAGMA ignore_check_constraints = ON";
        connection.execute_batch(open).unwrap();
        let (table, columns) = schema::TABLES[table % schema::TABLES.len()];
        let count = columns.split(", ").count();
        let parameters: Vec<String> = (1..=count).map(|number| format!("?{number}")).collect();
        let parameters = parameters.join(", ");
        let sql = format!("INSERT OR REPLACE INTO {table} ({columns}) VALUES ({parameters})");
        let values = values.iter().chain(std::iter::repeat(&ColumnValue::Null)).take(count);
        connection.execute(&sql, params_from_iter(values)).is_ok()
    }
}
