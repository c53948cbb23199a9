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
}

impl Levels {
    /// `first`, and then `rest`.
    pub fn new(first: Level, rest: impl Iterator<Item = Level> + 'static) -> Self {
        Self { first: Played::new(first), rest: Box::new(rest.map(Played::new)), changes: None }
    }

    /// Games that have begun elsewhere: `first`, and then `rest`.
    pub fn of_games(first: Game, rest: impl Iterator<Item = Game> + 'static) -> Self {
        let rest = rest.map(|game| Played::Grid(Box::new(game)));
        Self { first: Played::Grid(Box::new(first)), rest: Box::new(rest), changes: None }
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
}

impl fmt::Debug for Levels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Levels").finish_non_exhaustive()
    }
}
