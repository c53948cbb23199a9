//! What guards perceive of players, and what they do to them.

use glam::DVec2;

use crate::game::sound::Sound;
use crate::game::stored::stored;
use crate::world::Cell;

/// What guards can perceive of a player.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Target {
    /// The position, in cells.
    pub(crate) position: DVec2,
    /// The height of the feet, in cells.
    pub(crate) feet: f64,
    /// The height of the top of the head, in cells.
    pub(crate) head: f64,
    /// How well the player is lit: from 0 for not at all to 255.
    pub(crate) visibility: u8,
    /// Whether the player carries a lit lamp, which is seen from afar.
    pub(crate) has_light: bool,
    /// Whether the player is alive. Guards let the dead be.
    pub(crate) is_alive: bool,
}

impl Target {
    /// The cell of the middle.
    pub(crate) fn cell(&self) -> Cell {
        Cell::at(self.position)
    }

    /// The height of the middle of the body.
    pub(crate) fn middle(&self) -> f64 {
        f64::midpoint(self.feet, self.head)
    }
}

/// Smoke: a disc that nobody sees through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cloud {
    /// The middle, in cells.
    pub(crate) position: DVec2,
    /// The radius, in cells.
    pub(crate) radius: f64,
}

/// What a guard does to the rest of the game in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Act {
    /// Hits the player with index `target`; the blow comes from `from`.
    Hurt { target: usize, by: usize, from: DVec2, points: u8 },
    /// Opens the door in a cell. A guard who waits before a door does so in every step.
    Open(Cell),
    /// Makes a sound.
    Sound(Sound),
    /// Shoots a bolt from a position and a height along `direction`, a unit vector; it rises by
    /// `slope` for each cell, and hits for `points`.
    Bolt { by: usize, from: DVec2, height: f64, direction: DVec2, slope: f64, points: u8 },
    /// Begins to follow a player while nobody did: one more alarm.
    Raised,
}

stored! {
    enum Act {
        0: Hurt { target, by, from, points },
        1: Open(cell),
        2: Sound(sound),
        3: Bolt { by, from, height, direction, slope, points },
        4: Raised,
    }
}
