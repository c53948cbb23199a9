//! Pitch control: looking up and down.
//!
//! The pitch never returns by itself, since the player may want to walk around something that they
//! look up at. A key to look ahead returns it fully, even if it is only tapped.

use serde::{Deserialize, Serialize};

use super::STEP;
use super::intent::{Intent, Intents};
use crate::numeric::damped_motion::{DampedMotion, approach};
use crate::world::Pitch;

/// How fast the pitch changes, as a slope per second; and while aiming.
const LOOK: f64 = 0.8;
const AIM: f64 = 0.2;
/// How fast such a motion begins and ends, per second.
const FRICTION: f64 = 20.0;
/// How fast it returns to straight ahead, per second.
const RETURN: f64 = 10.0;
/// Less than this is nothing, as a slope or a slope per second: it is less than a row of pixels.
const STILL: f64 = 1e-3;

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
        let target = upwards * if intents.contains(Intent::Aim) { AIM } else { LOOK };
        let DampedMotion { velocity, displacement } = approach(self.speed, target, FRICTION, STEP);
        let pitch = self.pitch.tilted(displacement + tilt);
        let is_still = velocity.abs() < STILL || pitch == self.pitch;
        Self { pitch, speed: if is_still { 0.0 } else { velocity }, returns }
    }

    fn returned(self) -> Self {
        let slope = approach(self.pitch.slope(), 0.0, RETURN, STEP).velocity;
        if slope.abs() < STILL {
            return Self::default();
        }
        Self { pitch: Pitch::LEVEL.tilted(slope), speed: 0.0, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::game::Look;

    fn after(pitch_control: PitchControl, steps: usize, intents: &[Intent]) -> PitchControl {
        let intents = intents.iter().copied().collect();
        (0..steps).fold(pitch_control, |pitch_control, _| pitch_control.after_a_step(intents))
    }

    #[test]
    fn it_goes_as_far_as_it_goes_and_comes_to_rest() {
        let up = after(PitchControl::default(), 600, &[Intent::LookUp]);
        assert_eq!(up.pitch, Pitch::from_degrees(Pitch::MOST_DEGREES).unwrap());
        assert_eq!(after(up, 1, &[Intent::LookUp]), up);
        assert_eq!(after(up, 600, &[]), up);
        assert_eq!(after(up, 600, &[Intent::LookUp, Intent::LookDown]), up);
        let down = after(up, 600, &[Intent::LookDown]);
        assert_eq!(down.pitch.slope(), -up.pitch.slope());
    }

    #[test]
    fn a_tap_takes_it_back_unless_one_looks_elsewhere() {
        let up = after(PitchControl::default(), 40, &[Intent::LookUp]);
        let returning = after(up, 1, &[Intent::LookAhead]);
        assert_eq!(after(returning, 120, &[]), PitchControl::default());
        let tilted = returning.after_a_step(Intents::new().with_look(Look { turn: 0, tilt: 50 }));
        assert!(after(tilted, 120, &[]).pitch.slope() > 0.0);
        let elsewhere = after(returning, 10, &[Intent::LookUp]);
        assert!(after(elsewhere, 120, &[]).pitch.slope() > 0.0);
    }
}
