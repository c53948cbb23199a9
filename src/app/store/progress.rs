//! Progress: the content of the store's file, and changes of it, which are applied to whatever the file
//! holds at that time.

use std::collections::BTreeMap;
use std::{fmt, mem};

use crate::app::store::names;
use crate::app::store::preferences::Preferences;
use crate::app::store::results::{Best, Improved, Reached, Run};
use crate::game::Rules;
use crate::world::Difficulty;

/// The content of `progress.toml`.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub(crate) struct Progress {
    /// By the key of the level.
    pub(crate) bests: BTreeMap<(String, Difficulty), Best>,
    /// The saved games, the newest last. No two have the same [`SaveId`].
    pub(crate) saves: Vec<SavedEntry>,
    pub(crate) preferences: Preferences,
    /// How far the daily runs of the dates came.
    pub(crate) dailies: BTreeMap<u32, Reached>,
    pub(crate) descent: Option<Reached>,
}

/// A saved game without its script.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Save {
    /// The level, as in the header of a script.
    pub level: String,
    /// The absolute path of the map file; `None` if the level is not in one, and in old files.
    pub file: Option<String>,
    /// The rules that it began with.
    pub rules: Rules,
    /// The kind of the descent; `None` for a level.
    pub descent: Option<Descent>,
    /// The steps that were played. Old files have none.
    pub steps: Option<u64>,
    /// The checksum of the game at the end of the script. Where it differs, the level or the rules have
    /// changed since. Old files have none.
    pub checksum: Option<u64>,
}

/// A game to be continued: its script is played again up to its end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SavedGame {
    /// Its description.
    pub save: Save,
    /// The script so far.
    pub script: String,
}

/// Identifies a saved game by what it takes the place of: the game in the same level or map file at
/// the same difficulty, or the descent of the same kind and seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SaveId(u64);

/// The reason why a game is not saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotSaved {
    /// [`MOST_SAVES`] other games are saved.
    Full,
    /// Its script is longer than the longest script that is read.
    TooLong,
}

impl std::error::Error for NotSaved {}

/// The most games that are saved.
pub const MOST_SAVES: usize = 100;

/// The kind of a descent. It begins on its first floor, with its date as the seed if it has one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Descent {
    /// A descent without an end.
    Endless,
    /// The try of a day that counts.
    Daily,
    /// A later try of a day.
    Practice,
}

/// The saved game as the file has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct SavedEntry {
    pub(crate) save: Save,
    /// The name of the script's file.
    pub(crate) script: String,
}

impl Progress {
    pub(crate) fn best(&self, level: &str, difficulty: Difficulty) -> Option<&Best> {
        self.bests.get(&(level.to_owned(), difficulty))
    }

    pub(crate) fn saved(&self, id: SaveId) -> Option<&SavedEntry> {
        self.saves.iter().find(|entry| entry.save.id() == id)
    }

    /// Adds a saved game as the newest one, in place of the one with the same identity.
    pub(crate) fn add_save(&mut self, entry: SavedEntry) {
        self.remove_save(entry.save.id());
        self.saves.push(entry);
    }

    pub(crate) fn remove_save(&mut self, id: SaveId) {
        self.saves.retain(|entry| entry.save.id() != id);
    }

    /// The improvement by a run.
    pub(crate) fn improved_by(&self, level: &str, difficulty: Difficulty, run: &Run) -> Improved {
        match self.best(level, difficulty) {
            None => Improved { time: true, rank: true },
            Some(best) => {
                Improved { time: run.tally.steps < best.tally.steps, rank: run.rank > best.rank }
            }
        }
    }

    pub(crate) fn won(&self, difficulty: Difficulty) -> impl Iterator<Item = &str> {
        let of_it = move |&&(_, at): &&(String, Difficulty)| at == difficulty;
        self.bests.keys().filter(of_it).map(|(level, _)| level.as_str())
    }

    /// The names of all scripts that it refers to.
    pub(crate) fn scripts(&self) -> impl Iterator<Item = String> {
        let runs = self
            .bests
            .iter()
            .map(|((level, difficulty), best)| names::of_run(level, *difficulty, best.tally.steps));
        let saved = self.saves.iter().map(|entry| entry.script.clone());
        let dailies =
            self.dailies.iter().filter_map(|(&date, reached)| names::of_daily(date, *reached));
        runs.chain(saved).chain(dailies).chain(self.descent.and_then(names::of_descent))
    }
}

