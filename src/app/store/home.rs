//! The store's folder: reading files, and replacing them under a lock.
//!
//! File operations go through a trait, so tests can make each of them fail.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;
use std::{fmt, thread};

use crate::app::store::private;
use crate::app::store::progress::{Change, Progress};
use crate::app::store::text;
use crate::fault::printable_path;
use crate::sort;

/// The folder of a store.
#[derive(Debug)]
pub(crate) struct Home {
    folder: PathBuf,
    disk: Box<dyn Disk>,
    /// The number of attempts to take the lock. It is one after another process has failed to
    /// release the lock in time.
    attempts: u32,
}

/// The result of a change.
#[derive(Debug)]
pub(crate) struct ChangeResult {
    /// The state of the file before the change.
    pub(crate) before: Progress,
    /// The state of the file after the change.
    pub(crate) progress: Progress,
    /// A sentence about a damaged file, if the file was damaged.
    pub(crate) sentence: Option<String>,
}

/// The readable part of the progress file, and the damage to the rest.
#[derive(Default)]
struct Found {
    progress: Progress,
    damage: Option<Damage>,
}

enum Damage {
    /// Parts are unreadable. Contains the bytes of the file.
    Parts(Vec<u8>),
    /// The file is too large to be read at all.
    TooLarge,
}

const PROGRESS: &str = "progress.toml";
const LOCK: &str = "progress.lock";
const RUNS: &str = "runs";
/// The size limit of the progress file, in bytes.
const MAX_PROGRESS_BYTES: u64 = 4 << 20;
/// The size limit of a script, in bytes: more than a day of play.
pub(crate) const MAX_SCRIPT_FILE_BYTES: u64 = 4 << 20;
/// The number of damaged files that are kept. The newest stay.
const MAX_DAMAGED: usize = 3;
/// All attempts together take two seconds.
const ATTEMPTS: u32 = 1000;

impl Home {
    pub(crate) fn new(folder: PathBuf, disk: Box<dyn Disk>) -> Self {
        Self { folder, disk, attempts: ATTEMPTS }
    }

    /// Reads the progress from the file. Also returns a sentence if the file is damaged or
    /// unusable. A damaged file is renamed.
    pub(crate) fn open(&mut self) -> (Progress, Option<String>) {
        let readable = match self.find() {
            Ok(Found { progress, damage: None }) => return (progress, None),
            Ok(Found { progress, .. }) => progress,
            Err(sentence) => return (Progress::default(), Some(sentence)),
        };
        match self.write(&[], &readable) {
            Ok(written) => (written.progress, written.sentence),
            Err(sentence) => (readable, Some(sentence)),
        }
    }

    /// The progress in the file; `None` if the file is damaged or unreadable.
    pub(crate) fn read_again(&self) -> Option<Progress> {
        self.find().ok().filter(|found| found.damage.is_none()).map(|found| found.progress)
    }

    /// The text of the script in the file `name`; `None` if it is unreadable.
    pub(crate) fn script(&self, name: &str) -> Option<String> {
        let content =
            self.disk.read(&self.folder.join(RUNS).join(name), MAX_SCRIPT_FILE_BYTES).ok()?;
        String::from_utf8(content).ok()
    }

    /// Applies `changes` to the file. If the file is damaged, it is completed from `known`, the
    /// state in memory.
    ///
    /// # Errors
    /// A sentence that says why nothing was written.
    pub(crate) fn write(
        &mut self,
        changes: &[Change],
        known: &Progress,
    ) -> Result<ChangeResult, String> {
        let not_kept = |folder: &Path, error: &io::Error| {
            format!("{} can't be written: {error}; this game is not saved", printable_path(folder))
        };
        let lock = self
            .disk
            .create_folder(&self.folder.join(RUNS))
            .and_then(|()| self.disk.lock(&self.folder.join(LOCK), self.attempts));
        self.attempts = if lock.is_ok() { ATTEMPTS } else { 1 };
        let _lock = lock.map_err(|error| not_kept(&self.folder, &error))?;
        let found = self.find()?;
        self.replace(found, changes, known).map_err(|error| not_kept(&self.folder, &error))
    }

    fn find(&self) -> Result<Found, String> {
        let file = self.folder.join(PROGRESS);
        let content = match self.disk.read(&file, MAX_PROGRESS_BYTES) {
            Ok(content) => content,
            Err(error) => {
                let damage = match error.kind() {
                    io::ErrorKind::NotFound => None,
                    io::ErrorKind::FileTooLarge => Some(Damage::TooLarge),
                    _ => {
                        let file = printable_path(&file);
                        return Err(format!("{file} can't be read: {error}; nothing is saved"));
                    }
                };
                return Ok(Found { damage, ..Found::default() });
            }
        };
        match text::read(&content) {
            Ok((progress, is_sound)) => {
                Ok(Found { progress, damage: (!is_sound).then_some(Damage::Parts(content)) })
            }
            Err(version) => Err(format!(
                "{} was written by a newer Cellcaster (version {version}): it is left unchanged, \
                 and nothing is saved",
                printable_path(&file)
            )),
        }
    }

    fn replace(
        &self,
        found: Found,
        changes: &[Change],
        known: &Progress,
    ) -> io::Result<ChangeResult> {
        let Found { mut progress, damage } = found;
        let sentence = damage.map(|damage| self.put_aside(damage)).transpose()?;
        if sentence.is_some() {
            progress.complete(known);
        }
        let before = progress.clone();
        for change in changes {
            progress.apply(change);
        }
        let after: BTreeSet<String> = sort::gathered(progress.scripts());
        let scripts = changes.iter().filter_map(Change::written);
        for (name, text) in scripts.filter(|(name, _)| after.contains(name)) {
            self.write_whole(&Path::new(RUNS).join(name), text.as_bytes())?;
        }
        self.write_whole(Path::new(PROGRESS), progress.to_string().as_bytes())?;
        for name in before.scripts().filter(|name| !after.contains(name)) {
            // The progress is already written, and a leftover script does no harm.
            _ = self.disk.remove(&self.folder.join(RUNS).join(name));
        }
        Ok(ChangeResult { before, progress, sentence })
    }

