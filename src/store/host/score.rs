//! Entries of leaderboards.

use super::{AccountId, Day, Name, UnixTime, VerifiedLevel};
use crate::game::{Rank, Tally};
use crate::map::builtin;
use crate::store::{Best, Improved, Reached};
use crate::world::Difficulty;

/// A board: a built-in level at one difficulty.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LevelBoard {
    level: &'static str,
    difficulty: Difficulty,
}

/// An entry of a level's board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LevelScore {
    /// The account.
    pub account: AccountId,
    /// Its name.
    pub name: Name,
    /// The tally of its fastest run.
    pub tally: Tally,
    /// The highest rank of all its runs.
    pub rank: Rank,
    /// When the fastest run was verified.
    pub verified_at: UnixTime,
}

/// An entry of a day's board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DailyScore {
    /// The account.
    pub account: AccountId,
    /// Its name.
    pub name: Name,
    /// How far it came.
    pub reached: Reached,
    /// When that was verified.
    pub verified_at: UnixTime,
}

/// The try of a daily run that counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DailyTry {
    pub(super) account: AccountId,
    pub(super) day: Day,
}

impl LevelBoard {
    /// The board of the built-in level `level`; `None` if there is none of that name.
    pub fn new(level: &str, difficulty: Difficulty) -> Option<Self> {
        let level = builtin::LEVELS.iter().find(|known| known.name == level)?.name;
        Some(Self { level, difficulty })
    }

    /// All boards, in the order of levels and difficulties.
    pub fn all() -> impl Iterator<Item = Self> {
        builtin::LEVELS.iter().flat_map(|level| {
            Difficulty::ALL.map(|difficulty| Self { level: level.name, difficulty })
        })
    }

    /// The name of the level.
    pub fn level(&self) -> &'static str {
        self.level
    }

    /// The difficulty.
    pub fn difficulty(&self) -> Difficulty {
        self.difficulty
    }
}

impl DailyTry {
    /// The day.
    pub fn day(&self) -> Day {
        self.day
    }
}

/// The best of a known result and a run, and what the run improves.
pub(super) fn with_run(known: Option<Best>, run: &VerifiedLevel) -> (Best, Improved) {
    let of_run = Best { tally: run.tally(), rank: run.rank() };
    let Some(known) = known else { return (of_run, Improved { time: true, rank: true }) };
    let time = of_run.tally.steps < known.tally.steps;
    (known.and(of_run), Improved { time, rank: of_run.rank > known.rank })
}
