//! What a player hears.

use glam::DVec2;

use super::field::half_cells;
use super::{Sound, SoundField, SoundKind, Source};
use crate::game::stored::{Unrestorable, check, stored};
use crate::world::{Cell, Heading, World};

/// The steps for which a sound is shown.
const DURATION: u16 = 45;
/// The number of sounds that are shown at a time.
const MOST: usize = 8;

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

stored! { struct Heard { bearing, strength, kind, left } }

/// The ears of a player: what was heard in the last steps.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct Hearing {
    field: SoundField,
    heard: Vec<Heard>,
    /// What was heard as each of them.
    sounds: Vec<Sound>,
    steps: u64,
}

stored! { struct Hearing { field, heard, sounds, steps } }

impl Hearing {
    /// The sounds that were heard in the last steps, the newest last.
    pub(crate) fn heard(&self) -> &[Heard] {
        &self.heard
    }

    /// Advances by one step, in which `sounds` are made; the player `listener`, at `position`,
    /// hears those of others. Returns whether a sound is heard or fades away.
    pub(crate) fn step(
        &mut self,
        world: &World,
        listener: usize,
        position: DVec2,
        sounds: &[Sound],
    ) -> bool {
        let before = self.heard.len();
        self.wait(1);
        let has_faded = self.heard.len() != before;
        let mut has_heard = false;
        for sound in sounds.iter().filter(|sound| sound.by != Source::Player(listener)) {
            if let Some(strength) = self.strength(world, position, sound) {
                self.hear(sound, position, strength);
                has_heard = true;
            }
        }
        has_faded || has_heard
    }

    /// Refuses what cannot be heard.
    pub(crate) fn check(&self) -> Result<(), Unrestorable> {
        let is_audible = |heard: &Heard| {
            (1..=3).contains(&heard.strength) && (1..=DURATION).contains(&heard.left)
        };
        let is_known = self.sounds.len() == self.heard.len() && self.heard.len() <= MOST;
        check(is_known && self.heard.iter().all(is_audible), "what a player hears")
    }

    /// The number of steps in which no sound fades away; `None` if there is none.
    pub(crate) fn quiet_steps(&self) -> Option<u64> {
        self.heard.iter().map(|heard| u64::from(heard.left.saturating_sub(1))).min()
    }

    /// Advances the clocks by `steps`.
    pub(crate) fn wait(&mut self, steps: u64) {
        self.steps = self.steps.saturating_add(steps);
        let steps = u16::try_from(steps).unwrap_or(u16::MAX);
        self.heard.iter_mut().for_each(|heard| heard.left = heard.left.saturating_sub(steps));
        while let Some(index) = self.heard.iter().position(|heard| heard.left == 0) {
            self.remove(index);
        }
    }

    /// Forgets the distances of sounds, as when the whole map has changed.
    pub(crate) fn forget(&mut self) {
        self.field.forget();
    }

    /// How loud a sound is at `position`, from 1 to 3; `None` if it does not reach there.
    fn strength(&mut self, world: &World, position: DVec2, sound: &Sound) -> Option<u8> {
        let reach = half_cells(sound.reach.min(Sound::FARTHEST));
        let from = sound.cell.center();
        if from.distance(position) > f64::from(sound.reach) * 1.1 + 1.5 {
            return None;
        }
        let cell = Cell::at(position);
        self.field.reach_out(world, cell, reach, self.steps);
        let distance = self.field.distance(sound.cell).filter(|&distance| distance <= reach)?;
        Some(3 - (u32::from(distance) * 3 / (u32::from(reach) + 1)) as u8)
    }

    /// Records a sound. A newer one of the same source and kind replaces an older one, and of those in
    /// one step the nearest is kept.
    fn hear(&mut self, sound: &Sound, position: DVec2, strength: u8) {
        let way = sound.cell.center() - position;
        let degrees = libm::atan2(way.y, way.x).to_degrees();
        let bearing = Heading::from_degrees(degrees).unwrap_or_default();
        let is_same = |other: &Sound| (other.by, other.kind) == (sound.by, sound.kind);
        if let Some(index) = self.sounds.iter().position(is_same) {
            let is_new = self.heard[index].left == DURATION;
            let distance = self.sounds[index].cell.center().distance(position);
            if is_new && distance <= way.length() {
                return;
            }
            self.remove(index);
        } else if self.heard.len() == MOST {
            self.remove(0);
        }
        self.sounds.push(*sound);
        self.heard.push(Heard { bearing, strength, kind: sound.kind, left: DURATION });
    }

    fn remove(&mut self, index: usize) {
        self.heard.remove(index);
        self.sounds.remove(index);
    }
}