    /// Keeps the damaged file under another name, and returns a sentence about it.
    fn put_aside(&self, damage: Damage) -> io::Result<String> {
        let names = self.disk.names(&self.folder)?;
        let aside = |number: u64| format!("{PROGRESS}.damaged-{number}");
        let number_of = |name: &OsString| {
            let number = name.to_str()?.rsplit_once('-')?.1.parse().ok()?;
            (*name == *aside(number)).then_some(number)
        };
        let mut numbers: Vec<u64> = names.iter().filter_map(number_of).collect();
        sort::by_key(&mut numbers, |&number| number);
        let number = numbers.last().map_or(1, |last| last.saturating_add(1));
        let name = aside(number);
        let kept = match damage {
            Damage::Parts(content) => {
                self.write_whole(Path::new(&name), &content)?;
                "everything readable in it is still used"
            }
            Damage::TooLarge => {
                self.disk.rename(&self.folder.join(PROGRESS), &self.folder.join(&name))?;
                "it is too large to read"
            }
        };
        numbers.retain(|&known| known != number);
        for &old in numbers.iter().rev().skip(MAX_DAMAGED - 1) {
            // A leftover file does no harm.
            _ = self.disk.remove(&self.folder.join(aside(old)));
        }
        let file = printable_path(&self.folder.join(PROGRESS));
        Ok(format!("{file} was damaged and is kept as {name}; {kept}"))
    }

    /// Writes a file in the folder so that the file has either its old or its new content at all
    /// times.
    fn write_whole(&self, name: &Path, content: &[u8]) -> io::Result<()> {
        let file = self.folder.join(name);
        let mut new = file.clone().into_os_string();
        new.push(".new");
        let written = self.disk.write(Path::new(&new), content);
        let renamed = written.and_then(|()| self.disk.rename(Path::new(&new), &file));
        if renamed.is_err() {
            // On a full disk, the incomplete file would take up the last space.
            _ = self.disk.remove(Path::new(&new));
        }
        renamed
    }
}

/// File operations.
pub trait Disk: fmt::Debug + Send {
    /// Creates a folder and its parents, unless the folder exists.
    fn create_folder(&self, folder: &Path) -> io::Result<()>;

    /// The content of a file.
    ///
    /// # Errors
    /// [`io::ErrorKind::FileTooLarge`] if it has more than `most` bytes.
    fn read(&self, file: &Path, most: u64) -> io::Result<Vec<u8>>;

    /// Writes a file, and waits until the content is on the disk.
    fn write(&self, file: &Path, content: &[u8]) -> io::Result<()>;

    /// Renames a file, replacing any file at the new path, and waits until the change is on the
    /// disk.
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()>;

    /// Removes a file.
    fn remove(&self, file: &Path) -> io::Result<()>;

    /// The names in a folder.
    fn names(&self, folder: &Path) -> io::Result<Vec<OsString>>;

    /// Locks a file until the returned handle is closed. Returns `None` if the file system does not
    /// support locks.
    ///
    /// # Errors
    /// [`io::ErrorKind::WouldBlock`] if another process still holds the lock after `attempts`
    /// attempts.
    fn lock(&self, file: &Path, attempts: u32) -> io::Result<Option<File>>;
}

/// The files of the operating system.
#[derive(Clone, Copy, Debug)]
pub struct SystemFiles;

/// The time between two attempts to lock a file.
const RETRY_INTERVAL: Duration = Duration::from_millis(2);

impl Disk for SystemFiles {
    fn create_folder(&self, folder: &Path) -> io::Result<()> {
        private::create_folder(folder)
    }

    fn read(&self, file: &Path, most: u64) -> io::Result<Vec<u8>> {
        private::read(file, most)
    }

    fn write(&self, file: &Path, content: &[u8]) -> io::Result<()> {
        let mut file = private::open_to_write(file)?;
        file.set_len(0)?;
        file.write_all(content)?;
        file.sync_all()
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        fs::rename(from, to)?;
        // Not every system can synchronise a folder. The file is complete under one of the two
        // names.
        let folder = to.parent().and_then(|folder| File::open(folder).ok());
        folder.map(|folder| folder.sync_all());
        Ok(())
    }

    fn remove(&self, file: &Path) -> io::Result<()> {
        fs::remove_file(file)
    }

    fn names(&self, folder: &Path) -> io::Result<Vec<OsString>> {
        fs::read_dir(folder)?.map(|entry| Ok(entry?.file_name())).collect()
    }

    fn lock(&self, file: &Path, attempts: u32) -> io::Result<Option<File>> {
        let file = private::open_to_write(file)?;
        for _ in 1..attempts {
            match file.try_lock() {
                Err(TryLockError::WouldBlock) => thread::sleep(RETRY_INTERVAL),
                other => return locked(file, other),
            }
        }
        let last = file.try_lock();
        locked(file, last)
    }
}

fn locked(file: File, attempt: Result<(), TryLockError>) -> io::Result<Option<File>> {
    match attempt {
        Ok(()) => Ok(Some(file)),
        Err(TryLockError::WouldBlock) => Err(io::ErrorKind::WouldBlock.into()),
        Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => Ok(None),
        Err(TryLockError::Error(error)) => Err(error),
    }
}
