//! Sounds: where they are made, how far they reach, and who hears them.
//!
//! A sound spreads over open cells, around corners and through open doors. A closed door weakens
//! it, and walls stop it. A straight line from ear to source was refused: sounds would pass
//! through walls, and a guard behind a wall would know what happens on its other side.

mod field;
mod hearing;

use serde::{Deserialize, Serialize};

use crate::world::Cell;
pub(crate) use field::{SoundField, half_cells};
pub use hearing::Heard;
pub(crate) use hearing::Hearing;

/// A sound of one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sound {
    /// The kind of sound.
    pub kind: SoundKind,
    /// The cell where it is made.
    pub cell: Cell,
    /// How far it is heard over open cells, in cells; at most [`Sound::FARTHEST`].
    pub reach: u8,
    /// What made it.
    pub by: Source,
}

impl Sound {
    /// The largest reach that has an effect, in cells.
    pub const FARTHEST: u8 = 24;
}

/// What makes a sound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Source {
    /// The player with that index.
    Player(usize),
    /// The guard with that index.
    Guard(usize),
    /// Something that nobody does at that moment, such as a thrown pebble that lands.
    Object,
}

/// A kind of sound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum SoundKind {
    /// Steps of walking.
    Walking,
    /// Steps of running.
    Running,
    /// A landing after a jump or a fall.
    Landing,
    /// A step into water.
    Splash,
    /// A door that begins to move.
    Door,
    /// A stone, a lever or a floor that moves.
    Mechanism,
    /// Spikes that are about to come out.
    Spikes,
    /// A pebble that lands.
    Knock,
    /// Something that breaks, such as a flask.
    Crash,
    /// A blow that hits.
    Blow,
    /// Somebody who is hurt.
    Cry,
    /// A guard who falls.
    Fall,
    /// A guard who has noticed something: "Hm?"
    Wonder,
    /// A guard who has lost what they looked for, and goes back.
    GiveUp,
    /// A guard who has seen the player, and calls the others.
    Shout,
    /// The bell of a lantern-bearer.
    Bell,
    /// A hound that has seen or smelled the player.
    Bark,
    /// A guard who raises a weapon.
    Windup,
    /// An archer who draws the bow.
    Draw,
    /// An archer who shoots.
    Shot,
    /// A blow that meets nothing.
    Swing,
}
