//! Stance: the current height of the player's body, and of the eye above the feet.
//!
//! The eye follows the feet smoothly over steps: it lags by the height of the step and catches up.
//! The body, which collides with ceilings, moves with the feet.

use serde::{Deserialize, Serialize};

use super::rules::STEP;
use super::stored::{RestoreError, check};
use crate::numeric::damped_motion::approach;
use crate::world::Camera;

/// The height of the body, standing and ducking, in cells.
const STANDING: f64 = 0.7;
pub(crate) const DUCKING: f64 = 0.5;
/// The height of the eye above the feet when ducking, in cells.
const EYE_DUCKING: f64 = 0.3;
/// The minimum room above the eye, in cells.
const FOREHEAD: f64 = 0.05;

/// The rate at which the player ducks and stands up, per second.
const SUPPLENESS: f64 = 14.0;
/// The rate at which the eye follows the feet, per second.
const FOLLOWING: f64 = 14.0;
/// Smaller differences count as zero, in cells.
const STILL: f64 = 1e-4;

#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Stance {
    /// From 0 for standing to 1 for ducking.
    ducking: f64,
    /// The height of the eye above its final position, in cells.
    lag: f64,
}

impl Stance {
    /// Returns an error if the body is neither standing, ducking nor in between.
    pub(crate) fn check(self) -> Result<(), RestoreError> {
        check((0.0..=1.0).contains(&self.ducking), "a stance")
    }

    /// The height of the body, in cells.
    pub(crate) fn height(self) -> f64 {
        STANDING + (DUCKING - STANDING) * self.ducking
    }

    /// Whether the body is nearer to ducking than to standing upright.
    pub(crate) fn is_ducking(self) -> bool {
        self.ducking > 0.5
    }

    /// The height of the eye above the feet, in cells, under a ceiling that is `headroom` above the
    /// feet.
    pub(crate) fn eye(self, headroom: f64) -> f64 {
        let eye = Camera::STANDING + (EYE_DUCKING - Camera::STANDING) * self.ducking + self.lag;
        eye.min(headroom - FOREHEAD).max(FOREHEAD)
    }

    /// The stance after one step of ducking or standing up.
    #[must_use]
    pub(crate) fn after_a_step(self, wants_to_duck: bool) -> Self {
        let target = f64::from(u8::from(wants_to_duck));
        let ducking = approach(self.ducking, target, SUPPLENESS, STEP).velocity;
        let is_there = (ducking - target).abs() < STILL;
        Self { ducking: if is_there { target } else { ducking }, ..self }
    }

    /// The stance after a step in which the feet have risen by `climbed` cells, or fallen if it is
    /// negative.
    #[must_use]
    pub(crate) fn following(self, climbed: f64) -> Self {
        let lag = approach(self.lag - climbed, 0.0, FOLLOWING, STEP).velocity;
        let lag = if lag.abs() < STILL { 0.0 } else { lag };
        Self { lag, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ducking_lowers_the_player_and_standing_up_raises_them_again() {
        let after =
            |stance: Stance, ducks| (0..60).fold(stance, |stance, _| stance.after_a_step(ducks));
        let small = after(Stance::default(), true);
        assert_eq!(small, Stance { ducking: 1.0, lag: 0.0 });
        assert_eq!(after(small, false), Stance::default());
        assert!(small.height() < 0.6 && small.eye(f64::INFINITY) < small.height());
    }

    #[test]
    fn the_eye_stays_between_floor_and_ceiling() {
        for climbed in [-1e9, -0.3, 0.0, 0.3, 1e9] {
            let eye = Stance::default().following(climbed).eye(0.7);
            assert!(0.0 < eye && eye < 0.7, "{eye}");
        }
        assert_eq!(Stance::default().eye(1.0), Camera::STANDING);
    }
}
