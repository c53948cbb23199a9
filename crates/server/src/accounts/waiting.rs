//! Results that wait for a store that is away or full, in the file `waiting_results` of the host's data folder.
//!
//! Rules:
//!
//! - **A result is on the disk when [`save`](WaitingResults::save) has succeeded**, and in the file until the next
//!   one after it was recorded. A host that is killed in between records it twice, which changes nothing. On a
//!   full disk, results wait in memory until there is room.
//! - **An account is named by its key**, since the number of an account is that of one database.
//! - **A script is replayed again before it is recorded**, so that the file proves nothing, and so that a newer
//!   version of the rules decides by itself.
//! - **File and memory are bounded.** The file is replaced at once. A part that can't be read is put aside.
//! - **Nothing waits for ever:** a result that the store refuses although it answers is given up after
//!   [`MOST_AGE`].
//!
//! Rejected: a queue in memory alone. A database is often restarted together with its hosts.

use std::borrow::Cow;
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{
    Account, AccountKey, HostStore, StoreFailure, UnixTime, Unverified, VerifiedRun, verify,
};
use cellcaster::app::store::home::{Disk, Real};
use cellcaster::app::store::private;
use cellcaster::fault::printable_path;
use cellcaster::world::World;

/// The most results that wait.
const MOST_RESULTS: usize = 1000;
/// The most bytes of the file. One result is some ten thousand.
const MOST_BYTES: usize = 16 << 20;
/// The seconds after which a result is given up that the store refuses.
const MOST_AGE: u64 = 7 * 24 * 60 * 60;

/// The results that wait, in the order in which they were added.
#[derive(Debug)]
pub struct WaitingResults {
    file: PathBuf,
    results: Vec<WaitingResult>,
    /// Whether the file has the same.
    is_saved: bool,
}

/// A result that waits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WaitingResult {
    /// The key of the account.
    pub key: AccountKey,
    /// When the run was verified.
    pub at: UnixTime,
    /// Its script.
    pub script: String,
}

/// What became of a result that has waited.
#[derive(Debug)]
pub enum Late {
    /// It was recorded, and waits no more.
    Recorded(Account, VerifiedRun),
    /// Its script is no run that counts in this version. It waits no more.
    Refuted(WaitingResult, Unverified),
    /// The store refuses it, and it is given up.
    GivenUp(WaitingResult, StoreFailure),
    /// The store refuses it, and it waits on.
    Refused(StoreFailure),
    /// The store is away or full, and it waits on with all others.
    NotNow,
}

/// A line of the file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Row<'a> {
    account: String,
    at: u64,
    script: Cow<'a, str>,
}

impl WaitingResults {
    /// The results that wait in a folder. Returns also a sentence if some can't be read.
    ///
    /// # Errors
    /// If the file can't be read or replaced.
    pub fn open(folder: &Path) -> Result<(Self, Option<String>), StoreFailure> {
        let file = folder.join("waiting_results");
        let failed = |error| failure(&file, &error);
        let mut bytes = Vec::new();
        match private::open(&file) {
            Ok(found) => {
                // More than this was not written by a host.
                let most = 2 * MOST_BYTES as u64;
                _ = found.take(most).read_to_end(&mut bytes).map_err(failed)?;
            }
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            Err(error) => return Err(failed(error)),
        }
        let text = String::from_utf8_lossy(&bytes);
        let read: Vec<_> = text.lines().map(WaitingResult::parse).collect();
        let is_damaged = read.iter().any(Option::is_none);
        let results: Vec<WaitingResult> = read.into_iter().flatten().collect();
        let mut waiting = Self { file, results, is_saved: true };
        let sentence = is_damaged.then(|| waiting.put_aside()).transpose()?;
        Ok((waiting, sentence))
    }

    /// The number of results.
    pub fn len(&self) -> usize {
        self.results.len()
    }

    /// Whether none waits.
    pub fn is_empty(&self) -> bool {
        self.results.is_empty()
    }

