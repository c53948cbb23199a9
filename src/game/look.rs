//! Turning and tilting by an amount, rather than for a time: what a pointer does.
//!
//! An amount is in whole hundredths of a degree, so that a script holds every digit of it and plays
//! the same again, bit for bit. It takes effect at once: the pointer's own motion begins and ends
//! smoothly. Turning it into a time to turn for was refused: a step is 2.3°, more than a hand aims by.

use std::fmt;

/// By how much the player turns and tilts within one step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Look {
    /// Clockwise as seen from above, in hundredths of a degree.
    pub turn: i16,
    /// Upwards, in hundredths of a degree: of the horizon in a grid, of the eye in a scene of bodies.
    pub tilt: i16,
}

/// What files call the two.
pub(super) const TURN: &str = "turn";
pub(super) const TILT: &str = "tilt";

impl Look {
    /// Neither turns nor tilts.
    pub const NONE: Self = Self { turn: 0, tilt: 0 };

    /// How many units make a degree.
    pub const PER_DEGREE: i16 = 100;

    /// Clockwise, in radians.
    pub(super) fn turn_radians(self) -> f64 {
        radians(self.turn)
    }

    /// Upwards, in radians.
    pub(super) fn tilt_radians(self) -> f64 {
        radians(self.tilt)
    }

    /// The words that a script has for it: none, one or two.
    pub(super) fn words(self) -> impl Iterator<Item = String> {
        let amounts = [(TURN, self.turn), (TILT, self.tilt)];
        let amounts = amounts.into_iter().filter(|&(_, amount)| amount != 0);
        amounts.map(|(name, amount)| format!("{name}:{}", Degrees(amount)))
    }
}

fn radians(hundredths: i16) -> f64 {
    (f64::from(hundredths) / f64::from(Look::PER_DEGREE)).to_radians()
}

/// Hundredths of a degree, written as degrees: all digits, and no more.
struct Degrees(i16);

impl fmt::Display for Degrees {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", f64::from(self.0) / f64::from(Look::PER_DEGREE))
    }
}

/// The hundredths of a degree that `text` says in degrees; `None` for what is no number, has parts of
/// a hundredth, is nothing or too much.
pub(super) fn hundredths(text: &str) -> Option<i16> {
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
