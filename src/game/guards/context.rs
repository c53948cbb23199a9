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

pub(crate) struct Context<'a> {
    pub(crate) world: &'a World,
    pub(crate) terrain: &'a Terrain,
    pub(crate) ways: &'a mut Ways,
    pub(crate) targets: &'a [Target],
    pub(crate) clouds: &'a [Cloud],
    pub(crate) trails: &'a [Trail],
    /// All guards, as they were at the end of the last step.
    pub(crate) others: &'a [Other],
    pub(crate) rules: Rules,
    /// The number of the step.
    pub(crate) now: u64,
    /// The index of the guard.
    pub(crate) index: usize,
    /// The number of steps that are taken at once.
    pub(crate) stride: u16,
    pub(crate) acts: &'a mut Vec<Act>,
    /// The indices of guards who are woken.
    pub(crate) woken: &'a mut Vec<usize>,
}

/// What guards know of each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Other {
    pub(crate) position: DVec2,
    pub(crate) feet: f64,
    pub(crate) is_down: bool,
}

impl Context<'_> {
    pub(crate) fn target(&self, index: usize) -> Option<&Target> {
        self.targets.get(index).filter(|target| target.is_alive)
    }

    pub(crate) fn ground(&self, gait: Gait) -> Ground<'_> {
        Ground { world: self.world, terrain: self.terrain, gait }
    }

    /// Makes a sound.
    pub(crate) fn sound(&mut self, kind: SoundKind, cell: Cell, reach: u8) {
        let by = Source::Guard(self.index);
        self.acts.push(Act::Sound(Sound { kind, cell, reach, by }));
    }

    /// The number of guards who are not down.
    pub(crate) fn count_up(&self) -> usize {
        self.others.iter().filter(|other| !other.is_down).count()
    }
}
