//! Hazards: falls, cold water and spikes, and their effects on a player.
//!
//! - A fall of more than [`SAFE_FALL`] cells takes a point for each further cell or part of a cell,
//!   except on the easiest difficulty.
//! - Water slows the player, splashes and puts out the lamp. It takes a point every [`COLD`] steps,
//!   but none after the first [`COLD`] steps.
//! - Spikes are heard half a second before they come out, and hurt once for each thrust.
//! - A blow from outside the view does not kill without a [warning](super::health). The view is the
//!   default field of view, whatever the player has chosen, because a game does not depend on how
//!   it is shown.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::Game;
use super::health::{Cause, Flash, Harm};
use super::noise::reach;
use super::player::Motion;
use super::sound::{Sound, SoundKind, Source};
use super::stored::{OfLevel, RestoreError};
use crate::world::sprite::builtin::SpikesFrame;
use crate::world::{Cell, Difficulty, Heading, Rhythm, ThingKind, TileEffect, World};

/// The highest fall that does not hurt, in cells.
const SAFE_FALL: f64 = 2.2;
/// The number of steps in which water takes a point: 4 seconds.
const COLD: u32 = 240;
/// The number of points that spikes take.
const SPIKES: u8 = 2;
/// The cosine of the angle from the middle of the view to its edge, 33°.
const VIEW: f64 = 0.838_670_567_945_424;

impl Game {
    /// Applies the hazards of the floor to the player in this step, which began at `before`.
    pub(crate) fn meet_hazards(&mut self, before: &Motion) {
        self.fall();
        if self.is_mission {
            self.wade(before);
            self.step_on_spikes();
        }
    }

    /// Tracks a fall, and applies the landing.
    fn fall(&mut self) {
        let motion = self.player.motion;
        if !motion.stands(&self.world) {
            self.player.fell_from = self.player.fell_from.max(motion.feet());
            return;
        }
        let cells = self.player.fell_from - motion.feet();
        self.player.fell_from = motion.feet();
        if !self.is_mission {
            return;
        }
        self.hear_landing(cells);
        let is_soft = self.world.effect_in(motion.cell()) == Some(TileEffect::Water);
        if cells > SAFE_FALL && !is_soft && self.rules.difficulty > Difficulty::Easy {
            let points = (cells - SAFE_FALL).ceil().min(255.0) as u8;
            self.hurt(Harm { points, bearing: None, spares: false, cause: Cause::Fall });
        }
    }

    fn wade(&mut self, before: &Motion) {
        if !self.is_in_water() {
            self.player.in_water = 0;
            return;
        }
        if self.player.in_water == 0 {
            if before.cell() != self.player.motion.cell() || !before.is_still() {
                self.sound(SoundKind::Splash, reach::SPLASH);
            }
            if self.player.has_light {
                self.player.has_light = false;
                self.say("The water puts your lamp out.".to_owned());
            }
        }
        self.player.in_water = self.player.in_water.saturating_add(1);
        if is_cold_after(self.player.in_water) {
            self.say("The water is cold.".to_owned());
            self.hurt(Harm { points: 1, bearing: None, spares: false, cause: Cause::Water });
        }
    }

    fn step_on_spikes(&mut self) {
        *self.work += self.spikes.count() as u64;
        let Self { spikes, world, sounds, steps, .. } = self;
        if spikes.show(world, *steps, sounds) {
            self.revision += 1;
        }
        let motion = self.player.motion;
        let thrust = self.spikes.thrust_in(motion.cell(), self.steps);
        let is_touched = motion.feet() < self.world.floor_at(motion.cell()) + SPIKES_HEIGHT;
        if thrust.is_some() && is_touched && thrust != self.player.last_thrust {
            self.player.last_thrust = thrust;
            self.hurt(Harm { points: SPIKES, bearing: None, spares: false, cause: Cause::Spikes });
        }
    }

    /// Applies a hit on the player by the guard `by`, who attacks from `from`.
    pub(crate) fn hurt_by_guard(&mut self, by: usize, from: DVec2, points: u8) {
        let kind = self.guards.views().nth(by).map(|guard| guard.kind);
        if let Some(kind) = kind {
            self.hurt_from(by, from, points, Cause::Guard(kind));
        }
    }

    /// Applies a hit by a bolt that the guard `by` has shot from `from`.
    pub(crate) fn hurt_by_bolt(&mut self, by: usize, from: DVec2, points: u8) {
        self.hurt_from(by, from, points, Cause::Bolt);
    }

    fn hurt_from(&mut self, by: usize, from: DVec2, points: u8, cause: Cause) {
        let motion = self.player.motion;
        let way = from - motion.position();
        let degrees = libm::atan2(way.y, way.x).to_degrees();
        let is_in_view = motion.heading().direction().dot(way) >= VIEW * way.length();
        let bearing = Heading::from_degrees(degrees);
        let harm = Harm { points, bearing, spares: false, cause };
        let kills = self.player.health.after(&harm).is_gone() && !self.player.health.is_gone();
        let warns = kills && !is_in_view;
        let grace = if warns { self.player.warnings.spare(by, self.steps) } else { None };
        self.hurt(Harm { spares: grace.is_some(), ..harm });
        if let Some(left) = grace {
            self.player.flash = Some(Flash::warning(&harm, left));
            self.say("A blow from outside your view! The next one may kill.".to_owned());
        }
        self.sound_in(motion.cell(), SoundKind::Cry, reach::BLOW);
    }

