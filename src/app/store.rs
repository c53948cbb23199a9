//! The store: the data that a player keeps from one game to the next.
//!
//! It is a folder with these files:
//!
//! | file | holds |
//! |---|---|
//! | `progress.toml` | best results, the saved games, preferences, keys, daily runs |
//! | `runs/LEVEL.DIFFICULTY.STEPS.script` | the fastest run of a level |
//! | `runs/saved.HASH.script` | the steps of a saved game; there are at most [`MAX_SAVES`] |
//! | `runs/daily.DATE.REACHED.script` | the daily run of a date, up to the last exit it reached |
//! | `runs/descent.REACHED.script` | the best endless descent, up to the last exit it reached |
//! | `progress.lock` | nothing; a game locks it while it writes |
//!
//! Rules:
//!
//! - **A change is applied to the file, not to a copy of it.** A game takes the lock, reads the
//!   file again, applies its own changes, and replaces the file. Two games therefore never
//!   overwrite each other's changes.
//! - **A file is replaced atomically.** It is written under another name, synchronised and renamed.
//!   A script is written before the file that names it, under an unused name. A power cut therefore
//!   leaves the state before a change or the state after it.
//! - **A damaged file is kept.** It is renamed to `progress.toml.damaged-1`, everything readable in
//!   it stays in force, and a sentence says so. The three newest damaged files stay. A file from a
//!   newer version is not touched.
//! - **Only the owner can read it.** The permissions of its folders and files exclude everybody
//!   else. The store opens only regular files, never a named pipe, for example.
//! - **A failure does not stop the game.** Changes that cannot be written stay in memory and are
//!   tried again with the next change. [`Store::trouble`] returns one sentence about them.
//!
//! Rejected: a database. It would be the largest dependency of the program, for a hundred lines of
//! text that the player can read and copy. Also rejected: one file that stays locked while the game
//! runs. A second game could then save nothing.

pub mod home;
pub mod private;
mod progress;
mod text;

use std::collections::BTreeMap;
use std::path::Path;

use home::{Home, MAX_SCRIPT_FILE_BYTES};
pub use progress::{
    Best, Descent, DescentRun, Improved, MAX_SAVES, NotSaved, Reached, Run, Save, SaveId,
    SavedGame, map_key, name_in_map_key, replayed,
};
use progress::{Change, Progress};

use crate::app::controls::OwnKeys;
pub use crate::app::setting::{Preferences, ViewAngle};
use crate::terminal::Key;
use crate::world::Difficulty;

/// One player's store, in a folder or in memory.
///
/// ```
/// use cellcaster::app::store::{Preferences, Store};
///
/// let mut store = Store::in_memory();
/// store.set_preferences(Preferences { compass: true, ..store.preferences() });
/// assert!(store.preferences().compass);
/// assert_eq!(store.trouble(), None);
/// ```
#[derive(Debug, Default)]
pub struct Store {
    /// The state that the player sees: the last content read from the file, with all changes
    /// applied.
    progress: Progress,
    /// The changes that are not yet in the file.
    pending: Vec<Change>,
    home: Option<Home>,
    /// A sentence about a file that was found damaged during the game.
    damage: Option<String>,
    /// A sentence about the reason why changes are still pending.
    trouble: Option<String>,
}

impl Store {
    /// Opens the store in `folder`. The folder is created with the first change. Also returns a
    /// sentence if something in it is damaged or unusable.
    pub fn open(folder: &Path) -> (Self, Option<String>) {
        Self::at(Home::new(folder.to_owned(), Box::new(home::SystemFiles)))
    }

    fn at(mut home: Home) -> (Self, Option<String>) {
        let (progress, sentence) = home.open();
        (Self { progress, home: Some(home), ..Self::in_memory() }, sentence)
    }

    /// A store that is lost when the program ends.
    pub fn in_memory() -> Self {
        Self::default()
    }

    /// The best results in a level. `level` is the name of a built-in level, or the [key](map_key)
    /// of a map.
    pub fn best(&self, level: &str, difficulty: Difficulty) -> Option<&Best> {
        self.progress.best(level, difficulty)
    }

    /// The script of the fastest run of a level, if there is one and it is readable.
    pub fn script(&self, level: &str, difficulty: Difficulty) -> Option<String> {
        self.text_in(|progress| {
            let best = progress.best(level, difficulty)?;
            Some(progress::of_run(level, difficulty, best.tally.steps))
        })
    }

    /// Records a run that reached the exit, and returns the improvements.
    pub fn record(&mut self, level: &str, difficulty: Difficulty, run: Run) -> Improved {
        let of_run = Best::of(&run);
        let best = self.best(level, difficulty).map(|&known| (known, known.and(of_run)));
        let improved = Improved {
            time: best.is_none_or(|(known, best)| best.tally != known.tally),
            rank: best.is_none_or(|(known, best)| best.rank != known.rank),
        };
        if improved.time || improved.rank {
            self.change(Change::Won { level: level.to_owned(), difficulty, run });
        }
        improved
    }

    /// The levels won at a difficulty, ordered by name.
    pub fn won(&self, difficulty: Difficulty) -> impl Iterator<Item = &str> {
        let levels = self.progress.bests.keys().filter(move |(_, at)| *at == difficulty);
        levels.map(|(level, _)| level.as_str())
    }

    /// The saved games, newest first.
    pub fn saves(&self) -> impl Iterator<Item = &Save> {
        self.progress.saves.iter().rev().map(|entry| &entry.save)
    }

