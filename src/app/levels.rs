//! The levels of a game, one after the other.

use std::{fmt, iter};

use super::played::Played;
use super::reload::Changes;
use crate::fault::Faults;
use crate::game::Game;
use crate::map::Level;

/// The levels of a game, in order; each but the first is made when it is reached.
pub struct Levels {
    pub(super) first: Played,
    pub(super) rest: Box<dyn Iterator<Item = Played>>,
    pub(super) changes: Option<Changes>,
    pub(super) number: LevelNumber,
}

/// Which level of how many that is, as players count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct LevelNumber {
    number: usize,
    /// `None` where there is always another one, or nobody knows.
    of: Option<usize>,
}

impl Levels {
    /// `first`, and then `rest`.
    pub fn new(first: Level, rest: impl Iterator<Item = Level> + 'static) -> Self {
        Self::played(Played::new(first), rest.map(Played::new))
    }

    /// Games that have begun elsewhere: `first`, and then `rest`.
    pub fn of_games(first: Game, rest: impl Iterator<Item = Game> + 'static) -> Self {
        let played = |game| Played::Grid(Box::new(game));
        Self::played(played(first), rest.map(played))
    }

    /// One level that may change while it is played. `changes` is asked a few times a second: it
    /// answers with the level as it is now, or with what is wrong with it, where it has changed since
    /// it was asked last.
    pub fn changing(
        level: Level,
        changes: impl FnMut() -> Option<Result<Level, Faults>> + 'static,
    ) -> Self {
        Self { changes: Some(Box::new(changes)), ..Self::new(level, iter::empty()) }
    }

    /// With the first being `number`, counted from 1, of so many levels.
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
    /// That of the level after this one.
    #[must_use]
    pub(super) fn next(self) -> Self {
        Self { number: self.number + 1, ..self }
    }

    /// Whether there are several levels, as far as anybody knows.
    pub(super) fn is_one_of_several(self) -> bool {
        self.number > 1 || self.of.is_some_and(|count| count > 1)
    }

    /// As `2/5`.
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
