//! Games for several: who is in them, and the rules among them.
//!
//! A player has a slot for as long as they are in the game. A step moves the players in the order of
//! their slots, and then everything else once, as often as a step of a game for one does. So a game
//! for several with one player in it is the game for one, bit for bit, up to that player's death.
//!
//! - Time passes while anybody in the game is alive and has not reached the exit.
//! - A dead player goes on from their own last checkpoint, alone: the level stays as it is. Restoring
//!   the level, as a game for one does, was refused: it would undo what the others have done.
//! - Treasure counts for all. Keys belong to their finders; those of a player who leaves, reaches
//!   the exit or is dead for good lie where they were found.
//! - What a player does to others is judged by the positions in the step that the player saw, at
//!   most [`MOST_LAG`] steps ago. Judging by the present positions was refused: players would have to
//!   aim ahead of everybody by as much as their connection is slow.
//! - Bodies that collide are columns without an upper end: nobody jumps onto a head.

mod entry;
mod figures;
mod keys;
mod members;
mod seen;
mod step;
mod strike;
mod view;

use serde::{Deserialize, Serialize};

use super::Intents;
pub(crate) use members::{Members, playing, playing_mut};
pub use view::{OtherPlayer, PlayerView};

/// The most players in a game.
pub const MOST_PLAYERS: usize = 16;

/// How many steps ago a player may have seen what they act upon: 250 ms.
pub const MOST_LAG: u64 = 15;

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

#[cfg(test)]
mod tests;