    /// Returns true if there is a saved game `id`.
    pub fn has_saved(&self, id: SaveId) -> bool {
        self.progress.saved(id).is_some()
    }

    /// The saved game `id`, if there is one and its script is readable.
    pub fn saved(&self, id: SaveId) -> Option<SavedGame> {
        let script = self.text_in(|progress| Some(progress.saved(id)?.script.clone()))?;
        Some(SavedGame { save: self.progress.saved(id)?.save.clone(), script })
    }

    /// Returns true if a game with this identity can be saved: there is room for it, or it replaces
    /// one with the same identity.
    pub fn has_room_for(&self, id: SaveId) -> bool {
        self.progress.saves.len() < MAX_SAVES || self.has_saved(id)
    }

    /// Saves a game. It replaces the saved game with the same identity, if there is one.
    ///
    /// # Errors
    /// If there is no room for another game, or if the script is too long to be read again.
    pub fn save(&mut self, game: &SavedGame) -> Result<(), NotSaved> {
        if !self.has_room_for(game.save.id()) {
            return Err(NotSaved::Full);
        }
        if game.script.len() as u64 > MAX_SCRIPT_FILE_BYTES {
            return Err(NotSaved::TooLong);
        }
        self.change(Change::Saved(game.clone()));
        Ok(())
    }

    /// Removes the saved game `id`, if there is one.
    pub fn remove_saved(&mut self, id: SaveId) {
        if self.has_saved(id) {
            self.change(Change::Removed(id));
        }
    }

    /// The player's preferences.
    pub fn preferences(&self) -> Preferences {
        self.progress.preferences
    }

    /// Sets the preferences. Preferences that do not change here keep the choice that another game
    /// may have made.
    pub fn set_preferences(&mut self, preferences: Preferences) {
        let before = self.progress.preferences;
        if before != preferences {
            self.change(Change::Preferences { before, after: preferences });
        }
    }

    /// The keys that the player has chosen, by the name of the action.
    pub(crate) fn keys(&self) -> &OwnKeys {
        &self.progress.keys
    }

    /// Sets the keys that the player has chosen. Actions that do not change here keep the choice that
    /// another game may have made.
    pub(crate) fn set_keys(&mut self, keys: OwnKeys) {
        let before = &self.progress.keys;
        let removed = before.keys().filter(|&name| !keys.contains_key(name));
        let mut changed: BTreeMap<_, _> = removed.map(|&name| (name, None)).collect();
        let is_new = |(name, keys): &(&'static str, Vec<Key>)| before.get(name) != Some(keys);
        changed.extend(keys.into_iter().filter(is_new).map(|(name, keys)| (name, Some(keys))));
        if !changed.is_empty() {
            self.change(Change::Keys(changed));
        }
    }

    /// The result of the daily run of a date, such as 20261122; `None` if it was not tried.
    pub fn daily(&self, date: u32) -> Option<Reached> {
        self.progress.dailies.get(&date).copied()
    }

    /// Begins the daily run of a date, and returns whether the try counts. Only the first try
    /// counts. It counts from its beginning, so leaving does not undo it.
    pub fn begin_daily(&mut self, date: u32) -> bool {
        if self.daily(date).is_some() {
            return false;
        }
        let (reached, script) = (Reached::default(), String::new());
        let before = self.change(Change::Daily { date, reached, script });
        before.is_none_or(|before| !before.dailies.contains_key(&date))
    }

    /// Records the latest result of the try that counts, and its script up to there.
    pub fn record_daily(&mut self, date: u32, reached: Reached, script: String) {
        if self.daily(date).is_none_or(|known| known < reached) {
            self.change(Change::Daily { date, reached, script });
        }
    }

    /// The result of the best endless descent.
    pub fn best_descent(&self) -> Option<Reached> {
        self.progress.descent
    }

    /// Records an endless descent and its script, if it is the best one.
    pub fn record_descent(&mut self, reached: Reached, script: String) {
        if self.progress.descent.is_none_or(|best| best < reached) {
            self.change(Change::Descent { reached, script });
        }
    }

    /// A sentence about damaged or unsaved data, to show at the end of the game.
    pub fn trouble(&self) -> Option<&str> {
        self.trouble.as_deref().or(self.damage.as_deref())
    }

    /// Applies `change` to the state that the player sees and to the file. Returns the previous
    /// state of the file, if the file could be changed.
    fn change(&mut self, change: Change) -> Option<Progress> {
        self.progress.apply(&change);
        self.pending.push(change);
        match self.home.as_mut()?.write(&self.pending, &self.progress) {
            Ok(written) => {
                self.progress = written.progress;
                self.pending.clear();
                self.damage = written.sentence.or(self.damage.take());
                self.trouble = None;
                Some(written.before)
            }
            Err(sentence) => {
                self.trouble = Some(sentence);
                None
            }
        }
    }

    /// The text of the script that `name` selects in the progress, whether it is in a file or still
    /// pending.
    fn text_in(&self, name: impl Fn(&Progress) -> Option<String>) -> Option<String> {
        let wanted = name(&self.progress)?;
        let unwritten = self.pending.iter().rev().find_map(|change| change.script(&wanted));
        if let Some(text) = unwritten {
            return Some(text.to_owned());
        }
        let home = self.home.as_ref()?;
        // Another game may have replaced the script.
        home.script(&wanted).or_else(|| home.script(&name(&home.read_again()?)?))
    }
}

#[cfg(test)]
mod tests;
