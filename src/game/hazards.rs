//! Hazards: falls, cold water and spikes, and what happens to a player who is hurt.
//!
//! - A fall of more than [`SAFE_FALL`] cells takes a point for each further cell or part of one,
//!   except in the easiest game.
//! - Water slows, splashes and puts out the lamp. It takes a point each [`COLD`] steps, from the
//!   second time on.
//! - Spikes are heard half a second before they come out, and hurt once for each time.
//! - A blow from outside the view does not kill before it has [warned](super::health). The view
//!   is that of the default field of view, whatever the player has chosen: a game does not depend on
//!   how it is shown.

mod spikes;

use glam::DVec2;

use super::Game;
use super::health::{Cause, Flash, Harm};
use super::noise::reach;
use super::player::Motion;
use super::sound::SoundKind;
use crate::world::{Difficulty, Heading, TileEffect};
pub(crate) use spikes::Spikes;

/// The highest fall that does not hurt, in cells.
const SAFE_FALL: f64 = 2.2;
/// The steps in which water takes a point: 4 seconds.
const COLD: u32 = 240;
/// The points that spikes take.
const SPIKES: u8 = 2;
/// The cosine of the angle from the middle of the view to its edge, 33°.
const VIEW: f64 = 0.838_670_567_945_424;

impl Game {
    /// What the floor does to the player in this step, which began at `before`.
    pub(crate) fn meet_hazards(&mut self, before: &Motion) {
        self.fall();
        if self.is_mission {
            self.wade(before);
            self.step_on_spikes();
        }
    }

    /// The landing after a fall.
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

    /// The number of steps in water in which it does not hurt; `None` outside water.
    pub(crate) fn quiet_steps_in_water(&self) -> Option<u64> {
        let steps = self.player.in_water;
        let next = COLD * 2.max(steps / COLD + 1);
        (self.is_mission && self.is_in_water()).then(|| u64::from(next - steps - 1))
    }

    fn step_on_spikes(&mut self) {
        *self.work += self.spikes.count() as u64;
        let Self { spikes, world, sounds, steps, .. } = self;
        if spikes.show(world, *steps, sounds) {
            self.revision += 1;
        }
        let motion = self.player.motion;
        let thrust = self.spikes.thrust_in(motion.cell(), self.steps);
        let is_touched = motion.feet() < self.world.floor_at(motion.cell()) + spikes::HEIGHT;
        if thrust.is_some() && is_touched && thrust != self.player.last_thrust {
            self.player.last_thrust = thrust;
            self.hurt(Harm { points: SPIKES, bearing: None, spares: false, cause: Cause::Spikes });
        }
    }

    /// The guard `by` hits the player from `from`.
    pub(crate) fn hurt_by_guard(&mut self, by: usize, from: DVec2, points: u8) {
        let kind = self.guards.views().nth(by).map(|guard| guard.kind);
        if let Some(kind) = kind {
            self.hurt_from(by, from, points, Cause::Guard(kind));
        }
    }

    /// A bolt hits the player that the guard `by` has shot at `from`.
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
