//! What a game depends on beside its level: its rules, and what its players want.

use serde::{Deserialize, Serialize};

use super::intent::Intents;
use crate::world::Difficulty;

/// The duration of a step, in seconds.
pub const STEP: f64 = 1.0 / STEPS_PER_SECOND as f64;

/// The steps of a game in a second.
pub const STEPS_PER_SECOND: u32 = 60;

/// The most players in a game.
pub const MOST_PLAYERS: usize = 16;

/// How many steps ago a player may have seen what they act upon: 250 ms.
pub const MOST_LAG: u64 = 15;

/// The choices that a game begins with. The same level, rules and intents give the same game.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct Rules {
    /// How hard the game is.
    pub difficulty: Difficulty,
    /// The seed of all chance in the game.
    pub seed: u64,
}

/// A player in a game for several: the number of a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "u8")]
pub struct PlayerId(u8);

impl PlayerId {
    /// The first slot, which is that of the only player of a game for one.
    pub const FIRST: Self = Self(0);

    /// The slot with that index; `None` from [`MOST_PLAYERS`] on.
    pub fn new(index: usize) -> Option<Self> {
        (index < MOST_PLAYERS).then_some(Self(index as u8))
    }

    /// The index of the slot, below [`MOST_PLAYERS`].
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

impl TryFrom<u8> for PlayerId {
    type Error = &'static str;

    fn try_from(index: u8) -> Result<Self, &'static str> {
        Self::new(index.into()).ok_or("a player")
    }
}

/// The rules among the players of a game.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MultiplayerRules {
    /// Whether players are in each other's way. Otherwise they walk through each other.
    pub collides: bool,
    /// Whether a dead player goes on from their last checkpoint when they want to
    /// [retry](super::Intent::Retry).
    pub respawns: bool,
    /// Whom the map of a player shows.
    pub sees: Sees,
    /// What a blow does to another player.
    pub strikes: Strikes,
}

impl Default for MultiplayerRules {
    /// Players walk through each other, go on after death, see each other on the map, and cannot
    /// strike each other.
    fn default() -> Self {
        Self { collides: false, respawns: true, sees: Sees::All, strikes: Strikes::Nobody }
    }
}

/// Whom the map of a player shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sees {
    /// No other player.
    Nobody,
    /// Players in sight.
    InSight,
    /// All players.
    All,
}

/// What a blow does to another player. It takes no health.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Strikes {
    /// Nothing: blows find guards only.
    Nobody,
    /// The other one is pushed away.
    Push,
    /// The other one is pushed away, and lies on the floor for 2 seconds. For 2 seconds more, nobody
    /// can strike them.
    Stun,
}

/// What one player wants in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Input {
    /// The player.
    pub player: PlayerId,
    /// What they want.
    pub intents: Intents,
    /// The number of [steps](super::Game::steps) of the game in the picture that they saw last.
    pub seen: u64,
}
