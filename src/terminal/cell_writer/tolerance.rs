//! How far a colour may be off, while a frame is encoded and while it is refined.

use super::super::fidelity::Fidelity;
use super::style::Shade;

/// A distance between colours that is not worth bytes, in sixteenths of a [`Fidelity`]'s.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Tolerance(i32);

/// What a step of a channel counts for; the eye sees green best.
const WEIGHTS: [i32; 3] = [2, 4, 3];
const TOTAL: i32 = WEIGHTS[0] + WEIGHTS[1] + WEIGHTS[2];
const FRACTION: i32 = 16;

impl Tolerance {
    /// Frames in which a resting picture becomes exact.
    pub(super) const STEPS: i32 = 10;

    /// What `fidelity` allows while there is motion.
    pub(super) fn of(fidelity: Fidelity) -> Self {
        Self(i32::from(fidelity.tolerance()) * FRACTION)
    }

    /// A tenth of what `fidelity` allows less than this.
    pub(super) fn refined(self, fidelity: Fidelity) -> Self {
        let step = (Self::of(fidelity).0 + Self::STEPS - 1) / Self::STEPS;
        Self((self.0.min(Self::of(fidelity).0) - step).max(0))
    }

    pub(super) fn is_exact(self) -> bool {
        self.0 == 0
    }

    /// Whether `shown` passes for `wanted`.
    pub(super) fn covers(self, shown: Shade, wanted: Shade) -> bool {
        shown == wanted
            || match (shown, wanted) {
                (Shade::Rgb(red, green, blue), Shade::Rgb(r, g, b)) => {
                    let differences = [(red, r), (green, g), (blue, b)];
                    let squares =
                        differences.map(|(one, other)| i32::from(one.abs_diff(other)).pow(2));
                    let distance: i32 = squares.iter().zip(WEIGHTS).map(|(s, w)| s * w).sum();
                    distance * FRACTION.pow(2) <= self.0 * self.0 * TOTAL
                }
                _ => false,
            }
    }
}
