//! Turning and looking up and down: for as long as a key is held, or by an exact angle.
//!
//! An exact turn is a whole number of steps of the same angle. It is independent of the turning
//! motion that begins and ends smoothly. However the two are mixed, their angles add up.
//!
//! The pitch never returns by itself, because the player may want to walk around something while
//! looking up at it. The key to look ahead returns it fully, even after a single tap.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::intent::{Intent, Intents};
use super::rules::STEP;
use super::stored::{RestoreError, check};
use crate::numeric::damped_motion::{DampedMotion, approach};
use crate::world::Pitch;

/// Radians per second.
const TURN: f64 = 2.4;
/// Radians per second while aiming: 10 steps are 5 degrees.
const AIM: f64 = PI / 6.0;
/// The rate at which a turn begins and ends, per second.
pub(crate) const FRICTION: f64 = 20.0;
/// Below this speed the player does not turn, in radians per second.
const STILL: f64 = 1e-4;

/// The number of steps of an exact turn by 5 degrees, and the angle of each.
const FINE_STEPS: i32 = 6;
const FINE_ANGLE: f64 = PI / 36.0 / FINE_STEPS as f64;
/// The same for turning around.
const ABOUT_STEPS: u32 = 30;
const ABOUT_ANGLE: f64 = PI / ABOUT_STEPS as f64;
/// The maximum number of exact turns that wait.
const MAX_WAITING: u32 = 72;

/// The exact turns: each press makes one turn.
const EXACT: [Intent; 3] = [Intent::FineLeft, Intent::FineRight, Intent::AboutFace];

#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Turning {
    /// Radians per second, clockwise.
    speed: f64,
    /// The remaining steps of turns by 5 degrees, clockwise.
    fine: i32,
    /// The remaining steps of turning around.
    about: u32,
    /// The exact turns in the intents of the last step.
    wanted: Intents,
}

impl Turning {
    /// The state after one step, and the angle of that step in radians, clockwise.
    #[must_use]
    pub(crate) fn after_a_step(self, intents: Intents) -> (Self, f64) {
        let speed = if intents.contains(Intent::Aim) { AIM } else { TURN };
        let target = speed * intents.balance(Intent::TurnRight, Intent::TurnLeft);
        let DampedMotion { velocity, displacement } = approach(self.speed, target, FRICTION, STEP);
        let speed = if velocity.abs() < STILL { 0.0 } else { velocity };
        let (turning, angle) = Self { speed, ..self }.wanting(intents).after_an_exact_step();
        (turning, displacement + angle)
    }

    /// Returns an error if more exact turns wait than are allowed.
    pub(crate) fn check(self) -> Result<(), RestoreError> {
        let is_possible = self.fine.unsigned_abs() <= FINE_STEPS.unsigned_abs() * MAX_WAITING
            && self.about <= ABOUT_STEPS * MAX_WAITING;
        check(is_possible, "a turn")
    }

    fn wanting(self, intents: Intents) -> Self {
        let wanted: Intents = EXACT.into_iter().filter(|&turn| intents.contains(turn)).collect();
        let news: Intents = wanted.iter().filter(|&turn| !self.wanted.contains(turn)).collect();
        let most = FINE_STEPS * MAX_WAITING as i32;
        let fine = news.balance(Intent::FineRight, Intent::FineLeft) as i32 * FINE_STEPS;
        let about = if news.contains(Intent::AboutFace) { ABOUT_STEPS } else { 0 };
        Self {
            fine: (self.fine + fine).clamp(-most, most),
            about: (self.about + about).min(ABOUT_STEPS * MAX_WAITING),
            wanted,
            ..self
        }
    }

    fn after_an_exact_step(self) -> (Self, f64) {
        let fine = self.fine.signum();
        let about = self.about.min(1);
        let angle = f64::from(fine) * FINE_ANGLE + f64::from(about) * ABOUT_ANGLE;
        (Self { fine: self.fine - fine, about: self.about - about, ..self }, angle)
    }
}

/// The rate of change of the pitch, as a slope per second, and the rate while aiming.
const TILT: f64 = 0.8;
const TILT_AIM: f64 = 0.2;
/// The rate at which the pitch returns to straight ahead, per second.
const RETURN: f64 = 10.0;
/// Smaller values count as zero, as a slope or a slope per second: they are less than a row of
/// pixels.
const LEVEL_STILL: f64 = 1e-3;

#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct PitchControl {
    pub(crate) pitch: Pitch,
    /// Slope per second, upwards.
    speed: f64,
    returns: bool,
}

