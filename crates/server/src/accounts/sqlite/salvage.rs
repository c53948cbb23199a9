//! Reading what can be read of a damaged file.

use std::path::Path;

use rusqlite::types::Value;
use rusqlite::{Connection, OpenFlags, Result, TransactionBehavior, params_from_iter};

use super::schema::TABLES;

/// Copies the rows of a damaged file that can be read and obey the rules of their table, and returns their
/// number. Each table is read from both ends, so that a damaged page hides what is on it and no more.
pub(crate) fn salvage(damaged: &Path, into: &mut Connection) -> Result<usize> {
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let Ok(from) = Connection::open_with_flags(damaged, flags) else { return Ok(0) };
    let transaction = into.transaction_with_behavior(TransactionBehavior::Immediate)?;
    let mut rows = 0;
    for (table, columns) in TABLES {
        for direction in ["ASC", "DESC"] {
            let sql =
                format!("SELECT {columns} FROM {table} NOT INDEXED ORDER BY rowid {direction}");
            // What can't be read is lost, and the damaged file is kept.
            _ = copy(&from, &sql, &transaction, table, columns, &mut rows);
        }
    }
    transaction.commit()?;
    Ok(rows)
}

/// Copies rows until one can't be read, and counts them.
fn copy(
    from: &Connection,
    sql: &str,
    into: &Connection,
    table: &str,
    columns: &str,
    rows: &mut usize,
) -> Result<()> {
    let places = vec!["?"; columns.split(',').count()].join(", ");
    let insert = format!("INSERT OR IGNORE INTO {table} ({columns}) VALUES ({places})");
    let mut insert = into.prepare(&insert)?;
    let mut select = from.prepare(sql)?;
    let count = select.column_count();
    let mut found = select.query([])?;
    while let Some(row) = found.next()? {
        let values =
            (0..count).map(|column| row.get::<_, Value>(column)).collect::<Result<Vec<_>>>();
        if let Ok(values) = values {
            *rows += insert.execute(params_from_iter(values)).unwrap_or_default();
        }
    }
    Ok(())
}
