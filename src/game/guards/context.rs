//! What a guard's step depends on beside the guard.

use glam::DVec2;

use super::act::{Act, Cloud, Target};
use super::mover::Ground;
use super::terrain::{Gait, Terrain};
use super::trail::Trail;
use super::ways::Ways;
use crate::game::rules::Rules;
use crate::game::sound::{Sound, SoundKind, Source};
use crate::world::{Cell, World};

pub(super) struct Context<'a> {
    pub(super) world: &'a World,
    pub(super) terrain: &'a Terrain,
    pub(super) ways: &'a mut Ways,
    pub(super) targets: &'a [Target],
    pub(super) clouds: &'a [Cloud],
    pub(super) trails: &'a [Trail],
    /// All guards, as they were at the end of the last step.
    pub(super) others: &'a [Other],
    pub(super) rules: Rules,
    /// The number of the step.
    pub(super) now: u64,
    /// The index of the guard.
    pub(super) index: usize,
    /// The number of steps that are taken at once.
    pub(super) stride: u16,
    pub(super) acts: &'a mut Vec<Act>,
    /// The indices of guards who are woken.
    pub(super) woken: &'a mut Vec<usize>,
}

/// What guards know of each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Other {
    pub(super) position: DVec2,
    pub(super) feet: f64,
    pub(super) is_down: bool,
}

impl Context<'_> {
    pub(super) fn target(&self, index: usize) -> Option<&Target> {
        self.targets.get(index).filter(|target| target.is_alive)
    }

    pub(super) fn ground(&self, gait: Gait) -> Ground<'_> {
        Ground { world: self.world, terrain: self.terrain, gait }
    }

    /// Makes a sound.
    pub(super) fn sound(&mut self, kind: SoundKind, cell: Cell, reach: u8) {
        let by = Source::Guard(self.index);
        self.acts.push(Act::Sound(Sound { kind, cell, reach, by }));
    }

    /// The number of guards who are not down.
    pub(super) fn count_up(&self) -> usize {
        self.others.iter().filter(|other| !other.is_down).count()
    }
}
