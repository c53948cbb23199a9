//! The store's SQLite file: its location, its permissions, and whether it is sound.
//!
//! Rules:
//!
//! - **A change is on the disk when its method returns.** The file has a write-ahead log, which is synchronised with
//!   each transaction (`journal_mode = WAL`, `synchronous = FULL`). A process that is killed loses at most the change
//!   whose method has not returned.
//! - **Other processes can read at the same time**, such as `cellcaster-server scores`.
//! - **The log stays short.** Its content is copied into the file at each start and end.
//! - **A damaged file is left alone.** [`open`] checks the whole file. Rejected: copying the readable rows into a new
//!   file. SQLite's own program does that, too.
//! - **A file of another version or of another program is left alone.**
//! - **No other user of the machine can read it**: the file has the mode 0600, and a new folder has the mode 0700.
//!
//! Rejected: a cache of prepared statements (rusqlite's feature `cache`). A host prepares about ten statements a
//! second.

use std::path::{Path, PathBuf};
use std::time::Duration;
use std::{fmt, fs};

use cellcaster::app::store::private;
use cellcaster::fault::printable_path;
use rusqlite::types::Value;
use rusqlite::{Connection, ErrorCode, OpenFlags, ToSql, TransactionBehavior};

use super::StoreFailure;
use super::statements::{Isolation, Row, SCHEMA, Statements, VERSION};

/// The mark in the file's header, "Cell".
const APPLICATION: i64 = 0x4365_6c6c;
/// The view with the time of the database.
const CLOCK: &str = "CREATE VIEW clock AS SELECT CAST(unixepoch('subsec') * 1000 AS INTEGER) AS ms";
const FILE: &str = "host.db";
/// The suffixes of SQLite's log, and of the index of the log.
const LOGS: [&str; 2] = ["-wal", "-shm"];
/// The most time to wait for another process.
const TIMEOUT: Duration = Duration::from_secs(5);

/// Opens the file in `folder` to read and write. A damaged file is an error, and stays unchanged.
pub(crate) fn open(folder: &Path) -> Result<Connection, StoreFailure> {
    let file = folder.join(FILE);
    if has_lost_its_content(&file) {
        return Err(failure(&file, DAMAGED));
    }
    let is_new = !file.exists();
    private::create_folder(folder)
        .and_then(|()| private::create_file(&file))
        .map_err(|error| failure(&file, &format!("can't be used: {error}")))?;
    connect(&file).inspect_err(|_| {
        // An empty file would count as damaged at the next start.
        if is_new && fs::metadata(&file).is_ok_and(|data| data.len() == 0) {
            _ = fs::remove_file(&file);
        }
    })
}

/// Returns true if the file is empty, or missing although its log exists. SQLite would treat it as a new database, and
/// delete the log.
fn has_lost_its_content(file: &Path) -> bool {
    match fs::metadata(file) {
        Ok(data) => data.is_file() && data.len() == 0,
        Err(_) => fs::metadata(with_end(file, LOGS[0])).is_ok_and(|log| log.len() > 0),
    }
}

/// Copies the content of the write-ahead log into the file, and empties the log. Content that another process is still
/// reading remains in the log.
pub(crate) fn checkpoint(connection: &Connection) -> rusqlite::Result<()> {
    connection.query_row("PRAGMA wal_checkpoint(TRUNCATE)", [], |_| Ok(()))
}

/// Opens the file in `folder` to read from it, if it exists.
pub(crate) fn open_to_read(folder: &Path) -> Result<Option<Connection>, StoreFailure> {
    let file = folder.join(FILE);
    if !file.exists() {
        return Ok(None);
    }
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let unreadable = |error: &dyn fmt::Display| failure(&file, &format!("can't be read: {error}"));
    // This check does not open the file, because closing it again would release the locks of this process.
    private::check_is_file(&file).map_err(|error| unreadable(&error))?;
    let connection = Connection::open_with_flags(&file, flags).and_then(|connection| {
        connection.busy_timeout(TIMEOUT)?;
        Ok((version(&connection)?, connection))
    });
    let (version, connection) = connection.map_err(|error| unreadable(&error))?;
    if version == 0 {
        return Ok(None);
    }
    check_origin(&connection, &file)?;
    Ok(Some(connection))
}

const DAMAGED: &str = "is damaged: restore a backup, or move the file and its logs away to begin without accounts and bans";

fn failure(file: &Path, what: &str) -> StoreFailure {
    StoreFailure::new(format!("{} {what}", printable_path(file)))
}

/// Runs statements of SQLite on `file`, which may be damaged.
fn on_file<T>(file: &Path, act: impl FnOnce() -> rusqlite::Result<T>) -> Result<T, StoreFailure> {
    act().map_err(|error| match error.sqlite_error_code() {
        Some(ErrorCode::DatabaseCorrupt | ErrorCode::NotADatabase) => failure(file, DAMAGED),
        _ => error.into(),
    })
}

