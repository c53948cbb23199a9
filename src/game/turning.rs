//! How the player turns: for as long as they want, or by an exact angle.
//!
//! An exact turn is a whole number of steps that each turn by the same angle, and takes no part of the
//! motion that begins and ends smoothly: however the two are mixed, their angles add up.

use std::f64::consts::PI;

use super::STEP;
use super::intent::{Intent, Intents};
use crate::numeric::damped_motion::{DampedMotion, approach};

/// Radians per second.
const TURN: f64 = 2.4;
/// Radians per second, for who aims: 10 steps are 5 degrees.
const AIM: f64 = PI / 6.0;
/// How fast a turn begins and ends, per second.
pub(super) const FRICTION: f64 = 20.0;
/// What is slower stands still, in radians per second.
const STILL: f64 = 1e-4;

/// In how many steps an exact turn of 5 degrees is made, and by how much each of them turns.
const FINE_STEPS: i32 = 6;
const FINE_ANGLE: f64 = PI / 36.0 / FINE_STEPS as f64;
/// The same, for who turns around.
const ABOUT_STEPS: u32 = 30;
const ABOUT_ANGLE: f64 = PI / ABOUT_STEPS as f64;
/// How many exact turns wait for one another, at most.
const MOST_WAITING: u32 = 72;

/// Each wish for one of these is for one turn.
const EXACT: [Intent; 3] = [Intent::FineLeft, Intent::FineRight, Intent::AboutFace];

#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(super) struct Turning {
    /// Radians per second, clockwise.
    speed: f64,
    /// Steps that are left of turns by 5 degrees, clockwise.
    fine: i32,
    /// Steps that are left of turning around.
    about: u32,
    /// Which exact turns were wanted in the last step.
    wanted: Intents,
}

impl Turning {
    /// The turning one step later, and by how many radians, clockwise, the step has turned.
    #[must_use]
    pub(super) fn after_a_step(self, intents: Intents) -> (Self, f64) {
        let speed = if intents.contains(Intent::Aim) { AIM } else { TURN };
        let target = speed * intents.balance(Intent::TurnRight, Intent::TurnLeft);
        let DampedMotion { velocity, displacement } = approach(self.speed, target, FRICTION, STEP);
        let speed = if velocity.abs() < STILL { 0.0 } else { velocity };
        let (turning, angle) = Self { speed, ..self }.wanting(intents).after_an_exact_step();
        (turning, displacement + angle)
    }

    fn wanting(self, intents: Intents) -> Self {
        let wanted: Intents = EXACT.into_iter().filter(|&turn| intents.contains(turn)).collect();
        let news: Intents = wanted.iter().filter(|&turn| !self.wanted.contains(turn)).collect();
        let most = FINE_STEPS * MOST_WAITING as i32;
        let fine = news.balance(Intent::FineRight, Intent::FineLeft) as i32 * FINE_STEPS;
        let about = if news.contains(Intent::AboutFace) { ABOUT_STEPS } else { 0 };
        Self {
            fine: (self.fine + fine).clamp(-most, most),
            about: (self.about + about).min(ABOUT_STEPS * MOST_WAITING),
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

#[cfg(test)]
mod tests {
    use super::*;

    /// By how many degrees `steps` steps turn.
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
            // However long it is wanted, it is one turn.
            let turned = degrees(&mut turning, 90, wants);
            assert!((turned - expected).abs() < 1e-9, "{wants:?}: {turned}");
            // Once more, and again before that is over.
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
    fn ten_steps_of_aiming_are_five_degrees() {
        for (way, sign) in [(Intent::TurnRight, 1.0), (Intent::TurnLeft, -1.0)] {
            let mut turning = Turning::default();
            let turned = degrees(&mut turning, 10, &[way, Intent::Aim]);
            let turned = turned + degrees(&mut turning, 90, &[]);
            assert!((turned - sign * 5.0).abs() < 1e-3, "{turned}");
        }
    }
}
