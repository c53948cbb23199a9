//! The file operations of the store, behind a trait, so that tests can let each of them fail.

use std::ffi::OsString;
use std::fmt;
use std::fs::{self, File, TryLockError};
use std::io::{self, Write};
use std::path::Path;
use std::thread;
use std::time::Duration;

use super::private;

/// File operations.
pub trait Disk: fmt::Debug + Send {
    /// Creates a folder and those that it is in, unless it exists.
    fn create_folder(&self, folder: &Path) -> io::Result<()>;

    /// The content of a file.
    ///
    /// # Errors
    /// [`io::ErrorKind::FileTooLarge`] if it has more than `most` bytes.
    fn read(&self, file: &Path, most: u64) -> io::Result<Vec<u8>>;

    /// Writes a file and waits until it is on the disk.
    fn write(&self, file: &Path, content: &[u8]) -> io::Result<()>;

    /// Renames a file, in place of another one, and waits until that is on the disk.
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()>;

    /// Removes a file.
    fn remove(&self, file: &Path) -> io::Result<()>;

    /// The names in a folder.
    fn names(&self, folder: &Path) -> io::Result<Vec<OsString>>;

    /// Locks a file until the returned one is closed; `None` if the file system has no locks.
    ///
    /// # Errors
    /// [`io::ErrorKind::WouldBlock`] if another process still has it after `attempts`.
    fn lock(&self, file: &Path, attempts: u32) -> io::Result<Option<File>>;
}

/// The operating system's files.
#[derive(Clone, Copy, Debug)]
pub struct Real;

/// The time between two attempts to lock a file.
const PAUSE: Duration = Duration::from_millis(2);

impl Disk for Real {
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
        // Not every system can synchronise a folder. The file is complete under one of the names.
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
                Err(TryLockError::WouldBlock) => thread::sleep(PAUSE),
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
