//! Changes of the progress, which are applied to whatever the file holds at that time.

use std::mem;

use super::best::{Best, Reached, Run};
use super::names;
use super::progress::{Daily, Preferences, Progress, SaveId, SavedEntry, SavedGame};
use crate::world::Difficulty;

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
            Change::Daily { date, reached, .. } => {
                self.add_daily(*date, Daily { reached: *reached });
            }
            Change::Descent { reached, .. } => self.descent = self.descent.max(Some(*reached)),
        }
    }

    /// Adds from `known` what a damaged file has lost.
    pub(crate) fn complete(&mut self, known: &Self) {
        known.bests.iter().for_each(|(key, best)| self.add_best(key.clone(), *best));
        known.dailies.iter().for_each(|(date, daily)| self.add_daily(*date, *daily));
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

    fn add_daily(&mut self, date: u32, daily: Daily) {
        let known = self.dailies.entry(date).or_insert(daily);
        known.reached = known.reached.max(daily.reached);
    }
}

impl Preferences {
    /// Takes over what differs between `before` and `after`.
    fn choose(&mut self, before: Self, after: Self) {
        fn set<T: PartialEq>(value: &mut T, before: &T, after: T) {
            if *before != after {
                *value = after;
            }
        }
        set(&mut self.crosshair, &before.crosshair, after.crosshair);
        set(&mut self.compass, &before.compass, after.compass);
        set(&mut self.bell, &before.bell, after.bell);
        set(&mut self.ghost, &before.ghost, after.ghost);
        set(&mut self.difficulty, &before.difficulty, after.difficulty);
        set(&mut self.glyphs, &before.glyphs, after.glyphs);
        set(&mut self.colors, &before.colors, after.colors);
        set(&mut self.correction, &before.correction, after.correction);
        set(&mut self.frames_per_second, &before.frames_per_second, after.frames_per_second);
    }
}
