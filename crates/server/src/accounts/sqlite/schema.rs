//! The tables, and how a file of an older version gets them.

use rusqlite::{Connection, Result, TransactionBehavior};

/// The mark of the file in its header, "Cell".
pub(crate) const APPLICATION: i32 = 0x4365_6c6c;
/// The statements that lead from each version to the next one. They are only ever added to.
pub(crate) const MIGRATIONS: &[&str] = &[FIRST, SECOND, THIRD];
/// All tables with their columns, those first that others refer to.
pub(crate) const TABLES: [(&str, &str); 7] = [
    ("accounts", "id, key, name, named_at, created_at, seen_at"),
    ("names", "key, account, held_until"),
    (
        "settings",
        "account, crosshair, compass, bell, ghost, difficulty, glyphs, colors, frames_per_second, \
         configuration, correction",
    ),
    ("bans", "id, kind, target, until, reason, made_by, made_at"),
    (
        "results",
        "account, level, difficulty, steps, treasure, treasure_total, secrets, secrets_total, alarms, \
         deaths, stunned, rank, verified_at, script",
    ),
    ("dailies", "account, day, floors, treasure, steps, begun_at, verified_at, script"),
    ("account_rates", "network, whole_at_ms"),
];

const FIRST: &str = "
CREATE TABLE accounts (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    key BLOB NOT NULL UNIQUE CHECK (length(key) = 32),
    name TEXT NOT NULL,
    named_at INTEGER NOT NULL,
    created_at INTEGER NOT NULL,
    seen_at INTEGER NOT NULL
) STRICT;

CREATE TABLE names (
    key TEXT NOT NULL PRIMARY KEY,
    account INTEGER NOT NULL REFERENCES accounts,
    held_until INTEGER
) STRICT;
CREATE INDEX names_of_account ON names (account);

CREATE TABLE settings (
    account INTEGER NOT NULL PRIMARY KEY REFERENCES accounts,
    crosshair INTEGER NOT NULL,
    compass INTEGER NOT NULL,
    bell INTEGER NOT NULL,
    ghost INTEGER NOT NULL,
    difficulty TEXT NOT NULL,
    glyphs TEXT,
    colors TEXT,
    frames_per_second INTEGER,
    configuration TEXT NOT NULL
) STRICT;

CREATE TABLE bans (
    id INTEGER PRIMARY KEY,
    kind TEXT NOT NULL CHECK (kind IN ('key', 'name', 'addresses')),
    target TEXT NOT NULL,
    until INTEGER,
    reason TEXT NOT NULL,
    made_by TEXT NOT NULL,
    made_at INTEGER NOT NULL
) STRICT;

CREATE TABLE results (
    account INTEGER NOT NULL REFERENCES accounts,
    level TEXT NOT NULL,
    difficulty TEXT NOT NULL,
    steps INTEGER NOT NULL CHECK (steps >= 0),
    treasure INTEGER NOT NULL,
    treasure_total INTEGER NOT NULL,
    secrets INTEGER NOT NULL,
    secrets_total INTEGER NOT NULL,
    alarms INTEGER NOT NULL,
    deaths INTEGER NOT NULL,
    stunned INTEGER NOT NULL,
    rank TEXT NOT NULL,
    verified_at INTEGER NOT NULL,
    script TEXT NOT NULL,
    PRIMARY KEY (account, level, difficulty)
) STRICT;
CREATE INDEX results_of_board ON results (level, difficulty, steps, verified_at, account);

CREATE TABLE dailies (
    account INTEGER NOT NULL REFERENCES accounts,
    day INTEGER NOT NULL,
    floors INTEGER NOT NULL,
    treasure INTEGER NOT NULL,
    steps INTEGER NOT NULL CHECK (steps >= 0),
    begun_at INTEGER NOT NULL,
    verified_at INTEGER NOT NULL,
    script TEXT NOT NULL,
    PRIMARY KEY (account, day)
) STRICT;
CREATE INDEX dailies_of_day ON dailies (day);
";

const SECOND: &str = "
CREATE TABLE account_rates (
    network TEXT NOT NULL PRIMARY KEY,
    whole_at_ms INTEGER NOT NULL
) STRICT;
";

const THIRD: &str = "ALTER TABLE settings ADD COLUMN correction TEXT";

/// The version of the file: the number of migrations that it has. In a file that no Cellcaster wrote, it
/// may be negative.
pub(crate) fn version(connection: &Connection) -> Result<i64> {
    connection.query_row("PRAGMA user_version", [], |row| row.get(0))
}

/// The version of a file that has all migrations.
pub(crate) fn newest() -> i64 {
    MIGRATIONS.len() as i64
}

/// Brings a file to the newest version, all at once or not at all.
pub(crate) fn migrate(connection: &mut Connection, migrations: &[&str]) -> Result<()> {
    let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
    let done = usize::try_from(version(&transaction)?).unwrap_or(usize::MAX);
    for (number, migration) in (1..).zip(migrations).skip(done) {
        transaction.execute_batch(migration)?;
        transaction.pragma_update(None, "user_version", number)?;
    }
    transaction.pragma_update(None, "application_id", APPLICATION)?;
    transaction.commit()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn migrations_are_applied_once_and_in_order() {
        let mut connection = Connection::open_in_memory().unwrap();
        let migrations =
            ["CREATE TABLE a (x INTEGER); INSERT INTO a VALUES (1)", "UPDATE a SET x = x * 10 + 2"];
        let value = |connection: &Connection| -> i64 {
            connection.query_row("SELECT x FROM a", [], |row| row.get(0)).unwrap()
        };
        migrate(&mut connection, &migrations[..1]).unwrap();
        assert_eq!((version(&connection).unwrap(), value(&connection)), (1, 1));
        for _ in 0..2 {
            migrate(&mut connection, &migrations).unwrap();
            assert_eq!((version(&connection).unwrap(), value(&connection)), (2, 12));
        }
        let faulty = [migrations[0], migrations[1], "UPDATE a SET x = 7", "CREATE nonsense"];
        assert!(migrate(&mut connection, &faulty).is_err());
        assert_eq!((version(&connection).unwrap(), value(&connection)), (2, 12));
    }

    #[test]
    fn the_list_of_tables_is_that_of_the_file() {
        let mut connection = Connection::open_in_memory().unwrap();
        migrate(&mut connection, MIGRATIONS).unwrap();
        for (table, columns) in TABLES {
            let sql = "SELECT group_concat(name, ', ') FROM pragma_table_info(?1)";
            let known: String = connection.query_row(sql, [table], |row| row.get(0)).unwrap();
            assert_eq!(known, columns, "{table}");
        }
        let sql =
            "SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite_%'";
        let count: isize = connection.query_row(sql, [], |row| row.get(0)).unwrap();
        assert_eq!(count, TABLES.len() as isize);
    }
}
