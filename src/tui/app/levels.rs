//! The levels of a game, one after the other.

use std::fmt;

use crate::map::Level;

/// The levels of a game, in order; each but the first is made when it is reached.
pub struct Levels {
    pub(super) first: Level,
    pub(super) rest: Box<dyn Iterator<Item = Level>>,
}

impl Levels {
    /// `first`, and then `rest`.
    pub fn new(first: Level, rest: impl Iterator<Item = Level> + 'static) -> Self {
        Self { first, rest: Box::new(rest) }
    }
}

impl fmt::Debug for Levels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Levels").finish_non_exhaustive()
    }
}
