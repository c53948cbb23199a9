//! Lanes: neighbouring pixels of a row, which are calculated together.
//!
//! A loop over lanes that has no branches and calls no function is compiled to instructions that
//! calculate several lanes each. This is why the functions here select instead of branching, and round by
//! addition, as [`rounding`](crate::numeric::rounding) explains.
//!
//! All of this is compiled for several widths of registers, and [`in_widest_registers`] picks the widest
//! of the processor: spheres take 0.6 of the time with AVX2. A function that is not inlined into its call
//! keeps the narrowest registers.

use fearless_simd::{Level, Simd, dispatch};
use glam::DVec3;

/// The number of lanes. Rejected: 8 lanes, because the work that is done once for all lanes costs
/// more; and 32 lanes, because unused lanes at the edges of bodies cost more.
pub(crate) const LANES: usize = 16;

/// A number for each lane.
pub(crate) type Lanes = [f64; LANES];

/// A vector for each lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vectors {
    x: Lanes,
    y: Lanes,
    z: Lanes,
}

impl Default for Vectors {
    fn default() -> Self {
        Self { x: [0.0; LANES], y: [0.0; LANES], z: [0.0; LANES] }
    }
}

impl Vectors {
    /// Sets each lane to the value that `of` returns for it.
    #[inline(always)]
    pub(crate) fn fill(&mut self, of: impl Fn(usize) -> DVec3) {
        for lane in 0..LANES {
            let DVec3 { x, y, z } = of(lane);
            (self.x[lane], self.y[lane], self.z[lane]) = (x, y, z);
        }
    }

    /// Divides each lane by `divisor`.
    #[inline(always)]
    pub(crate) fn divide(&mut self, divisor: f64) {
        for components in [&mut self.x, &mut self.y, &mut self.z] {
            for component in components {
                *component /= divisor;
            }
        }
    }

    #[inline(always)]
    pub(crate) fn get(&self, lane: usize) -> DVec3 {
        DVec3::new(self.x[lane], self.y[lane], self.z[lane])
    }

    /// The components along each axis.
    pub(crate) fn axes(&self) -> [&Lanes; 3] {
        [&self.x, &self.y, &self.z]
    }

    /// The low and the high corner of the box around all lanes that are numbers.
    #[inline(always)]
    pub(crate) fn bounds(&self) -> [DVec3; 2] {
        let Self { x, y, z } = self;
        [
            DVec3::new(least(x), least(y), least(z)),
            DVec3::new(greatest(x), greatest(y), greatest(z)),
        ]
    }
}

/// Calls `calculate`, compiled for the widest registers of this processor.
#[inline(always)]
pub(crate) fn in_widest_registers<R>(calculate: impl FnOnce() -> R) -> R {
    dispatch!(Level::new(), simd => simd.vectorize(calculate))
}

/// The least of the lanes that are numbers.
#[inline(always)]
pub(crate) fn least(lanes: &Lanes) -> f64 {
    reduced(lanes, |one, other| if one < other { one } else { other })
}

/// The greatest of the lanes that are numbers.
#[inline(always)]
pub(crate) fn greatest(lanes: &Lanes) -> f64 {
    reduced(lanes, |one, other| if one > other { one } else { other })
}

/// Combines all lanes. Four lanes are combined side by side, so one instruction does several.
#[inline(always)]
fn reduced(lanes: &Lanes, combined: impl Fn(f64, f64) -> f64) -> f64 {
    let mut four = [lanes[0], lanes[1], lanes[2], lanes[3]];
    for lanes in lanes.as_chunks::<4>().0 {
        for (one, &lane) in four.iter_mut().zip(lanes) {
            *one = combined(*one, lane);
        }
    }
    combined(combined(four[0], four[1]), combined(four[2], four[3]))
}

/// Returns true only if all lanes of both are finite. May return false if a product of two lanes
/// overflows.
#[inline(always)]
pub(crate) fn are_finite(lanes: &Lanes, others: &Lanes) -> bool {
    // A product with an infinity or a NaN, times zero, is a NaN.
    let is_finite = |(&one, &other): (&f64, &f64)| one * other * 0.0 == 0.0;
    lanes.iter().zip(others).fold(true, |all, pair| all & is_finite(pair))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_and_the_greatest_are_found_in_any_lane() {
        for lane in 0..LANES {
            let mut lanes = [2.0; LANES];
            lanes[lane] = 1.0;
            assert_eq!((least(&lanes), greatest(&lanes)), (1.0, 2.0));
            lanes[lane] = 3.0;
            assert_eq!((least(&lanes), greatest(&lanes)), (2.0, 3.0));
            assert!(are_finite(&lanes, &lanes));
            for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                lanes[lane] = odd;
                assert!(!are_finite(&lanes, &[0.0; LANES]) && !are_finite(&[1.0; LANES], &lanes));
            }
        }
    }
}
