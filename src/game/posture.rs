//! How tall the player is just now, and how high their eye is above their feet.
//!
//! The eye follows the feet smoothly over steps: it lags behind by what they climb, and catches up.
//! What is tall enough to bump a head, though, is the body, and that is where the feet are.

use super::STEP;
use crate::numeric::damped_motion::approach;
use crate::world::Camera;

/// How tall somebody is, standing and ducking, in cells.
const STANDING: f64 = 0.7;
pub(super) const DUCKING: f64 = 0.5;
/// How high the eye of somebody is who ducks, in cells above the feet.
const EYE_DUCKING: f64 = 0.3;
/// How much room there always is above the eye, in cells.
const FOREHEAD: f64 = 0.05;

/// How fast somebody ducks and rises, per second.
const SUPPLENESS: f64 = 14.0;
/// How fast the eye follows the feet, per second.
const FOLLOWING: f64 = 14.0;
/// What is less is nothing, in cells.
const STILL: f64 = 1e-4;

#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(super) struct Posture {
    /// From 0 for upright to 1 for as small as can be.
    ducking: f64,
    /// By how much the eye is higher than it will be, in cells.
    lag: f64,
}

impl Posture {
    /// How tall the body is, in cells.
    pub(super) fn height(self) -> f64 {
        STANDING + (DUCKING - STANDING) * self.ducking
    }

    /// How high the eye is above the feet, in cells, under a ceiling that is so high above them.
    pub(super) fn eye(self, headroom: f64) -> f64 {
        let eye = Camera::STANDING + (EYE_DUCKING - Camera::STANDING) * self.ducking + self.lag;
        eye.min(headroom - FOREHEAD).max(FOREHEAD)
    }

    /// The posture one step later of who wants to duck, or to stand.
    #[must_use]
    pub(super) fn after_a_step(self, wants_to_duck: bool) -> Self {
        let target = f64::from(u8::from(wants_to_duck));
        let ducking = approach(self.ducking, target, SUPPLENESS, STEP).velocity;
        let is_there = (ducking - target).abs() < STILL;
        Self { ducking: if is_there { target } else { ducking }, ..self }
    }

    /// The posture one step later of whose feet have gone up a step by `climbed` cells, or down where
    /// that is negative.
    #[must_use]
    pub(super) fn following(self, climbed: f64) -> Self {
        let lag = approach(self.lag - climbed, 0.0, FOLLOWING, STEP).velocity;
        let lag = if lag.abs() < STILL { 0.0 } else { lag };
        Self { lag, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_ducks_gets_small_and_who_stands_up_tall_again() {
        let after = |posture: Posture, ducks| {
            (0..60).fold(posture, |posture, _| posture.after_a_step(ducks))
        };
        let small = after(Posture::default(), true);
        assert_eq!(small, Posture { ducking: 1.0, lag: 0.0 });
        assert_eq!(after(small, false), Posture::default());
        assert!(small.height() < 0.6 && small.eye(f64::INFINITY) < small.height());
    }

    #[test]
    fn an_eye_is_between_floor_and_ceiling() {
        for climbed in [-1e9, -0.3, 0.0, 0.3, 1e9] {
            let eye = Posture::default().following(climbed).eye(0.7);
            assert!(0.0 < eye && eye < 0.7, "{eye}");
        }
        assert_eq!(Posture::default().eye(1.0), Camera::STANDING);
    }
}