    fn hurt(&mut self, harm: Harm) {
        if self.player.health.is_gone() {
            return;
        }
        self.player.health = self.player.health.after(&harm);
        self.player.flash = Some(Flash::hurt(&harm));
        self.revision += 1;
        if self.player.health.is_gone() {
            self.player.counts.deaths += 1;
            self.player.killed_by = Some(harm.cause);
            self.say(format!("Killed by {}.", harm.cause.name()));
        }
    }
}

/// Whether water hurts in that step of wading.
fn is_cold_after(steps: u32) -> bool {
    steps >= 2 * COLD && steps.is_multiple_of(COLD)
}

/// The number of steps for which spikes rise, which serves as a warning, and for which they are
/// out.
const WARNING: u64 = 30;
const OUT: u64 = 24;
/// The height of spikes that are out, in cells.
const SPIKES_HEIGHT: f64 = 0.4;

/// All spikes of a level.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Spikes {
    /// In the order of the world's things.
    each: Vec<Spike>,
}

impl OfLevel for Spikes {
    fn of_level(self, start: Self) -> Result<Self, RestoreError> {
        Ok(Self { each: self.each.of_level(start.each)? })
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Spike {
    cell: Cell,
    rhythm: Rhythm,
    /// The phase that the spikes show.
    phase: SpikePosition,
}

impl OfLevel for Spike {
    fn of_level(self, start: Self) -> Result<Self, RestoreError> {
        Ok(Self { phase: self.phase, ..start })
    }
}

/// The position of spikes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum SpikePosition {
    In,
    Rising,
    Out,
}

impl Spikes {
    /// The spikes of `world`, which show that they are in.
    pub(crate) fn new(world: &mut World) -> Self {
        let each: Vec<Spike> = world
            .things()
            .iter()
            .filter_map(|thing| match thing.kind {
                ThingKind::Spikes(rhythm) => {
                    Some(Spike { cell: thing.cell, rhythm, phase: SpikePosition::In })
                }
                _ => None,
            })
            .collect();
        for spike in &each {
            spike.show(world);
        }
        Self { each }
    }

    /// The number of spikes.
    pub(crate) fn count(&self) -> usize {
        self.each.len()
    }

    /// Shows the spikes as they are in the step `now`, and adds a sound for spikes that begin to
    /// rise. Returns whether any has changed.
    pub(crate) fn show(&mut self, world: &mut World, now: u64, sounds: &mut Vec<Sound>) -> bool {
        let mut has_changed = false;
        for spike in &mut self.each {
            let phase = spike.rhythm.phase(now);
            if phase != spike.phase {
                spike.phase = phase;
                spike.show(world);
                sounds.extend((phase == SpikePosition::Rising).then(|| spike.warning()));
                has_changed = true;
            }
        }
        has_changed
    }

    /// The step in which the current thrust of the spikes in `cell` began; `None` if no spikes are
    /// out in the step `now`.
    fn thrust_in(&self, cell: Cell, now: u64) -> Option<u64> {
        let spike = self.each.iter().find(|spike| spike.cell == cell)?;
        (spike.rhythm.phase(now) == SpikePosition::Out).then(|| now - spike.rhythm.age(now))
    }
}

impl Spike {
    /// The sound before the spikes come out.
    fn warning(&self) -> Sound {
        let (kind, by) = (SoundKind::Spikes, Source::Object);
        Sound { kind, cell: self.cell, reach: reach::SPIKES, by }
    }

    fn show(&self, world: &mut World) {
        let is_it = |kind| matches!(kind, ThingKind::Spikes(_));
        let frame = match self.phase {
            SpikePosition::In => SpikesFrame::In,
            SpikePosition::Rising => SpikesFrame::Rising,
            SpikePosition::Out => SpikesFrame::Out,
        };
        world.set_frame(self.cell, is_it, frame.index());
    }
}

impl Rhythm {
    /// The number of steps since the spikes last came out, as if they had always done so.
    fn age(self, now: u64) -> u64 {
        let (period, delay) = (u64::from(self.period), u64::from(self.delay));
        (now + period - delay % period) % period
    }

    fn phase(self, now: u64) -> SpikePosition {
        let period = u64::from(self.period);
        let is_before = now < u64::from(self.delay);
        match self.age(now) {
            age if age < OUT && !is_before => SpikePosition::Out,
            age if age + WARNING >= period => SpikePosition::Rising,
            _ => SpikePosition::In,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn spikes_warn_before_they_come_out(
            period in 60..=3600_u16,
            delay in 0..3600_u16,
            now in 3600..9000_u64,
        ) {
            let rhythm = Rhythm { period, delay: delay % period };
            let thrust = now + u64::from(period) - rhythm.age(now);
            prop_assert!((1..=WARNING).all(|step| rhythm.phase(thrust - step) == SpikePosition::Rising));
            prop_assert!(rhythm.phase(thrust - WARNING - 1) != SpikePosition::Rising);
            prop_assert!((0..OUT).all(|step| rhythm.phase(thrust + step) == SpikePosition::Out));
            prop_assert!(rhythm.phase(thrust + OUT) != SpikePosition::Out);
        }

        #[test]
        fn spikes_first_come_out_after_their_delay(period in 60..=3600_u16, delay in 0..3600_u16) {
            let rhythm = Rhythm { period, delay: delay % period };
            let first = (0..7200).find(|&step| rhythm.phase(step) == SpikePosition::Out);
            prop_assert_eq!(first, Some(u64::from(rhythm.delay)));
        }
    }
}
