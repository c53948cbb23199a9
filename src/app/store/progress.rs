//! Progress: the content of the store's file.

use std::collections::BTreeMap;
use std::fmt;
use std::num::NonZeroU32;

use super::best::{Best, Improved, Reached, Run};
use super::names;
use crate::color::palette::ColorDepth;
use crate::game::Rules;
use crate::tui::{Correction, GlyphSet};
use crate::world::Difficulty;

/// The content of `progress.toml`.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub(crate) struct Progress {
    /// By the key of the level.
    pub(crate) bests: BTreeMap<(String, Difficulty), Best>,
    /// The saved games, the newest last. No two have the same [`SaveId`].
    pub(crate) saves: Vec<SavedEntry>,
    pub(crate) preferences: Preferences,
    pub(crate) dailies: BTreeMap<u32, Daily>,
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
    /// What was saved.
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
    /// Its script is longer than the longest one that is read.
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
    /// The glyph set; `None` for the best that the terminal can show.
    pub glyphs: Option<GlyphSet>,
    /// The colour depth; `None` for that of the terminal.
    pub colors: Option<ColorDepth>,
    /// How pictures are changed for the player's eyes.
    pub correction: Correction,
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
            correction: Correction::None,
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

    /// What a run would improve.
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
            self.dailies.iter().filter_map(|(&date, daily)| names::of_daily(date, daily.reached));
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