impl PitchControl {
    /// The pitch after one step.
    #[must_use]
    pub(crate) fn after_a_step(self, intents: Intents) -> Self {
        let upwards = intents.balance(Intent::LookUp, Intent::LookDown);
        let tilt = intents.look().tilt_radians();
        let returns =
            upwards == 0.0 && tilt == 0.0 && (self.returns || intents.contains(Intent::LookAhead));
        if returns {
            return Self { returns, ..self }.returned();
        }
        let target = upwards * if intents.contains(Intent::Aim) { TILT_AIM } else { TILT };
        let DampedMotion { velocity, displacement } = approach(self.speed, target, FRICTION, STEP);
        let pitch = self.pitch.tilted(displacement + tilt);
        let is_still = velocity.abs() < LEVEL_STILL || pitch == self.pitch;
        Self { pitch, speed: if is_still { 0.0 } else { velocity }, returns }
    }

    fn returned(self) -> Self {
        let slope = approach(self.pitch.slope(), 0.0, RETURN, STEP).velocity;
        if slope.abs() < LEVEL_STILL {
            return Self::default();
        }
        Self { pitch: Pitch::LEVEL.tilted(slope), speed: 0.0, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::game::Look;

    /// The angle after `steps` steps, in degrees.
    fn degrees(turning: &mut Turning, steps: usize, intents: &[Intent]) -> f64 {
        let intents = intents.iter().copied().collect();
        let mut sum = 0.0;
        for _ in 0..steps {
            let (after, angle) = turning.after_a_step(intents);
            *turning = after;
            sum += angle;
        }
        sum.to_degrees()
    }

    #[test]
    fn exact_turns_add_up_whatever_else_turns() {
        use Intent::{AboutFace, Aim, FineLeft, FineRight, TurnRight};
        for (wants, expected) in [
            (&[FineRight][..], 5.0),
            (&[FineLeft], -5.0),
            (&[AboutFace], 180.0),
            (&[FineLeft, FineRight], 0.0),
            (&[FineRight, AboutFace], 185.0),
        ] {
            let mut turning = Turning::default();
            // It is one turn, however long the key is held.
            let turned = degrees(&mut turning, 90, wants);
            assert!((turned - expected).abs() < 1e-9, "{wants:?}: {turned}");
            // The same turn again, and once more before the first has ended.
            let twice = [&[][..], wants, &[], wants].map(|wants| degrees(&mut turning, 1, wants));
            let twice = twice.iter().sum::<f64>() + degrees(&mut turning, 90, &[]);
            assert!((twice - 2.0 * expected).abs() < 1e-9, "{wants:?}: {twice}");
            assert_eq!(turning, Turning::default());
        }
        let mut turning = Turning::default();
        let mixed = degrees(&mut turning, 10, &[TurnRight, Aim, FineRight]);
        let mixed = mixed + degrees(&mut turning, 90, &[]);
        assert!((mixed - 10.0).abs() < 1e-3, "{mixed}");
    }

    #[test]
    fn ten_steps_of_aiming_turn_five_degrees() {
        for (way, sign) in [(Intent::TurnRight, 1.0), (Intent::TurnLeft, -1.0)] {
            let mut turning = Turning::default();
            let turned = degrees(&mut turning, 10, &[way, Intent::Aim]);
            let turned = turned + degrees(&mut turning, 90, &[]);
            assert!((turned - sign * 5.0).abs() < 1e-3, "{turned}");
        }
    }

    fn after(pitch_control: PitchControl, steps: usize, intents: &[Intent]) -> PitchControl {
        let intents = intents.iter().copied().collect();
        (0..steps).fold(pitch_control, |pitch_control, _| pitch_control.after_a_step(intents))
    }

    #[test]
    fn pitch_stops_at_its_limit_and_comes_to_rest() {
        let up = after(PitchControl::default(), 600, &[Intent::LookUp]);
        assert_eq!(up.pitch, Pitch::from_degrees(Pitch::MAX_DEGREES).unwrap());
        assert_eq!(after(up, 1, &[Intent::LookUp]), up);
        assert_eq!(after(up, 600, &[]), up);
        assert_eq!(after(up, 600, &[Intent::LookUp, Intent::LookDown]), up);
        let down = after(up, 600, &[Intent::LookDown]);
        assert_eq!(down.pitch.slope(), -up.pitch.slope());
    }

    #[test]
    fn a_tap_levels_the_view_unless_the_player_looks_elsewhere() {
        let up = after(PitchControl::default(), 40, &[Intent::LookUp]);
        let returning = after(up, 1, &[Intent::LookAhead]);
        assert_eq!(after(returning, 120, &[]), PitchControl::default());
        let tilted = returning.after_a_step(Intents::new().with_look(Look { turn: 0, tilt: 50 }));
        assert!(after(tilted, 120, &[]).pitch.slope() > 0.0);
        let elsewhere = after(returning, 10, &[Intent::LookUp]);
        assert!(after(elsewhere, 120, &[]).pitch.slope() > 0.0);
    }
}
