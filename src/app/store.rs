//! The store: what a player keeps from one game to the next.
//!
//! It is a folder with these files:
//!
//! | file | holds |
//! |---|---|
//! | `progress.toml` | best results, the saved games, preferences, daily runs |
//! | `runs/LEVEL.DIFFICULTY.STEPS.script` | the fastest run of a level |
//! | `runs/saved.HASH.script` | the run of a saved game so far; there are at most [`MOST_SAVES`] |
//! | `runs/daily.DATE.REACHED.script` | the daily run of a date, up to the last exit it reached |
//! | `runs/descent.REACHED.script` | the best descent without an end, up to the same |
//! | `progress.lock` | nothing; it is locked while a game writes |
//!
//! Rules:
//!
//! - **A change is applied to the file, not to a copy of it.** A game takes the lock, reads the file
//!   again, applies its own changes, and replaces the file. So two games lose nothing of each other.
//! - **A file is replaced at once.** It is written under another name, synchronised and renamed. Scripts
//!   are written before the file that names them, under a name that is not in use. So a power cut
//!   leaves the state before or the state after a change.
//! - **A damaged file is kept.** It is renamed to `progress.toml.damaged-1`, everything in it that can be
//!   read is kept in force, and a sentence says so. The newest three such files stay. A file of a newer
//!   version is left alone.
//! - **Nobody else reads it.** Only the owner can read its folders and files. Only regular files are opened, and no
//!   named pipe, for example.
//! - **A failure does not stop the game.** Changes that can't be written stay in memory, are tried
//!   again with the next change, and [`Store::trouble`] is one sentence about them.
//!
//! Rejected: a database. It would be the largest dependency of the program, for a hundred lines of
//! text that the player can read and copy. Also rejected: one file that is
//! locked while the game runs. The second game would keep nothing.

pub mod home;
pub mod private;
mod progress;
mod text;

use std::path::Path;

use home::{Home, LARGEST_SCRIPT};
pub use progress::{
    Best, Descent, DescentRun, Improved, MOST_SAVES, NotSaved, Reached, Run, Save, SaveId,
    SavedGame, map_key, name_in_map_key, replayed,
};
use progress::{Change, Progress};

pub use crate::app::setting::Preferences;
use crate::world::Difficulty;

/// One player's store: a folder, or memory.
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
    /// The state that the player sees: the file as last read, with all changes.
    progress: Progress,
    /// The changes that are not in the file.
    pending: Vec<Change>,
    home: Option<Home>,
    /// About a file that was found damaged during the game.
    damage: Option<String>,
    /// About the pending changes.
    trouble: Option<String>,
}

impl Store {
    /// The store in `folder`, which is created with the first change; and a sentence if something
    /// in it is damaged, or can't be used.
    pub fn open(folder: &Path) -> (Self, Option<String>) {
        Self::at(Home::new(folder.to_owned(), Box::new(home::Real)))
    }

    fn at(mut home: Home) -> (Self, Option<String>) {
        let (progress, sentence) = home.open();
        (Self { progress, home: Some(home), ..Self::in_memory() }, sentence)
    }

    /// A store that ends with the program.
    pub fn in_memory() -> Self {
        Self::default()
    }

    /// The best results in a level. `level` is the name of a built-in level, or the [key](map_key) of
    /// a map.
    pub fn best(&self, level: &str, difficulty: Difficulty) -> Option<&Best> {
        self.progress.best(level, difficulty)
    }

    /// The script of the fastest run of a level, if there is one and it can be read.
    pub fn script(&self, level: &str, difficulty: Difficulty) -> Option<String> {
        self.text_in(|progress| {
            let best = progress.best(level, difficulty)?;
            Some(progress::of_run(level, difficulty, best.tally.steps))
        })
    }

    /// Records a run that reached the exit, and returns what it improved.
    pub fn record(&mut self, level: &str, difficulty: Difficulty, run: Run) -> Improved {
        let best = self.best(level, difficulty);
        let improved = Improved {
            time: best.is_none_or(|best| run.tally.steps < best.tally.steps),
            rank: best.is_none_or(|best| run.rank > best.rank),
        };
        if improved.time || improved.rank {
            self.change(Change::Won { level: level.to_owned(), difficulty, run });
        }
        improved
    }

