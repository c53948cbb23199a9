//! The inputs and outputs of a guard's step.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::movement::GuardWorld;
use super::trail::Trail;
use super::ways::{Gait, GuardPaths, GuardTerrain};
use crate::game::rules::Rules;
use crate::game::sight::Cloud;
use crate::game::sound::{Sound, SoundKind, Source};
use crate::world::{Cell, World};

pub(crate) struct Context<'a> {
    pub(crate) world: &'a World,
    pub(crate) terrain: &'a GuardTerrain,
    pub(crate) ways: &'a mut GuardPaths,
    pub(crate) targets: &'a [PerceivedPlayer],
    pub(crate) clouds: &'a [Cloud],
    pub(crate) trails: &'a [Trail],
    /// All guards, as they were at the end of the last step.
    pub(crate) others: &'a [PerceivedGuard],
    pub(crate) rules: Rules,
    /// The number of the step.
    pub(crate) now: u64,
    /// The index of the guard.
    pub(crate) index: usize,
    /// The number of steps taken at once.
    pub(crate) stride: u16,
    pub(crate) effects: &'a mut Vec<GuardEffect>,
    /// The indices of the guards that are woken.
    pub(crate) woken: &'a mut Vec<usize>,
}

/// A guard as other guards perceive them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PerceivedGuard {
    pub(crate) position: DVec2,
    pub(crate) feet: f64,
    pub(crate) is_down: bool,
}

/// A player as guards perceive them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PerceivedPlayer {
    /// The position, in cells.
    pub(crate) position: DVec2,
    /// The height of the feet, in cells.
    pub(crate) feet: f64,
    /// The height of the top of the head, in cells.
    pub(crate) head: f64,
    /// The player's visibility to guards, from 0 for invisible to 255.
    pub(crate) visibility: u8,
    /// Whether the player carries a lit lamp, which guards see from afar.
    pub(crate) has_light: bool,
    /// Whether guards can notice the player. They ignore the dead, and players who have not acted yet.
    pub(crate) is_noticeable: bool,
}

impl PerceivedPlayer {
    /// The cell that contains the player's centre.
    pub(crate) fn cell(&self) -> Cell {
        Cell::at(self.position)
    }

    /// The height of the middle of the body.
    pub(crate) fn middle(&self) -> f64 {
        f64::midpoint(self.feet, self.head)
    }
}

/// An effect of a guard on the rest of the game.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum GuardEffect {
    /// Hits the player with index `target`. The blow comes from the position `from`.
    Hurt { target: usize, by: usize, from: DVec2, points: u8 },
    /// Opens the door in a cell. A guard who waits at a door emits this in every step.
    Open(Cell),
    /// Makes a sound.
    Sound(Sound),
    /// Shoots a bolt from a position and a height along `direction`, a unit vector. The bolt rises
    /// by `slope` for each cell and takes `points` of health.
    Bolt { by: usize, from: DVec2, height: f64, direction: DVec2, slope: f64, points: u8 },
    /// Raises the alarm: a guard begins to follow a player, and no guard did so before.
    Raised,
}

impl Context<'_> {
    pub(crate) fn target(&self, index: usize) -> Option<&PerceivedPlayer> {
        self.targets.get(index).filter(|target| target.is_noticeable)
    }

    pub(crate) fn ground(&self, gait: Gait) -> GuardWorld<'_> {
        GuardWorld { world: self.world, terrain: self.terrain, gait }
    }

    /// Makes a sound.
    pub(crate) fn sound(&mut self, kind: SoundKind, cell: Cell, reach: u8) {
        let by = Source::Guard(self.index);
        self.effects.push(GuardEffect::Sound(Sound { kind, cell, reach, by }));
    }

    /// The number of guards who are not down.
    pub(crate) fn count_up(&self) -> usize {
        self.others.iter().filter(|other| !other.is_down).count()
    }
}
