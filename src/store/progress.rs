//! Progress: the content of the store's file.

use std::collections::BTreeMap;
use std::num::NonZeroU32;

use super::best::{Best, Improved, Reached, Run};
use super::names;
use crate::color::palette::ColorDepth;
use crate::game::Rules;
use crate::tui::GlyphMode;
use crate::world::Difficulty;

/// The content of `progress.toml`.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub(super) struct Progress {
    /// By the key of the level.
    pub(super) bests: BTreeMap<(String, Difficulty), Best>,
    pub(super) saved: Option<SavedEntry>,
    pub(super) saved_descent: Option<SavedEntry>,
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
    /// The checksum of the game at the end of the script. Where it differs, the level or the rules have
    /// changed since. Old files have none.
    pub checksum: Option<u64>,
    /// The kind of the descent; `None` for a level.
    pub descent: Option<Descent>,
}

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

/// Where a game is saved: a descent does not replace a level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slot {
    /// For a level.
    Level,
    /// For a descent.
    Descent,
}

/// The saved game as the file has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct SavedEntry {
    pub(super) level: String,
    pub(super) rules: Rules,
    /// The name of the script's file.
    pub(super) script: String,
    pub(super) checksum: Option<u64>,
    pub(super) descent: Option<Descent>,
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
    /// The glyph mode; `None` for the best that the terminal can show.
    pub glyphs: Option<GlyphMode>,
    /// The colour depth; `None` for that of the terminal.
    pub colors: Option<ColorDepth>,
    /// The most frames per second; `None` for the default.
    pub frames_per_second: Option<NonZeroU32>,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            crosshair: false,
            compass: false,
            bell: false,
            ghost: true,
            difficulty: Difficulty::Normal,
            glyphs: None,
            colors: None,
            frames_per_second: None,
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

    pub(super) fn saved_in(&self, slot: Slot) -> Option<&SavedEntry> {
        match slot {
            Slot::Level => self.saved.as_ref(),
            Slot::Descent => self.saved_descent.as_ref(),
        }
    }

    pub(super) fn saved_in_mut(&mut self, slot: Slot) -> &mut Option<SavedEntry> {
        match slot {
            Slot::Level => &mut self.saved,
            Slot::Descent => &mut self.saved_descent,
        }
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
        let saved = self.saved.iter().chain(&self.saved_descent).map(|saved| saved.script.clone());
        let dailies =
            self.dailies.iter().filter_map(|(&date, daily)| names::of_daily(date, daily.reached));
        runs.chain(saved).chain(dailies).chain(self.descent.and_then(names::of_descent))
    }
}

impl SavedGame {
    /// Where it is saved.
    pub fn slot(&self) -> Slot {
        if self.descent.is_some() { Slot::Descent } else { Slot::Level }
    }
}

impl Descent {
    const NAMES: [(Self, &str); 3] =
        [(Self::Endless, "endless"), (Self::Daily, "daily"), (Self::Practice, "practice")];

    pub(super) fn name(self) -> &'static str {
        Self::NAMES[self as usize].1
    }

    pub(super) fn named(name: &str) -> Option<Self> {
        Self::NAMES.iter().find(|(_, known)| *known == name).map(|&(kind, _)| kind)
    }
}

impl SavedEntry {
    pub(super) fn of(game: &SavedGame) -> Self {
        let script = names::of_saved(&game.script);
        let &SavedGame { rules, checksum, descent, .. } = game;
        Self { level: game.level.clone(), rules, script, checksum, descent }
    }

    pub(super) fn with_script(&self, script: String) -> SavedGame {
        let &Self { rules, checksum, descent, .. } = self;
        SavedGame { level: self.level.clone(), rules, script, checksum, descent }
    }
}