/// Opens a file that must be sound and of this version.
fn connect(file: &Path) -> Result<Connection, StoreFailure> {
    // Without SQLITE_OPEN_URI, so that a path is never read as a URI.
    let flags = OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let mut connection = on_file(file, || Connection::open_with_flags(file, flags))?;
    let text = |connection: &Connection, pragma: &str| {
        on_file(file, || connection.query_row(pragma, [], |row| row.get::<_, String>(0)))
    };
    on_file(file, || connection.busy_timeout(TIMEOUT))?;
    check_origin(&connection, file)?;
    if text(&connection, "PRAGMA integrity_check(1)")? != "ok" {
        return Err(failure(file, DAMAGED));
    }
    if !text(&connection, "PRAGMA journal_mode = WAL")?.eq_ignore_ascii_case("wal") {
        let what =
            "can't have a write-ahead log on this file system: use a data folder on a local disk";
        return Err(failure(file, what));
    }
    on_file(file, || {
        connection.execute_batch(
            "PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON; PRAGMA trusted_schema = OFF;",
        )?;
        make_tables(&mut connection)
    })?;
    // Content that cannot be copied now, as on a full disk, is just as safe in the log.
    _ = checkpoint(&connection);
    Ok(connection)
}

/// Refuses a file of another program or of another version.
fn check_origin(connection: &Connection, file: &Path) -> Result<(), StoreFailure> {
    let number =
        |sql: &str| on_file(file, || connection.query_row(sql, [], |row| row.get::<_, i64>(0)));
    let application = number("PRAGMA application_id")?;
    let objects = number("SELECT count(*) FROM sqlite_schema")?;
    let version = number("PRAGMA user_version")?;
    let is_new = application == 0 && version == 0 && objects == 0;
    let what = if application != APPLICATION && !is_new {
        "belongs to another program: move it away, or use another data folder".to_owned()
    } else if version > VERSION {
        format!("has version {version}, which a newer Cellcaster wrote: upgrade this one")
    } else if ![0, VERSION].contains(&version) {
        format!("has version {version}, which this Cellcaster can't read: move it away")
    } else {
        return Ok(());
    };
    Err(failure(file, &what))
}

fn with_end(file: &Path, end: &str) -> PathBuf {
    let mut name = file.as_os_str().to_owned();
    name.push(end);
    name.into()
}

/// The values of a row.
fn values(row: &rusqlite::Row<'_>) -> rusqlite::Result<Vec<Value>> {
    (0..row.as_ref().column_count()).map(|column| row.get(column)).collect()
}

/// The version of the file; 0 if it has no tables. In a file of another program, it may be negative.
fn version(connection: &Connection) -> rusqlite::Result<i64> {
    connection.query_row("PRAGMA user_version", [], |row| row.get(0))
}

/// Creates the tables in a new file, all at once or not at all.
pub(crate) fn make_tables(connection: &mut Connection) -> rusqlite::Result<()> {
    let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
    if version(&transaction)? == 0 {
        transaction.execute_batch(SCHEMA)?;
        transaction.execute_batch(CLOCK)?;
        transaction.pragma_update(None, "user_version", VERSION)?;
        transaction.pragma_update(None, "application_id", APPLICATION)?;
    }
    transaction.commit()
}

/// Runs statements, in a transaction if they need isolation. SQLite runs transactions one after the other.
pub(crate) fn run<T, E: From<StoreFailure>>(
    connection: &mut Connection,
    isolation: Isolation,
    mut act: impl FnMut(&dyn Statements) -> Result<T, E>,
) -> Result<T, E> {
    if isolation == Isolation::None {
        return act(connection);
    }
    // A transaction that begins with a read could not wait for a writing transaction.
    let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate);
    let transaction = transaction.map_err(StoreFailure::from)?;
    let result = act(&*transaction)?;
    transaction.commit().map_err(StoreFailure::from)?;
    Ok(result)
}

impl Statements for Connection {
    fn execute(&self, sql: &str, values: &[&dyn ToSql]) -> Result<u64, StoreFailure> {
        Ok(Self::execute(self, sql, values)? as u64)
    }

    fn rows(&self, sql: &str, parameters: &[&dyn ToSql]) -> Result<Vec<Row>, StoreFailure> {
        let mut statement = self.prepare(sql)?;
        let rows = statement.query_map(parameters, |row| values(row).map(Row))?;
        Ok(rows.collect::<Result<_, _>>()?)
    }

    fn lock(&self, _: &str) -> Result<(), StoreFailure> {
        // A transaction that writes locks the whole file.
        Ok(())
    }
}

impl From<rusqlite::Error> for StoreFailure {
    fn from(error: rusqlite::Error) -> Self {
        let sentence = format!("the host's store failed: {error}");
        match error.sqlite_error_code() {
            Some(ErrorCode::DiskFull) => Self::Full(sentence),
            _ => Self::new(sentence),
        }
    }
}
