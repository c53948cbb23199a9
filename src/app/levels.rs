//! The levels of a game, in order.

use std::{fmt, iter};

use super::played::Played;
use super::reload::Changes;
use crate::fault::Faults;
use crate::game::Game;
use crate::map::Level;

/// The levels of a game, in order. Each but the first is created when it is reached.
pub struct Levels {
    pub(super) first: Played,
    pub(super) rest: Box<dyn Iterator<Item = Played>>,
    pub(super) changes: Option<Changes>,
    pub(super) number: LevelNumber,
}

/// The number of a level, counted from 1, and the number of levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct LevelNumber {
    number: usize,
    /// `None` if the number is unlimited or unknown.
    of: Option<usize>,
}

impl Levels {
    /// The levels `first` and `rest`.
    pub fn new(first: Level, rest: impl Iterator<Item = Level> + 'static) -> Self {
        Self::played(Played::new(first), rest.map(Played::new))
    }

    /// The games `first` and `rest`, which have already begun.
    pub fn of_games(first: Game, rest: impl Iterator<Item = Game> + 'static) -> Self {
        let played = |game| Played::Grid(Box::new(game));
        Self::played(played(first), rest.map(played))
    }

    /// One level that may change during the game. `changes` is called a few times a second. If the
    /// level has changed since the last call, it returns the new level or its faults.
    pub fn changing(
        level: Level,
        changes: impl FnMut() -> Option<Result<Level, Faults>> + 'static,
    ) -> Self {
        Self { changes: Some(Box::new(changes)), ..Self::new(level, iter::empty()) }
    }

    /// Sets the number of the first level, counted from 1, and the number of levels.
    #[must_use]
    pub fn numbered(self, number: usize, of: usize) -> Self {
        Self { number: LevelNumber { number, of: Some(of) }, ..self }
    }

    fn played(first: Played, rest: impl Iterator<Item = Played> + 'static) -> Self {
        Self {
            first,
            rest: Box::new(rest),
            number: LevelNumber { number: 1, of: None },
            changes: None,
        }
    }
}

impl LevelNumber {
    /// The number of the next level.
    #[must_use]
    pub(super) fn next(self) -> Self {
        Self { number: self.number + 1, ..self }
    }

    /// Whether there are several levels, as far as known.
    pub(super) fn is_one_of_several(self) -> bool {
        self.number > 1 || self.of.is_some_and(|count| count > 1)
    }

    /// Writes the number as `2/5`.
    pub(super) fn write_short(self, to: &mut impl fmt::Write) -> fmt::Result {
        match self.of {
            Some(count) => write!(to, "{}/{count}", self.number),
            None => write!(to, "{}", self.number),
        }
    }
}

impl fmt::Display for LevelNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "level {}", self.number)?;
        self.of.map_or(Ok(()), |count| write!(f, " of {count}"))
    }
}

impl fmt::Debug for Levels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Levels").finish_non_exhaustive()
    }
}
