//! Guards: they stand, patrol, notice, search, chase, strike, give up and fall.
//!
//! A step of all guards depends on the world, on what can be perceived of the players, on the
//! sounds of the step and on nothing else.

mod mood;
mod view;

use glam::DVec2;

use super::rules::Rules;
use super::sound::Sound;
use crate::world::{Cell, World};

pub use mood::{Alarm, Mood};
pub use view::GuardView;

/// All guards of a level.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Guards {
    rules: Rules,
    views: Vec<GuardView>,
    acts: Vec<Act>,
}

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
    /// Opens the door in a cell.
    Open(Cell),
    /// Makes a sound.
    Sound(Sound),
    /// Shoots a bolt from a position and a height along `direction`, a unit vector; it rises by
    /// `slope` for each cell, and hits for `points`.
    Bolt { by: usize, from: DVec2, height: f64, direction: DVec2, slope: f64, points: u8 },
    /// Begins to follow a player while nobody did: one more alarm.
    Raised,
}

impl Guards {
    /// The guards of `world` that are there under these rules. Their sprites are added to `world`.
    pub(crate) fn new(world: &mut World, rules: Rules) -> Self {
        _ = world;
        Self { rules, views: Vec::new(), acts: Vec::new() }
    }

    /// Whether there are none.
    pub(crate) fn is_empty(&self) -> bool {
        self.views.is_empty()
    }

    /// Advances all guards by one step. Each target is the player with that index; `sounds` are
    /// those that others than guards have made in this step.
    pub(crate) fn step(
        &mut self,
        world: &World,
        targets: &[Target],
        sounds: &[Sound],
        clouds: &[Cloud],
    ) -> &[Act] {
        _ = (world, targets, sounds, clouds);
        self.acts.clear();
        &self.acts
    }

    /// The number of steps in which no guard does anything, if nothing is perceived; 0 if anybody
    /// moves, `None` if nobody ever will.
    pub(crate) fn quiet_steps(&self) -> Option<u64> {
        if self.is_empty() { None } else { Some(0) }
    }

    /// The guards, in the order of their indices.
    pub(crate) fn views(&self) -> impl ExactSizeIterator<Item = GuardView> + '_ {
        self.views.iter().copied()
    }

    /// How much the guards know.
    pub(crate) fn alarm(&self) -> Alarm {
        Alarm::Calm
    }

    /// Whether the guard `index` has not noticed a player, and is not down.
    pub(crate) fn is_unaware(&self, index: usize) -> bool {
        self.views.get(index).is_some_and(|view| view.mood < Mood::Chasing)
    }

    /// Whether any guard would overlap `cell` if it were solid: a door does not close on them.
    pub(crate) fn touches(&self, cell: Cell) -> bool {
        _ = cell;
        false
    }

    /// Whether any guard stands in `cell`: plates and floors that crumble feel it.
    pub(crate) fn weighs_on(&self, cell: Cell) -> bool {
        _ = cell;
        false
    }

    /// The nearest guard who is not down, whose middle is at most `reach` from `position` and at
    /// most the angle with the cosine `least_cosine` off `direction`, a unit vector, and with whom
    /// a body from `feet` to `head` overlaps in height.
    pub(crate) fn guard_near(
        &self,
        world: &World,
        position: DVec2,
        direction: DVec2,
        reach: f64,
        least_cosine: f64,
    ) -> Option<usize> {
        _ = (world, position, direction, reach, least_cosine);
        None
    }

    /// The middle of the body of the nearest guard in sight of an eye, at most the angle with the
    /// cosine `least_cosine` off `direction`: the position and the height at which to shoot.
    pub(crate) fn aim(
        &self,
        world: &World,
        clouds: &[Cloud],
        eye: (DVec2, f64),
        direction: DVec2,
        least_cosine: f64,
    ) -> Option<(DVec2, f64)> {
        _ = (world, clouds, eye, direction, least_cosine);
        None
    }

    /// The guard whom a projectile hits that moves from `from` to `to`, the nearest to `from`; both
    /// have a position and a height.
    pub(crate) fn hit_between(&self, from: (DVec2, f64), to: (DVec2, f64)) -> Option<usize> {
        _ = (from, to);
        None
    }

    /// Whether `from` is behind the guard `index`: more than 90° off the direction of their look.
    pub(crate) fn is_behind(&self, index: usize, from: DVec2) -> bool {
        self.views
            .get(index)
            .is_some_and(|view| view.heading.direction().dot(from - view.position) < 0.0)
    }

    /// Lays the guard `index` on the floor for that many steps.
    pub(crate) fn stun(&mut self, index: usize, steps: u16) {
        _ = (index, steps);
    }

    /// Pushes the guard `index` along `direction`, a unit vector: they stagger for half a second,
    /// and lose the blow that they were raising.
    pub(crate) fn push(&mut self, index: usize, direction: DVec2) {
        _ = (index, direction);
    }

    /// A number that depends on the whole state.
    pub(crate) fn checksum(&self) -> u64 {
        0
    }
}
