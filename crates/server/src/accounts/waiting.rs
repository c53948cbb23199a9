//! Results that wait while the store is unavailable or full, in the file `waiting_results` of the host's data
//! folder.
//!
//! Rules:
//!
//! - **A result is on the disk when [`save`](WaitingResults::save) has succeeded.** It stays in the file until the
//!   first `save` after it was recorded. If a host is killed in between, it records the result twice, which
//!   changes nothing. If the disk is full, results wait in memory until there is room.
//! - **The key identifies an account**, because the number of an account is valid in one database only.
//! - **A script is replayed again before it is recorded.** So nothing has to trust the file, and a newer version
//!   of the rules decides by itself.
//! - **File and memory are bounded.** The file is replaced atomically. If a part of it cannot be read, the old
//!   file is put aside.
//! - **No result waits forever:** if the store answers but refuses a result, the result is given up after
//!   [`MAX_AGE`].
//!
//! Rejected: a queue only in memory. A database is often restarted together with its hosts.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{
    Account, AccountKey, HostStore, StoreFailure, UnixTime, Unverified, VerifiedRun, verify_at,
};
use cellcaster::app::store::home::{Disk, SystemFiles};
use cellcaster::app::store::private;
use cellcaster::fault::printable_path;
use cellcaster::world::World;

/// The most results that wait.
const MAX_RESULTS: usize = 1000;
/// The most bytes of the file. One result takes about ten thousand.
const MAX_BYTES: usize = 16 << 20;
/// The seconds after which a refused result is given up.
const MAX_AGE: u64 = 7 * 24 * 60 * 60;

/// The waiting results, in the order in which they were added.
#[derive(Debug)]
pub struct WaitingResults {
    file: PathBuf,
    results: Vec<WaitingResult>,
    /// `true` if the file contains the same results.
    is_saved: bool,
}

/// A waiting result: a line of the file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WaitingResult {
    /// The key of the account.
    #[serde(rename = "account")]
    pub key: AccountKey,
    /// When the run was verified.
    pub at: UnixTime,
    /// Its script.
    pub script: String,
}

/// The outcome for a result that has waited.
#[derive(Debug)]
pub enum LateOutcome {
    /// It was recorded, and no longer waits.
    Recorded(Account, VerifiedRun),
    /// Its script is not a run that counts in this version. It no longer waits.
    Refuted(WaitingResult, Unverified),
    /// The store refused it for too long, and it is given up.
    GivenUp(WaitingResult, StoreFailure),
    /// The store refused it, and it still waits.
    Refused(StoreFailure),
    /// The store is unavailable or full. All results still wait.
    NotNow,
}

impl WaitingResults {
    /// Reads the results that wait in a folder. Also returns a sentence if some of them cannot be read.
    ///
    /// # Errors
    /// If the file can't be read or replaced.
    pub fn open(folder: &Path) -> Result<(Self, Option<String>), StoreFailure> {
        let file = folder.join("waiting_results");
        // A host never writes more than this.
        let bytes = match private::read(&file, 2 * MAX_BYTES as u64) {
            Err(error) if error.kind() == ErrorKind::NotFound => Vec::new(),
            read => read.map_err(|error| failure(&file, &error))?,
        };
        let text = String::from_utf8_lossy(&bytes);
        let read: Vec<_> = text.lines().map(serde_json::from_str).collect();
        let is_damaged = read.iter().any(Result::is_err);
        let results: Vec<WaitingResult> = read.into_iter().flatten().collect();
        let mut waiting = Self { file, results, is_saved: true };
        let sentence = is_damaged.then(|| waiting.put_aside()).transpose()?;
        Ok((waiting, sentence))
    }

    /// The number of results.
    pub fn len(&self) -> usize {
        self.results.len()
    }

    /// Returns true if no result waits.
    pub fn is_empty(&self) -> bool {
        self.results.is_empty()
    }