    /// Adds a result, which is on the disk after the next [`save`](Self::save).
    ///
    /// # Errors
    /// If too many wait.
    pub fn add(&mut self, result: WaitingResult) -> Result<(), StoreFailure> {
        let bytes = self.content().len() + result.line().len();
        if self.results.len() >= MOST_RESULTS || bytes > MOST_BYTES {
            return Err(StoreFailure::new("too many results wait for the store"));
        }
        self.results.push(result);
        self.is_saved = false;
        Ok(())
    }

    /// Records result number `index` at the time of its own, if there is one. [`save`](Self::save) is to be
    /// called after the last one.
    pub fn record(
        &mut self,
        index: usize,
        store: &mut HostStore,
        world: impl FnOnce(&str) -> Option<World>,
        now: UnixTime,
    ) -> Option<Late> {
        let result = self.results.get(index)?;
        let late = result.record(store, world, now);
        if !matches!(late, Late::Refused(_) | Late::NotNow) {
            self.results.remove(index);
            self.is_saved = false;
        }
        Some(late)
    }

    /// Makes the file have the results that wait still.
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
            return match Real.remove(&self.file) {
                Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
                _ => Ok(()),
            };
        }
        let new = self.file.with_extension("new");
        let written = private::create_file(&new)
            .and_then(|()| Real.write(&new, self.content().as_bytes()))
            .and_then(|()| Real.rename(&new, &self.file));
        // A part of a file takes room on a full disk.
        written.inspect_err(|_| _ = Real.remove(&new))
    }

    /// The text of the file.
    fn content(&self) -> String {
        self.results.iter().map(WaitingResult::line).collect()
    }

    /// Puts a file aside of which a part can't be read; a sentence about it.
    fn put_aside(&mut self) -> Result<String, StoreFailure> {
        let aside = self.file.with_extension("damaged");
        Real.rename(&self.file, &aside).map_err(|error| failure(&self.file, &error))?;
        self.is_saved = false;
        self.save()?;
        let (file, aside) = (printable_path(&self.file), printable_path(&aside));
        Ok(format!("a part of {file} can't be read; the whole is in {aside}"))
    }
}

impl WaitingResult {
    fn record(
        &self,
        store: &mut HostStore,
        world: impl FnOnce(&str) -> Option<World>,
        now: UnixTime,
    ) -> Late {
        // A replay takes long, so the store is asked first.
        let account = match store.account(&self.key) {
            Ok(Some(account)) => account,
            Ok(None) => return self.refused(StoreFailure::new("there is no such account"), now),
            Err(failure) => return self.refused(failure, now),
        };
        let run = match verify(&self.script, world) {
            Ok(run) => run,
            Err(reason) => return Late::Refuted(self.clone(), reason),
        };
        match store.record(account.id, &run, self.at) {
            Ok(_) => Late::Recorded(account, run),
            Err(failure) => self.refused(failure, now),
        }
    }

    fn refused(&self, failure: StoreFailure, now: UnixTime) -> Late {
        if failure.is_of_now() {
            Late::NotNow
        } else if self.at.after(MOST_AGE) < now {
            Late::GivenUp(self.clone(), failure)
        } else {
            Late::Refused(failure)
        }
    }

    fn line(&self) -> String {
        let (account, script) = (self.key.to_string(), Cow::Borrowed(self.script.as_str()));
        let row = Row { account, at: self.at.seconds(), script };
        // Texts and a number always have a form in JSON.
        serde_json::to_string(&row).unwrap_or_default() + "\n"
    }

    fn parse(line: &str) -> Option<Self> {
        let Row { account, at, script } = serde_json::from_str(line).ok()?;
        let (key, at) = (AccountKey::parse(&account)?, UnixTime::new(at));
        Some(Self { key, at, script: script.into_owned() })
    }
}

fn failure(file: &Path, error: &io::Error) -> StoreFailure {
    StoreFailure::new(format!("{} can't be used: {error}", printable_path(file)))
}
