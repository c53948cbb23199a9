//! What a game depends on beside its level and the intents.

use crate::world::Difficulty;

/// The choices that a game begins with. The same level, rules and intents give the same game.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct Rules {
    /// How hard the game is.
    pub difficulty: Difficulty,
    /// The seed of all chance in the game.
    pub seed: u64,
}
