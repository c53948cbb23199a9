//! What a player hears.

use glam::DVec2;

use super::{Sound, SoundField, SoundKind};
use crate::world::{Heading, World};

/// A sound as a player hears it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heard {
    /// The direction on the map from which it comes.
    pub bearing: Heading,
    /// How loud it is, from 1 to 3.
    pub strength: u8,
    /// The kind of sound.
    pub kind: SoundKind,
    /// The steps for which it is still shown.
    pub left: u16,
}

/// The ears of a player: what was heard in the last steps.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct Hearing {
    field: SoundField,
    heard: Vec<Heard>,
}

impl Hearing {
    /// The sounds that were heard in the last steps, the newest last.
    pub(crate) fn heard(&self) -> &[Heard] {
        &self.heard
    }

    /// Hears those of `sounds` that others than the player `listener` made. Returns whether
    /// [`Hearing::heard`] has changed other than by its clocks.
    pub(crate) fn step(
        &mut self,
        world: &World,
        listener: usize,
        position: DVec2,
        sounds: &[Sound],
    ) -> bool {
        _ = (world, listener, position, sounds);
        false
    }

    /// The number of steps in which nothing that was heard fades away; `None` if there is nothing.
    pub(crate) fn quiet_steps(&self) -> Option<u64> {
        self.heard.iter().map(|heard| u64::from(heard.left)).min()
    }

    /// Advances the clocks by `steps`, at most [`Hearing::quiet_steps`].
    pub(crate) fn wait(&mut self, steps: u64) {
        let steps = u16::try_from(steps).unwrap_or(u16::MAX);
        self.heard.iter_mut().for_each(|heard| heard.left = heard.left.saturating_sub(steps));
    }
}
