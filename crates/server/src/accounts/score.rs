//! Entries of leaderboards.

use std::cmp::Ordering;
use std::sync::Arc;

use super::{AccountId, Day, Name, UnixTime, VerifiedLevel};
use cellcaster::app::store::{Best, Improved, Reached, name_in_map_key};
use cellcaster::game::{Rank, Tally};
use cellcaster::map::builtin;
use cellcaster::world::Difficulty;

/// A board: a built-in level or a map of the host, at one difficulty.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct LevelBoard {
    level: Arc<str>,
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
    pub(crate) account: AccountId,
    pub(crate) day: Day,
}

impl LevelBoard {
    /// The board of `level`: the name of a built-in level, or the [key](cellcaster::app::store::map_key) of a map.
    /// `None` if it is neither.
    pub fn new(level: &str, difficulty: Difficulty) -> Option<Self> {
        let is_level = place(level).is_some() || name_in_map_key(level).is_some();
        is_level.then(|| Self { level: level.into(), difficulty })
    }

    /// The name of the level, or the key of the map.
    pub fn level(&self) -> &str {
        &self.level
    }

    /// The name of the level, or that of the map without the hash of its text.
    pub fn name(&self) -> &str {
        name_in_map_key(&self.level).unwrap_or(&self.level)
    }

    /// The difficulty.
    pub fn difficulty(&self) -> Difficulty {
        self.difficulty
    }
}

impl Ord for LevelBoard {
    /// Built-in levels in their order come before maps by name, and easy before hard.
    fn cmp(&self, other: &Self) -> Ordering {
        let rank = |board: &Self| {
            let level = place(&board.level).unwrap_or(usize::MAX);
            let difficulty = Difficulty::ALL.iter().position(|it| *it == board.difficulty);
            (level, difficulty)
        };
        let [(level, difficulty), (other_level, other_difficulty)] = [rank(self), rank(other)];
        let by_level = level.cmp(&other_level).then_with(|| self.level.cmp(&other.level));
        by_level.then(difficulty.cmp(&other_difficulty))
    }
}

impl PartialOrd for LevelBoard {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The place of a built-in level among all of them.
fn place(level: &str) -> Option<usize> {
    builtin::LEVELS.iter().position(|known| known.name == level)
}

impl DailyTry {
    /// The day.
    pub fn day(&self) -> Day {
        self.day
    }
}

/// The best of a known result and a run, and what the run improves.
pub(crate) fn with_run(known: Option<Best>, run: &VerifiedLevel) -> (Best, Improved) {
    let of_run = Best { tally: run.tally(), rank: run.rank() };
    let Some(known) = known else { return (of_run, Improved { time: true, rank: true }) };
    let time = of_run.tally.steps < known.tally.steps;
    (known.and(of_run), Improved { time, rank: of_run.rank > known.rank })
}
