//! Lanes: neighbouring pixels of a row, which are calculated together.
//!
//! A loop over lanes that has no branches and calls no function is compiled to instructions that
//! calculate several lanes each. This is why the functions here select instead of branching, and round by
//! addition, as [`rounding`](crate::numeric::rounding) explains.

#![expect(clippy::inline_always, reason = "lanes pass through memory in each call")]

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
    pub(crate) fn bounds(&self) -> [DVec3; 2] {
        let [x, y, z] = self.axes().map(|lanes| [least(lanes), greatest(lanes)]);
        [DVec3::new(x[0], y[0], z[0]), DVec3::new(x[1], y[1], z[1])]
    }
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

/// Combines all lanes. The even and the odd lanes are combined side by side, so one instruction
/// does two lanes.
#[inline(always)]
fn reduced(lanes: &Lanes, combined: impl Fn(f64, f64) -> f64) -> f64 {
    let [mut even, mut odd] = [lanes[0], lanes[1]];
    for pair in lanes.chunks_exact(2) {
        even = combined(even, pair[0]);
        odd = combined(odd, pair[1]);
    }
    combined(even, odd)
}

/// Returns true only if all lanes of both are finite. May return false if a product of two lanes
/// overflows.
#[inline(always)]
pub(crate) fn are_finite(lanes: &Lanes, others: &Lanes) -> bool {
    let [mut even, mut odd] = [0.0; 2];
    for (pair, other) in lanes.chunks_exact(2).zip(others.chunks_exact(2)) {
        // This is zero, or a NaN.
        even += pair[0] * other[0] * 0.0;
        odd += pair[1] * other[1] * 0.0;
    }
    even + odd == 0.0
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