    /// Adds a result. The next [`save`](Self::save) puts it on the disk.
    ///
    /// # Errors
    /// If too many wait.
    pub fn add(&mut self, result: WaitingResult) -> Result<(), StoreFailure> {
        let bytes = self.content().len() + result.line().len();
        if self.results.len() >= MAX_RESULTS || bytes > MAX_BYTES {
            return Err(StoreFailure::new("too many results are waiting for the store"));
        }
        self.results.push(result);
        self.is_saved = false;
        Ok(())
    }

    /// Records result number `index` with its own time, if there is one. Call [`save`](Self::save) after the last
    /// one.
    pub fn record(
        &mut self,
        index: usize,
        store: &mut HostStore,
        world: impl FnOnce(&str) -> Option<World>,
        now: UnixTime,
    ) -> Option<LateOutcome> {
        let result = self.results.get(index)?;
        let late = result.record(store, world, now);
        if !matches!(late, LateOutcome::Refused(_) | LateOutcome::NotNow) {
            self.results.remove(index);
            self.is_saved = false;
        }
        Some(late)
    }

    /// Updates the file to the results that still wait.
    ///
    /// # Errors
    /// If it can't be written.
    pub fn save(&mut self) -> Result<(), StoreFailure> {
        if !self.is_saved {
            self.replace().map_err(|error| failure(&self.file, &error))?;
            self.is_saved = true;
        }
        Ok(())
    }

    fn replace(&self) -> io::Result<()> {
        if self.results.is_empty() {
            return match SystemFiles.remove(&self.file) {
                Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
                _ => Ok(()),
            };
        }
        replace(&self.file, self.content().as_bytes())
    }

    /// The text of the file.
    fn content(&self) -> String {
        self.results.iter().map(WaitingResult::line).collect()
    }

    /// Puts aside a file that cannot be read completely, and returns a sentence about it.
    fn put_aside(&mut self) -> Result<String, StoreFailure> {
        let aside = self.file.with_extension("damaged");
        SystemFiles.rename(&self.file, &aside).map_err(|error| failure(&self.file, &error))?;
        self.is_saved = false;
        self.save()?;
        let (file, aside) = (printable_path(&self.file), printable_path(&aside));
        Ok(format!("part of {file} can't be read; the complete file is now {aside}"))
    }
}

impl WaitingResult {
    fn record(
        &self,
        store: &mut HostStore,
        world: impl FnOnce(&str) -> Option<World>,
        now: UnixTime,
    ) -> LateOutcome {
        // A replay takes long, so the store is asked first.
        let account = match store.account(&self.key) {
            Ok(Some(account)) => account,
            Ok(None) => return self.refused(StoreFailure::new("the account does not exist"), now),
            Err(failure) => return self.refused(failure, now),
        };
        let run = match verify_at(&self.script, self.at, world) {
            Ok(run) => run,
            Err(reason) => return LateOutcome::Refuted(self.clone(), reason),
        };
        match store.record(account.id, &run, self.at) {
            Ok(_) => LateOutcome::Recorded(account, run),
            Err(failure) => self.refused(failure, now),
        }
    }

    fn refused(&self, failure: StoreFailure, now: UnixTime) -> LateOutcome {
        if failure.is_of_now() {
            LateOutcome::NotNow
        } else if self.at.after(MAX_AGE) < now {
            LateOutcome::GivenUp(self.clone(), failure)
        } else {
            LateOutcome::Refused(failure)
        }
    }

    fn line(&self) -> String {
        // Texts and a number always have a form in JSON.
        serde_json::to_string(self).unwrap_or_default() + "\n"
    }
}

/// Replaces a file, which only its owner can read. The file is complete or unchanged.
pub(crate) fn replace(file: &Path, content: &[u8]) -> io::Result<()> {
    let new = file.with_extension("new");
    let written = private::create_file(&new)
        .and_then(|()| SystemFiles.write(&new, content))
        .and_then(|()| SystemFiles.rename(&new, file));
    // A partial file would take up room on a full disk.
    written.inspect_err(|_| _ = SystemFiles.remove(&new))
}

pub(crate) fn failure(file: &Path, error: &io::Error) -> StoreFailure {
    StoreFailure::new(format!("{} can't be used: {error}", printable_path(file)))
}