impl Save {
    /// Its identity.
    pub fn id(&self) -> SaveId {
        let place = self.file.as_deref().unwrap_or(&self.level);
        let kind = self.descent.map_or("level", Descent::name);
        let Rules { difficulty, seed } = self.rules;
        SaveId(names::hash(&format!("{kind} {} {seed} {place}", difficulty.name())))
    }
}

impl fmt::Display for NotSaved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Full => write!(f, "{MOST_SAVES} other games are saved, and no more are kept"),
            Self::TooLong => f.write_str("it is longer than a game that can be kept"),
        }
    }
}

impl Descent {
    const NAMES: [(Self, &str); 3] =
        [(Self::Endless, "endless"), (Self::Daily, "daily"), (Self::Practice, "practice")];

    pub(crate) fn name(self) -> &'static str {
        Self::NAMES[self as usize].1
    }

    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::NAMES.iter().find(|(_, known)| *known == name).map(|&(kind, _)| kind)
    }
}

impl SavedEntry {
    pub(crate) fn of(game: &SavedGame) -> Self {
        Self { save: game.save.clone(), script: names::of_saved(&game.script) }
    }
}

/// A change.
#[derive(Clone, Debug)]
pub(crate) enum Change {
    /// A run reached the exit.
    Won { level: String, difficulty: Difficulty, run: Run },
    /// A game was saved.
    Saved(SavedGame),
    /// A saved game was removed.
    Removed(SaveId),
    /// The player has chosen what differs.
    Preferences { before: Preferences, after: Preferences },
    /// The daily run of a date has come this far.
    Daily { date: u32, reached: Reached, script: String },
    /// A descent has come this far.
    Descent { reached: Reached, script: String },
}

impl Change {
    /// The name and the text of the script that belongs to the change.
    pub(crate) fn written(&self) -> Option<(String, &str)> {
        match self {
            Self::Won { level, difficulty, run } => {
                Some((names::of_run(level, *difficulty, run.tally.steps), &run.script))
            }
            Self::Saved(game) => Some((names::of_saved(&game.script), &game.script)),
            Self::Daily { date, reached, script } => {
                Some((names::of_daily(*date, *reached)?, script))
            }
            Self::Descent { reached, script } => Some((names::of_descent(*reached)?, script)),
            Self::Removed(_) | Self::Preferences { .. } => None,
        }
    }

    /// The text of the script `name`, if it belongs to the change.
    pub(crate) fn script(&self, name: &str) -> Option<&str> {
        self.written().filter(|(own, _)| own == name).map(|(_, text)| text)
    }
}

impl Progress {
    /// Applies a change. The better result wins, whichever came first.
    pub(crate) fn apply(&mut self, change: &Change) {
        match change {
            Change::Won { level, difficulty, run } => {
                self.add_best((level.clone(), *difficulty), Best::of(run));
            }
            Change::Saved(game) => self.add_save(SavedEntry::of(game)),
            Change::Removed(id) => self.remove_save(*id),
            Change::Preferences { before, after } => self.preferences.choose(*before, *after),
            Change::Daily { date, reached, .. } => self.add_daily(*date, *reached),
            Change::Descent { reached, .. } => self.descent = self.descent.max(Some(*reached)),
        }
    }

    /// Adds from `known` what a damaged file has lost.
    pub(crate) fn complete(&mut self, known: &Self) {
        known.bests.iter().for_each(|(key, best)| self.add_best(key.clone(), *best));
        known.dailies.iter().for_each(|(date, reached)| self.add_daily(*date, *reached));
        self.descent = self.descent.max(known.descent);
        let readable = mem::replace(&mut self.saves, known.saves.clone());
        for entry in readable {
            self.add_save(entry);
        }
        self.preferences.choose(Preferences::default(), known.preferences);
    }

    fn add_best(&mut self, key: (String, Difficulty), best: Best) {
        let known = self.bests.get(&key);
        let best = known.map_or(best, |known| known.and(best));
        self.bests.insert(key, best);
    }

    fn add_daily(&mut self, date: u32, reached: Reached) {
        let known = self.dailies.entry(date).or_insert(reached);
        *known = reached.max(*known);
    }
}
