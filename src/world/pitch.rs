//! Pitch: looking up and down.
//!
//! The picture is sheared, not rotated: it moves up or down by whole rows of pixels. A rotation was
//! refused: walls would lean, a column of pixels would no longer be one ray, and every stage would
//! pay for it. The shear is the picture of a camera that looks straight ahead with its image plane
//! shifted, as in architectural photography. It looks distorted at large angles, so it is limited
//! to [`Pitch::MOST_DEGREES`].

use serde::{Deserialize, Serialize};
/// How far the camera looks up or down: within ±30°.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "f64")]
pub struct Pitch {
    slope: f64,
}

/// The tangent of [`Pitch::MOST_DEGREES`].
const STEEPEST: f64 = 0.577_350_269_189_625_7;

impl Pitch {
    /// Straight ahead.
    pub const LEVEL: Self = Self { slope: 0.0 };
    /// The limit, in degrees. Beyond it the horizon is far out of view, and walls look stretched.
    pub const MOST_DEGREES: f64 = 30.0;

    /// A pitch in degrees, positive for up. `None` beyond ±[`Pitch::MOST_DEGREES`].
    pub fn from_degrees(degrees: f64) -> Option<Self> {
        let is_within = degrees.abs() <= Self::MOST_DEGREES;
        is_within.then(|| Self::LEVEL.tilted(libm::tan(degrees.to_radians())))
    }

    /// Degrees, positive for up.
    pub fn degrees(self) -> f64 {
        libm::atan(self.slope).to_degrees()
    }

    /// The slope of the ray through the middle of the picture: cells up for each cell ahead.
    pub fn slope(self) -> f64 {
        self.slope
    }

    /// The pitch with `slope` added, within the limit; unchanged if `slope` is NaN.
    #[must_use]
    pub fn tilted(self, slope: f64) -> Self {
        if slope.is_nan() {
            return self;
        }
        // Adding zero removes the sign of a negative zero.
        Self { slope: (self.slope + slope).clamp(-STEEPEST, STEEPEST) + 0.0 }
    }
}

/// A pitch from its slope.
impl TryFrom<f64> for Pitch {
    type Error = &'static str;

    fn try_from(slope: f64) -> Result<Self, &'static str> {
        let pitch = Self::LEVEL.tilted(slope);
        if pitch.slope.to_bits() == slope.to_bits() { Ok(pitch) } else { Err("a pitch") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_come_back() {
        for degrees in [-30.0, -12.5, 0.0, 1.0, 29.999, 30.0] {
            let pitch = Pitch::from_degrees(degrees).unwrap();
            assert!((pitch.degrees() - degrees).abs() < 1e-12, "{degrees}");
        }
        for degrees in [30.001, -31.0, f64::NAN, f64::INFINITY] {
            assert_eq!(Pitch::from_degrees(degrees), None);
        }
    }

    #[test]
    fn nobody_looks_further_than_the_limit() {
        let highest = Pitch::from_degrees(30.0).unwrap();
        assert_eq!(Pitch::LEVEL.tilted(f64::INFINITY), highest.tilted(1e9));
        assert_eq!(highest.tilted(1.0).tilted(-2.0 * STEEPEST).degrees(), -highest.degrees());
        assert_eq!(highest.tilted(f64::NAN), highest);
    }
}
