//! Opening the file: where it lies, who may read it, and whether it is sound.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

use rusqlite::{Connection, ErrorCode, OpenFlags};

use super::salvage::salvage;
use super::schema::{self, APPLICATION, MIGRATIONS};
use crate::accounts::StoreFailure;
use cellcaster::app::store::private;
use cellcaster::fault::printable_path;

const FILE: &str = "host.db";
/// What SQLite adds to the name for its log, and for the index of the log.
const LOGS: [&str; 2] = ["-wal", "-shm"];
/// The time to wait for another process.
const PATIENCE: Duration = Duration::from_secs(5);

/// The file in `folder` to read and write. A damaged one is refused, and left as it is.
pub(crate) fn open(folder: &Path) -> Result<Connection, StoreFailure> {
    open_sound(folder).map_err(|fault| match fault {
        Fault::Failure(failure) => failure,
        Fault::Damaged => StoreFailure::new(format!(
            "{} is damaged: put a backup in its place, or start once with --accept-empty, which keeps it as \
             {} and goes on with the rows that can be read",
            printable_path(&folder.join(FILE)),
            free_name(folder)
        )),
    })
}

/// The same, but a damaged file is put aside, and the rows that can be read are copied into a new one. Then a
/// sentence says so.
pub(crate) fn open_or_salvage(folder: &Path) -> Result<(Connection, Option<String>), StoreFailure> {
    match open_sound(folder) {
        Ok(connection) => Ok((connection, None)),
        Err(Fault::Failure(failure)) => Err(failure),
        Err(Fault::Damaged) => replace(folder).map(|(it, sentence)| (it, Some(sentence))),
    }
}

/// The file in `folder`, which is made if there is none.
fn open_sound(folder: &Path) -> Result<Connection, Fault> {
    let file = folder.join(FILE);
    if has_lost_its_content(&file) {
        return Err(Fault::Damaged);
    }
    let is_new = !file.exists();
    private::create_folder(folder).and_then(|()| private::create_file(&file)).map_err(|error| {
        let sentence = format!("{} can't be used: {error}", printable_path(&file));
        Fault::Failure(StoreFailure::new(sentence))
    })?;
    connect(&file).inspect_err(|_| {
        // An empty file would be taken for a damaged one at the next start.
        if is_new && fs::metadata(&file).is_ok_and(|data| data.len() == 0) {
            _ = fs::remove_file(&file);
        }
    })
}

/// Whether the file is empty, or missing beside its log. SQLite would take either for a new database, and
/// delete the log.
fn has_lost_its_content(file: &Path) -> bool {
    match fs::metadata(file) {
        Ok(data) => data.is_file() && data.len() == 0,
        Err(_) => fs::metadata(with_end(file, LOGS[0])).is_ok_and(|log| log.len() > 0),
    }
}

/// Copies the content of the write-ahead log into the file, and empties the log. What another process still
/// reads remains in the log.
pub(crate) fn checkpoint(connection: &Connection) -> rusqlite::Result<()> {
    connection.query_row("PRAGMA wal_checkpoint(TRUNCATE)", [], |_| Ok(()))
}

/// The file in `folder` to read, if it exists.
pub(crate) fn open_to_read(folder: &Path) -> Result<Option<Connection>, StoreFailure> {
    let file = folder.join(FILE);
    if !file.exists() {
        return Ok(None);
    }
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    // Not by opening it: to close it again would give up the locks of this process.
    private::check_is_file(&file).map_err(|error| {
        StoreFailure::new(format!("{} can't be read: {error}", printable_path(&file)))
    })?;
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
    if version < schema::newest() {
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
    // What can't be copied now, as on a full disk, is as safe in the log.
    _ = checkpoint(&connection);
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
    } else if version < 0 {
        format!(
            "{} has version {version}, which no Cellcaster wrote: it is left as it is; move it away",
            printable_path(file)
        )
    } else if version > schema::newest() {
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
fn replace(folder: &Path) -> Result<(Connection, String), StoreFailure> {
    let file = folder.join(FILE);
    let aside = put_aside(folder, &file).and_then(|aside| {
        private::create_file(&file)?;
        Ok(aside)
    });
    let aside = aside.map_err(|error| {
        let file = printable_path(&file);
        StoreFailure::new(format!("{file} is damaged, and can't be put aside: {error}"))
    })?;
    let mut connection = connect(&file).map_err(|fault| fault.or_damage_of(&file))?;
    let damaged = folder.join(&aside);
    let is_lost = has_lost_its_content(&damaged);
    let rows = if is_lost { 0 } else { salvage(&damaged, &mut connection)? };
    let file = printable_path(&file);
    let sentence = format!(
        "{file} was damaged and is kept as {aside}; {rows} rows of it could be read and stay in force"
    );
    Ok((connection, sentence))
}

/// Renames a damaged file and its logs, and returns the new name.
fn put_aside(folder: &Path, file: &Path) -> io::Result<String> {
    let name = free_name(folder);
    for end in LOGS.into_iter().chain([""]) {
        match fs::rename(with_end(file, end), with_end(&folder.join(&name), end)) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            result => result?,
        }
    }
    Ok(name)
}

/// The name that a damaged file gets.
fn free_name(folder: &Path) -> String {
    let is_free = |name: &String| {
        let file = folder.join(name);
        LOGS.into_iter().chain([""]).all(|end| !with_end(&file, end).exists())
    };
    let mut names = (1_u32..).map(|number| format!("{FILE}.damaged-{number}"));
    names.find(is_free).unwrap_or_default()
}

fn with_end(file: &Path, end: &str) -> PathBuf {
    let mut name = file.as_os_str().to_owned();
    name.push(end);
    name.into()
}
