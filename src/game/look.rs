//! Turning and tilting by an angle rather than for a time, as a pointer does.
//!
//! Angles are whole hundredths of a degree, so that a script stores them without loss and replays
//! them bit for bit. They take effect at once, because a pointer's motion is smooth already.
//! Converting an angle into a time of turning was refused: a step turns by 2.3°, which is coarser
//! than a hand can aim.

use std::fmt;

use serde::{Deserialize, Serialize};

/// The angles by which the player turns and tilts in one step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Look {
    /// Clockwise as seen from above, in hundredths of a degree.
    pub turn: i16,
    /// Upwards, in hundredths of a degree: the horizon in a grid, the eye in a scene of bodies.
    pub tilt: i16,
}

/// The names of both in files.
pub(crate) const TURN: &str = "turn";
pub(crate) const TILT: &str = "tilt";

impl Look {
    /// No turn and no tilt.
    pub const NONE: Self = Self { turn: 0, tilt: 0 };

    /// Units in a degree.
    pub const PER_DEGREE: i16 = 100;

    /// Clockwise, in radians.
    pub(crate) fn turn_radians(self) -> f64 {
        radians(self.turn)
    }

    /// Upwards, in radians.
    pub(crate) fn tilt_radians(self) -> f64 {
        radians(self.tilt)
    }

    /// The words of a script for it: none, one or two.
    pub(crate) fn words(self) -> impl Iterator<Item = String> {
        let amounts = [(TURN, self.turn), (TILT, self.tilt)];
        let amounts = amounts.into_iter().filter(|&(_, amount)| amount != 0);
        amounts.map(|(name, amount)| format!("{name}:{}", Degrees(amount)))
    }
}

fn radians(hundredths: i16) -> f64 {
    (f64::from(hundredths) / f64::from(Look::PER_DEGREE)).to_radians()
}

/// Hundredths of a degree, written in degrees with the necessary digits.
struct Degrees(i16);

impl fmt::Display for Degrees {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", f64::from(self.0) / f64::from(Look::PER_DEGREE))
    }
}

/// The hundredths of a degree that `text` gives in degrees; `None` if it is not a number, is not a
/// whole number of hundredths, is 0 or is too large.
pub(crate) fn hundredths(text: &str) -> Option<i16> {
    let degrees: f64 = text.parse().ok()?;
    let hundredths = (degrees * f64::from(Look::PER_DEGREE)).round();
    let is_whole = hundredths / f64::from(Look::PER_DEGREE) == degrees;
    let is_some = hundredths != 0.0 && hundredths.abs() <= f64::from(i16::MAX);
    (is_whole && is_some).then_some(hundredths as i16)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_amount_is_read_as_it_is_written() {
        for amount in i16::MIN + 1..=i16::MAX {
            let read = (amount != 0).then_some(amount);
            assert_eq!(hundredths(&Degrees(amount).to_string()), read);
        }
        assert_eq!(Degrees(-325).to_string(), "-3.25");
        assert_eq!(Degrees(100).to_string(), "1");
    }

    #[test]
    fn what_is_no_amount_is_refused() {
        for text in ["", "x", "nan", "inf", "0", "-0.0", "0.001", "1.005", "328", "1e300", "1,5"] {
            assert_eq!(hundredths(text), None, "{text}");
        }
    }
}
