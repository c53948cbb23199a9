//! Lanes: neighbouring pixels of a row, which are calculated together.
//!
//! A loop over lanes that has no branches and calls no function is compiled to instructions that
//! calculate several lanes each. This is why the functions here select instead of branching, and round by
//! addition: the oldest x86-64 processors have no instruction to round a double.

#![expect(clippy::inline_always, reason = "lanes pass through memory in each call")]

use glam::DVec3;

/// The number of lanes. With 8, what is done once for all lanes costs more; with 32, the unused lanes at
/// the edges of bodies do.
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
    /// Sets each lane to what `of` returns for it.
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

/// Combines the even and the odd lanes: one instruction for two.
#[inline(always)]
fn reduced(lanes: &Lanes, combined: impl Fn(f64, f64) -> f64) -> f64 {
    let [mut even, mut odd] = [lanes[0], lanes[1]];
    for pair in lanes.chunks_exact(2) {
        even = combined(even, pair[0]);
        odd = combined(odd, pair[1]);
    }
    combined(even, odd)
}

/// Whether all lanes of both are finite; their products may be too large for that.
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

/// The largest integer not above `number`.
#[inline(always)]
pub(crate) fn floor(number: f64) -> f64 {
    // From here on, doubles are integers. The sum is rounded to one.
    const INTEGERS: f64 = (1_u64 << (f64::MANTISSA_DIGITS - 1)) as f64;
    let shift = INTEGERS.copysign(number);
    let near = (number + shift) - shift;
    let below = near - if near > number { 1.0 } else { 0.0 };
    if number.abs() < INTEGERS { below } else { number }
}

/// The same for numbers of at most 2⁵⁰, positive or negative.
#[inline(always)]
pub(crate) fn floor_of_small(number: f64) -> f64 {
    const INTEGERS: f64 = 1.5 * (1_u64 << (f64::MANTISSA_DIGITS - 1)) as f64;
    let near = (number + INTEGERS) - INTEGERS;
    near - if near > number { 1.0 } else { 0.0 }
}

/// The integer nearest to `number`, which is from 0 to 2³¹; the upper one for ties. 0 for a NaN.
#[inline(always)]
pub(crate) fn rounded(number: f64) -> u32 {
    const INTEGERS: f64 = (1_u64 << (f64::MANTISSA_DIGITS - 1)) as f64;
    let sum = number + INTEGERS;
    // The addition rounds ties to even.
    let is_rounded_down = number - (sum - INTEGERS) == 0.5;
    sum.to_bits() as u32 + u32::from(is_rounded_down)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Halves of integers, neighbours of integers, and any other double.
    fn number() -> impl Strategy<Value = f64> {
        let integer =
            || (-1_i64 << 54..1 << 54, 0..54_u32).prop_map(|(it, bits)| (it >> bits) as f64);
        prop_oneof![
            integer().prop_map(|it| it / 2.0),
            integer().prop_map(f64::next_up),
            integer().prop_map(f64::next_down),
            -3.0..3.0,
            any::<f64>().prop_filter("a number", |number| !number.is_nan()),
        ]
    }

    proptest! {
        #[test]
        fn numbers_are_rounded_as_by_the_standard_library(number in number()) {
            prop_assert_eq!(floor(number), number.floor());
            if number.abs() <= 2.0_f64.powi(50) {
                prop_assert_eq!(floor_of_small(number), number.floor());
            }
            if (0.0..2.0_f64.powi(31)).contains(&number) {
                prop_assert_eq!(rounded(number), number.round() as u32);
            }
        }
    }

    #[test]
    fn a_nan_stays_one_and_is_rounded_to_zero() {
        assert!(floor(f64::NAN).is_nan() && floor_of_small(f64::NAN).is_nan());
        assert_eq!(rounded(f64::NAN), 0);
    }

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
