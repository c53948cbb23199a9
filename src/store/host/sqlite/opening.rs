//! Opening the file: where it lies, who may read it, and whether it is sound.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

use rusqlite::{Connection, ErrorCode, OpenFlags};

use super::salvage::salvage;
use super::schema::{self, APPLICATION, MIGRATIONS};
use crate::fault::printable_path;
use crate::store::host::StoreFailure;
use crate::store::private;

const FILE: &str = "host.db";
/// What SQLite adds to the name for its log, and for the index of the log.
const LOGS: [&str; 2] = ["-wal", "-shm"];
/// The time to wait for another process.
const PATIENCE: Duration = Duration::from_secs(5);

/// The file in `folder` to read and write, and a sentence if it was damaged.
pub(super) fn open(folder: &Path) -> Result<(Connection, Option<String>), StoreFailure> {
    let file = folder.join(FILE);
    private::create_folder(folder).and_then(|()| private::create_file(&file)).map_err(|error| {
        StoreFailure::new(format!("{} can't be used: {error}", printable_path(&file)))
    })?;
    match connect(&file) {
        Ok(connection) => Ok((connection, None)),
        Err(Fault::Failure(failure)) => Err(failure),
        Err(Fault::Damaged) => replace(folder, &file).map(|(it, sentence)| (it, Some(sentence))),
    }
}

/// The file in `folder` to read, if it exists.
pub(super) fn open_to_read(folder: &Path) -> Result<Option<Connection>, StoreFailure> {
    let file = folder.join(FILE);
    if !file.exists() {
        return Ok(None);
    }
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let connection = Connection::open_with_flags(&file, flags).and_then(|connection| {
        connection.busy_timeout(PATIENCE)?;
        Ok((schema::version(&connection)?, connection))
    });
    let unreadable =
        |error| StoreFailure::new(format!("{} can't be read: {error}", printable_path(&file)));
    let (version, connection) = connection.map_err(unreadable)?;
    if version == 0 {
        return Ok(None);
    }
    check_origin(&connection, &file).map_err(|fault| fault.or_damage_of(&file))?;
    if version < MIGRATIONS.len() {
        return Err(StoreFailure::new(format!(
            "{} has the older version {version}: start the host once, which renews it",
            printable_path(&file)
        )));
    }
    Ok(Some(connection))
}

/// Why a file is not opened.
enum Fault {
    Damaged,
    Failure(StoreFailure),
}

impl Fault {
    fn or_damage_of(self, file: &Path) -> StoreFailure {
        match self {
            Self::Damaged => StoreFailure::new(format!("{} is damaged", printable_path(file))),
            Self::Failure(failure) => failure,
        }
    }
}

impl From<rusqlite::Error> for Fault {
    fn from(error: rusqlite::Error) -> Self {
        match error.sqlite_error_code() {
            Some(ErrorCode::DatabaseCorrupt | ErrorCode::NotADatabase) => Self::Damaged,
            _ => Self::Failure(error.into()),
        }
    }
}

/// A connection to a file that is sound and of the newest version.
fn connect(file: &Path) -> Result<Connection, Fault> {
    // Without SQLITE_OPEN_URI: a path is a path.
    let flags = OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let mut connection = Connection::open_with_flags(file, flags)?;
    connection.busy_timeout(PATIENCE)?;
    check_origin(&connection, file)?;
    check_content(&connection)?;
    let mode: String = connection.query_row("PRAGMA journal_mode = WAL", [], |row| row.get(0))?;
    if !mode.eq_ignore_ascii_case("wal") {
        let sentence = format!("{} can't have a write-ahead log here", printable_path(file));
        return Err(Fault::Failure(StoreFailure::new(sentence)));
    }
    connection.execute_batch(
        "PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON; PRAGMA trusted_schema = OFF;",
    )?;
    schema::migrate(&mut connection, MIGRATIONS)?;
    Ok(connection)
}

/// Refuses a file of another program or of a newer version.
fn check_origin(connection: &Connection, file: &Path) -> Result<(), Fault> {
    let application: i32 = connection.query_row("PRAGMA application_id", [], |row| row.get(0))?;
    let objects: i64 =
        connection.query_row("SELECT count(*) FROM sqlite_schema", [], |row| row.get(0))?;
    let version = schema::version(connection)?;
    let is_new = application == 0 && version == 0 && objects == 0;
    let sentence = if application != APPLICATION && !is_new {
        format!("{} belongs to another program: it is left as it is", printable_path(file))
    } else if version > MIGRATIONS.len() {
        format!(
            "{} has version {version}, which a newer Cellcaster wrote: it is left as it is",
            printable_path(file)
        )
    } else {
        return Ok(());
    };
    Err(Fault::Failure(StoreFailure::new(sentence)))
}

fn check_content(connection: &Connection) -> Result<(), Fault> {
    let answer: String = connection.query_row("PRAGMA integrity_check(1)", [], |row| row.get(0))?;
    if answer == "ok" { Ok(()) } else { Err(Fault::Damaged) }
}

/// Puts a damaged file aside, and copies what can be read into a new one. Returns that, and a sentence.
fn replace(folder: &Path, file: &Path) -> Result<(Connection, String), StoreFailure> {
    let aside = put_aside(folder, file).and_then(|aside| {
        private::create_file(file)?;
        Ok(aside)
    });
    let aside = aside.map_err(|error| {
        let file = printable_path(file);
        StoreFailure::new(format!("{file} is damaged, and can't be put aside: {error}"))
    })?;
    let mut connection = connect(file).map_err(|fault| fault.or_damage_of(file))?;
    let rows = salvage(&folder.join(&aside), &mut connection)?;
    let file = printable_path(file);
    let sentence = format!(
        "{file} was damaged and is kept as {aside}; {rows} rows of it could be read and stay in force"
    );
    Ok((connection, sentence))
}

/// Renames a damaged file and its logs, and returns the new name.
fn put_aside(folder: &Path, file: &Path) -> io::Result<String> {
    let mut free = (1_u32..).map(|number| format!("{FILE}.damaged-{number}"));
    let name = free.find(|name| !folder.join(name).exists()).unwrap_or_default();
    for end in LOGS.into_iter().chain([""]) {
        match fs::rename(with_end(file, end), with_end(&folder.join(&name), end)) {
            Err(error) if error.kind() == io::ErrorKind::NotFound && !end.is_empty() => {}
            result => result?,
        }
    }
    Ok(name)
}

fn with_end(file: &Path, end: &str) -> PathBuf {
    let mut name = file.as_os_str().to_owned();
    name.push(end);
    name.into()
}
