//! The levels of a game, one after the other.

use std::fmt;

use crate::world::World;

/// The levels of a game, in order; each but the first is made when it is reached.
pub struct Levels {
    pub(super) first: World,
    pub(super) rest: Box<dyn Iterator<Item = World>>,
}

impl Levels {
    /// `first`, and then `rest`.
    pub fn new(first: World, rest: impl Iterator<Item = World> + 'static) -> Self {
        Self { first, rest: Box::new(rest) }
    }
}

impl fmt::Debug for Levels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Levels").field("first", &self.first.title()).finish_non_exhaustive()
    }
}
