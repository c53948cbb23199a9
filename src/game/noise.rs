//! Noise: the sounds that players make by moving.
//!
//! Only listeners hear walking, and only nearby. Running is heard from afar. Ducking makes a walk
//! silent, at half the speed. Each footstep is a separate sound, because guards notice events.
//! Rejected: a continuous sound.

use super::Game;
use super::intent::{Intent, Intents};
use super::player::Motion;
use super::sound::{Sound, SoundKind, Source};
use crate::world::{Cell, TileEffect};

/// The reach of sounds over open cells, in cells.
pub(crate) mod reach {
    pub(crate) const WALKING: u8 = 3;
    pub(crate) const RUNNING: u8 = 7;
    pub(crate) const SPLASH: u8 = 6;
    pub(crate) const DOOR: u8 = 6;
    pub(crate) const MECHANISM: u8 = 6;
    pub(crate) const CLICK: u8 = 4;
    pub(crate) const SPIKES: u8 = 5;
    pub(crate) const KNOCK: u8 = 8;
    pub(crate) const TAP: u8 = 4;
    pub(crate) const CRASH: u8 = 6;
    pub(crate) const BLOW: u8 = 3;
    pub(crate) const SWING: u8 = 2;
    /// The reach of a landing from the lowest audible fall, and the increase for each further cell.
    pub(crate) const LANDING: u8 = 4;
    pub(crate) const LANDING_BY_CELL: u8 = 3;
    pub(crate) const MAX_LANDING: u8 = 12;
}

/// The lowest fall with an audible landing, in cells.
const MIN_FALL: f64 = 0.5;
/// The distance between two audible footsteps, in cells.
const WALKING_STRIDE: f64 = 0.8;
const RUNNING_STRIDE: f64 = 1.2;
/// The fraction of the usual speed while ducking, and in water.
const SLOW: f64 = 0.5;

impl Game {
    /// Makes a sound at the player's position.
    pub(crate) fn sound(&mut self, kind: SoundKind, reach: u8) {
        let (cell, by) = (self.player.motion.cell(), Source::Player(self.turn()));
        self.sounds.push(Sound { kind, cell, reach, by });
    }

    /// Makes a sound in `cell` that no player makes.
    pub(crate) fn sound_in(&mut self, cell: Cell, kind: SoundKind, reach: u8) {
        self.sounds.push(Sound { kind, cell, reach, by: Source::Object });
    }

    /// The fraction of the usual speed at which the player walks.
    pub(crate) fn pace(&self) -> f64 {
        if !self.is_mission {
            return 1.0;
        }
        let motion = &self.player.motion;
        let ducking = if motion.is_ducking() { SLOW } else { 1.0 };
        let wading = if self.is_in_water() { SLOW } else { 1.0 };
        ducking * wading
    }

    /// Whether the player stands in water.
    pub(crate) fn is_in_water(&self) -> bool {
        let motion = &self.player.motion;
        self.world.effect_in(motion.cell()) == Some(TileEffect::Water)
            && motion.feet() <= self.world.floor_at(motion.cell())
    }

    /// Makes the sounds of the player's motion in this step, which began at `before`.
    pub(crate) fn hear_steps(&mut self, before: &Motion, intents: Intents) {
        let motion = self.player.motion;
        if motion == *before || !motion.stands(&self.world) {
            return;
        }
        let runs = intents.contains(Intent::Run);
        let stride = if runs { RUNNING_STRIDE } else { WALKING_STRIDE };
        self.player.stride += motion.position().distance(before.position());
        if self.player.stride < stride {
            return;
        }
        self.player.stride = 0.0;
        match (self.is_in_water(), runs, motion.is_ducking()) {
            (true, ..) => self.sound(SoundKind::Splash, reach::SPLASH),
            (_, true, false) => self.sound(SoundKind::Running, reach::RUNNING),
            (_, true, true) | (_, false, false) => self.sound(SoundKind::Walking, reach::WALKING),
            (_, false, true) => {}
        }
    }

    /// Makes the sound of a landing after a fall of `cells` cells.
    pub(crate) fn hear_landing(&mut self, cells: f64) {
        if cells >= MIN_FALL && !self.is_in_water() {
            let more = (cells - MIN_FALL) * f64::from(reach::LANDING_BY_CELL);
            let reach = (f64::from(reach::LANDING) + more).min(reach::MAX_LANDING.into());
            self.sound(SoundKind::Landing, reach as u8);
        }
    }
}