    /// The levels that were won at a difficulty, in the order of their names.
    pub fn won(&self, difficulty: Difficulty) -> impl Iterator<Item = &str> {
        let levels = self.progress.bests.keys().filter(move |(_, at)| *at == difficulty);
        levels.map(|(level, _)| level.as_str())
    }

    /// The saved games, the newest first.
    pub fn saves(&self) -> impl Iterator<Item = &Save> {
        self.progress.saves.iter().rev().map(|entry| &entry.save)
    }

    /// Whether there is a saved game `id`.
    pub fn has_saved(&self, id: SaveId) -> bool {
        self.progress.saved(id).is_some()
    }

    /// The saved game `id`, if there is one and its script can be read.
    pub fn saved(&self, id: SaveId) -> Option<SavedGame> {
        let script = self.text_in(|progress| Some(progress.saved(id)?.script.clone()))?;
        Some(SavedGame { save: self.progress.saved(id)?.save.clone(), script })
    }

    /// Whether a game with this identity can be saved: there is room, or it takes the place of another.
    pub fn has_room_for(&self, id: SaveId) -> bool {
        self.progress.saves.len() < MOST_SAVES || self.has_saved(id)
    }

    /// Saves a game, in place of the one with the same identity if there is one.
    ///
    /// # Errors
    /// If there is no room for another game, or if its script is too long to be read again.
    pub fn save(&mut self, game: &SavedGame) -> Result<(), NotSaved> {
        if !self.has_room_for(game.save.id()) {
            return Err(NotSaved::Full);
        }
        if game.script.len() as u64 > LARGEST_SCRIPT {
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

    /// The player's choices.
    pub fn preferences(&self) -> Preferences {
        self.progress.preferences
    }

    /// Sets the preferences. Those that stay as they are do not undo the choice of another game.
    pub fn set_preferences(&mut self, preferences: Preferences) {
        let before = self.progress.preferences;
        if before != preferences {
            self.change(Change::Preferences { before, after: preferences });
        }
    }

    /// How far the daily run of a date, such as 20261122, came, if it was tried.
    pub fn daily(&self, date: u32) -> Option<Reached> {
        self.progress.dailies.get(&date).copied()
    }

    /// Begins the daily run of a date, and returns whether it counts: the first try does. A try counts
    /// from its beginning, so that leaving does not undo it.
    pub fn begin_daily(&mut self, date: u32) -> bool {
        if self.daily(date).is_some() {
            return false;
        }
        let (reached, script) = (Reached::default(), String::new());
        let before = self.change(Change::Daily { date, reached, script });
        before.is_none_or(|before| !before.dailies.contains_key(&date))
    }

    /// Records what the try that counts has reached so far, and its script up to there.
    pub fn record_daily(&mut self, date: u32, reached: Reached, script: String) {
        if self.daily(date).is_none_or(|known| known < reached) {
            self.change(Change::Daily { date, reached, script });
        }
    }

    /// The best descent without an end.
    pub fn best_descent(&self) -> Option<Reached> {
        self.progress.descent
    }

    /// Records a descent without an end and its script, if it is the best one.
    pub fn record_descent(&mut self, reached: Reached, script: String) {
        if self.progress.descent.is_none_or(|best| best < reached) {
            self.change(Change::Descent { reached, script });
        }
    }

    /// A sentence about what is damaged or could not be kept, for the end of the game.
    pub fn trouble(&self) -> Option<&str> {
        self.trouble.as_deref().or(self.damage.as_deref())
    }

    /// Applies `change` to the state that the player sees, and to the file. Returns the state of the
    /// file before, if it could be changed.
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

    /// The text of the script that `name` finds in the progress, written or not.
    fn text_in(&self, name: impl Fn(&Progress) -> Option<String>) -> Option<String> {
        let wanted = name(&self.progress)?;
        let unwritten = self.pending.iter().rev().find_map(|change| change.script(&wanted));
        if let Some(text) = unwritten {
            return Some(text.to_owned());
        }
        let home = self.home.as_ref()?;
        // Another game may have replaced it.
        home.script(&wanted).or_else(|| home.script(&name(&home.read_again()?)?))
    }
}

#[cfg(test)]
mod tests;
