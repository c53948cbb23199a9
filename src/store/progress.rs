//! Progress: the content of the store's file.

use std::collections::BTreeMap;

use super::best::{Best, Improved, Reached, Run};
use super::names;
use crate::game::Rules;
use crate::world::Difficulty;

/// The content of `progress.toml`.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub(super) struct Progress {
    /// By the key of the level.
    pub(super) bests: BTreeMap<(String, Difficulty), Best>,
    pub(super) saved: Option<SavedEntry>,
    pub(super) preferences: Preferences,
    pub(super) dailies: BTreeMap<u32, Daily>,
    pub(super) descent: Option<Reached>,
}

/// A game to be continued: its script is played again up to its end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SavedGame {
    /// The level, as in the header of a script.
    pub level: String,
    /// The rules that it began with.
    pub rules: Rules,
    /// The script so far.
    pub script: String,
}

/// The saved game as the file has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct SavedEntry {
    pub(super) level: String,
    pub(super) rules: Rules,
    /// The name of the script's file.
    pub(super) script: String,
}

/// What the player has chosen in the game.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a choice of its own")]
pub struct Preferences {
    /// Whether a dot marks the middle of the picture.
    pub crosshair: bool,
    /// Whether a strip shows the directions.
    pub compass: bool,
    /// Whether the terminal's bell rings at sounds.
    pub bell: bool,
    /// Whether the best run walks along.
    pub ghost: bool,
    /// The difficulty of new games.
    pub difficulty: Difficulty,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            crosshair: false,
            compass: false,
            bell: false,
            ghost: true,
            difficulty: Difficulty::Normal,
        }
    }
}

/// A daily run that was tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Daily {
    /// How far it came.
    pub reached: Reached,
}

impl Progress {
    pub(super) fn best(&self, level: &str, difficulty: Difficulty) -> Option<&Best> {
        self.bests.get(&(level.to_owned(), difficulty))
    }

    /// What a run would improve.
    pub(super) fn improved_by(&self, level: &str, difficulty: Difficulty, run: &Run) -> Improved {
        match self.best(level, difficulty) {
            None => Improved { time: true, rank: true },
            Some(best) => {
                Improved { time: run.tally.steps < best.tally.steps, rank: run.rank > best.rank }
            }
        }
    }

    pub(super) fn won(&self, difficulty: Difficulty) -> impl Iterator<Item = &str> {
        let of_it = move |&&(_, at): &&(String, Difficulty)| at == difficulty;
        self.bests.keys().filter(of_it).map(|(level, _)| level.as_str())
    }

    /// The names of all scripts that it refers to.
    pub(super) fn scripts(&self) -> impl Iterator<Item = String> {
        let runs = self
            .bests
            .iter()
            .map(|((level, difficulty), best)| names::of_run(level, *difficulty, best.tally.steps));
        let saved = self.saved.iter().map(|saved| saved.script.clone());
        let dailies =
            self.dailies.iter().filter_map(|(&date, daily)| names::of_daily(date, daily.reached));
        runs.chain(saved).chain(dailies).chain(self.descent.and_then(names::of_descent))
    }
}

impl SavedEntry {
    pub(super) fn of(game: &SavedGame) -> Self {
        let script = names::of_saved(&game.script);
        Self { level: game.level.clone(), rules: game.rules, script }
    }

    pub(super) fn with_script(&self, script: String) -> SavedGame {
        SavedGame { level: self.level.clone(), rules: self.rules, script }
    }
}
