//! The inputs of a game other than its level: its rules, and the intents of its players.

use serde::{Deserialize, Serialize};

use super::intent::Intents;
use crate::world::Difficulty;

/// The duration of a step, in seconds.
pub const STEP: f64 = 1.0 / STEPS_PER_SECOND as f64;

/// The number of steps in a second.
pub const STEPS_PER_SECOND: u32 = 60;

/// The maximum number of players in a game.
pub const MAX_PLAYERS: usize = 16;

/// The maximum age of the step that a player acts upon, in steps: 250 ms.
pub const MAX_LAG: u64 = 15;

/// The options of a game at its start. The same level, rules and intents produce the same game.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct Rules {
    /// The difficulty.
    pub difficulty: Difficulty,
    /// The seed of all random numbers in the game.
    pub seed: u64,
}

/// A player of a multiplayer game, identified by the number of their slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "u8")]
pub struct PlayerId(u8);

impl PlayerId {
    /// The first slot. In a single-player game, the player's slot.
    pub const FIRST: Self = Self(0);

    /// The slot with that index; `None` if it is [`MAX_PLAYERS`] or more.
    pub fn new(index: usize) -> Option<Self> {
        (index < MAX_PLAYERS).then_some(Self(index as u8))
    }

    /// The index of the slot, below [`MAX_PLAYERS`].
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

/// The rules between the players of a game.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MultiplayerRules {
    /// Whether players block each other. Otherwise they walk through each other.
    pub collides: bool,
    /// Whether a dead player continues from their last checkpoint when they want to
    /// [retry](super::Intent::Retry).
    pub respawns: bool,
    /// The other players that a player's map shows.
    pub shows_on_map: ShownPlayers,
    /// The effect of a blow on another player.
    pub strikes: StrikeEffect,
}

impl Default for MultiplayerRules {
    /// Players walk through each other, continue after death, see each other on the map, and cannot
    /// strike each other.
    fn default() -> Self {
        Self {
            collides: false,
            respawns: true,
            shows_on_map: ShownPlayers::All,
            strikes: StrikeEffect::Nobody,
        }
    }
}

/// The other players that a player's map shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ShownPlayers {
    /// No other player.
    Nobody,
    /// Players in sight.
    InSight,
    /// All players.
    All,
}

/// The effect of a blow on another player. It takes no health.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StrikeEffect {
    /// None: blows hit only guards.
    Nobody,
    /// The victim is pushed away.
    Push,
    /// The victim is pushed away and lies on the floor for 2 seconds. For 2 more seconds, nobody
    /// can strike them.
    Stun,
}

/// The input of one player for a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Input {
    /// The player.
    pub player: PlayerId,
    /// The player's intents.
    pub intents: Intents,
    /// The number of [steps](super::Game::steps) of the game in the frame that the player saw last.
    pub seen: u64,
}
