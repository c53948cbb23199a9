//! The statements of a store, in a SQLite file or on a PostgreSQL server that several hosts share.
//!
//! Rules:
//!
//! - **Every statement is written once, in the SQL that both databases share.** Parameters are `?1`, `?2` and so on.
//!   `json_each` expands an object, and the view `clock` contains the database's own time in milliseconds. The modules
//!   of the two databases contain only the differences: opening, transactions, and failures.
//! - **Values are bound, never written into a statement.** rusqlite's traits convert them for both databases.
//! - **A change that reads before it writes is a transaction.** It may run several times until it meets no conflict, so
//!   it must do nothing but run statements.
//!
//! Rejected: sqlx. It has a pool and migrations, but no deadline for a call, no retry of a transaction or of a lost
//! connection, and no way to read the rest of a damaged file. The two dialects would also remain. Also rejected: a
//! trait with a method for each statement. Each database would repeat all of them, and they would drift apart.

use rusqlite::ToSql;
use rusqlite::types::{FromSql, FromSqlResult, ToSqlOutput, Value, ValueRef};

use super::{AccountId, Name, StoreFailure, UnixTime};

/// The isolation of statements from transactions that run at the same time.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Isolation {
    /// Each statement runs by itself, and can run twice without harm.
    None,
    /// A transaction in which each statement sees the changes that others have committed by then.
    Committed,
    /// A transaction that runs as if there were no others.
    Serializable,
}

/// Runs statements, in a transaction or outside of one.
pub(crate) trait Statements {
    /// Runs a statement, and returns the number of rows that it changed.
    fn execute(&self, sql: &str, values: &[&dyn ToSql]) -> Result<u64, StoreFailure>;

    /// Runs a statement, and returns its rows.
    fn rows(&self, sql: &str, values: &[&dyn ToSql]) -> Result<Vec<Row>, StoreFailure>;

    /// Holds a lock until the transaction ends. If another transaction holds it, waits for that one.
    fn lock(&self, name: &str) -> Result<(), StoreFailure>;

    /// Runs a statement, and returns its first row.
    fn row(&self, sql: &str, values: &[&dyn ToSql]) -> Result<Option<Row>, StoreFailure> {
        Ok(self.rows(sql, values)?.into_iter().next())
    }
}

/// The columns of a row.
#[derive(Debug)]
pub(crate) struct Row(pub(crate) Vec<Value>);

/// The version of the [tables](SCHEMA). Lower versions were never released.
pub(crate) const VERSION: i64 = 7;

/// The tables in SQLite's dialect. `postgres` translates the types.
pub(crate) const SCHEMA: &str = include_str!("schema.sql");

impl Row {
    /// The value of a column.
    pub(crate) fn get<T: FromSql>(&self, column: usize) -> Result<T, StoreFailure> {
        let value = self.0.get(column).map(|value| T::column_result(ValueRef::from(value)));
        value.and_then(Result::ok).ok_or_else(|| {
            let sentence =
                format!("the host's store has a value of the wrong type in column {column}");
            StoreFailure::new(sentence)
        })
    }

    /// The value of a column with a number that is never negative.
    pub(crate) fn count(&self, column: usize) -> Result<u64, StoreFailure> {
        Ok(self.get::<i64>(column)?.max(0) as u64)
    }
}

impl ToSql for UnixTime {
    fn to_sql(&self) -> rusqlite::Result<ToSqlOutput<'_>> {
        Ok((self.seconds() as i64).into())
    }
}

impl FromSql for UnixTime {
    fn column_result(value: ValueRef<'_>) -> FromSqlResult<Self> {
        i64::column_result(value).map(|seconds| Self::new(seconds.max(0) as u64))
    }
}

impl ToSql for AccountId {
    fn to_sql(&self) -> rusqlite::Result<ToSqlOutput<'_>> {
        Ok(self.0.into())
    }
}

impl FromSql for AccountId {
    fn column_result(value: ValueRef<'_>) -> FromSqlResult<Self> {
        i64::column_result(value).map(Self)
    }
}

impl ToSql for Name {
    fn to_sql(&self) -> rusqlite::Result<ToSqlOutput<'_>> {
        self.as_str().to_sql()
    }
}

impl FromSql for Name {
    fn column_result(value: ValueRef<'_>) -> FromSqlResult<Self> {
        value.as_str().map(Self::kept)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_is_read_only_as_its_own_type() {
        let bytes = Value::Blob(vec![1; 32]);
        let row = Row(vec![Value::Null, 7_i64.into(), "x".to_owned().into(), bytes]);
        assert_eq!(row.get::<Option<i64>>(0).unwrap(), None);
        assert_eq!(row.get::<Option<u32>>(1).unwrap(), Some(7));
        assert_eq!(row.get::<String>(2).unwrap(), "x");
        assert_eq!(row.get::<[u8; 32]>(3).unwrap(), [1; 32]);
        for column in [0, 2, 3, 4] {
            let failure = row.get::<i64>(column).unwrap_err().to_string();
            assert!(failure.ends_with(&format!("column {column}")), "{failure}");
        }
        assert!(row.get::<Option<u32>>(2).is_err() && row.get::<String>(1).is_err());
        assert!(Row(vec![Value::Integer(-1)]).get::<u32>(0).is_err());
        assert!(Row(vec![Value::Blob(vec![1; 31])]).get::<[u8; 32]>(0).is_err());
    }
}
