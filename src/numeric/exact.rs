//! Exact and double-double arithmetic on doubles: sums, products, and the sign of a cross product.
//!
//! - The error of a rounded sum or product of two doubles is itself a double. Sources: D. E. Knuth, *The
//!   Art of Computer Programming*, volume 2 (1969), section 4.2.2, theorem B, for the sum; T. J. Dekker,
//!   "A Floating-Point Technique for Extending the Available Precision" (1971), for the product. Rejected:
//!   the fused multiply-add, which computes the error of a product in one instruction. On processors
//!   without it, its emulation is slow.
//! - Double-double arithmetic (also by Dekker) has twice the digits of a double. It serves rays that
//!   barely touch a pillar. A difference of two squares decides whether and where such a ray hits, and the
//!   square root of that difference turns an error in the sixteenth digit into an error in the eighth.
//! - The orientation predicate tells on which side of a ray a point lies, with an exact sign. The cross
//!   product of the vector to the point and the ray's direction is a difference of two products. A filter
//!   comes first: the sign of the rounded result is right if the result exceeds its error bound (J. R.
//!   Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997).
//!   Otherwise each component is split into two doubles that add up to it exactly. The cross product is
//!   then a sum of four products of two doubles, and each product is an integer of at most 106 bits times
//!   a power of two. A 128-bit integer accumulates them, from the largest power down. Either it can hold
//!   the whole sum, or its value so far exceeds the remaining terms that rounding them cannot change the
//!   sign. Rejected: Shewchuk's expansions of doubles. Their products overflow and underflow at the ends
//!   of the range, where this predicate is needed. Rejected: integers of arbitrary length, which four
//!   terms never need.

use std::cmp::Reverse;
use std::ops::{Add, Mul, Sub};

use glam::DVec2;

/// The cross product of `corner - origin` and `direction`. It is positive if the ray passes the corner on
/// the left, with y to the south.
pub(crate) fn cross(origin: DVec2, direction: DVec2, corner: DVec2) -> Scaled {
    let [x, x_rest] = two_sum(corner.x, -origin.x);
    let [y, y_rest] = two_sum(origin.y, -corner.y);
    sum([
        Integer::product(x, direction.y),
        Integer::product(x_rest, direction.y),
        Integer::product(y, direction.x),
        Integer::product(y_rest, direction.x),
    ])
}

/// A number with the sign of [`cross`].
///
/// Plain doubles decide the sign if the result exceeds its error bound, as most results do.
#[inline]
pub(crate) fn sign_of_cross(origin: DVec2, direction: DVec2, corner: DVec2) -> f64 {
    /// Covers the rounding of the products, of their difference, and of the bound itself.
    const ROUNDING: f64 = 4.0 * f64::EPSILON;
    let to_corner = corner - origin;
    let (one, other) = (to_corner.x * direction.y, to_corner.y * direction.x);
    // The second term covers the loss by underflow.
    let error_bound = (one.abs() + other.abs()) * ROUNDING + f64::MIN_POSITIVE;
    let rounded = one - other;
    if rounded.abs() > error_bound { rounded } else { cross(origin, direction, corner).sign() }
}

/// A number that may exceed the range of a double: `mantissa` · 2^`exponent`.
///
/// The sign is exact, including zero. The value has 50 exact bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scaled {
    mantissa: f64,
    exponent: i32,
}

impl Scaled {
    /// A number with the sign of the value, or 0 if the value is 0.
    pub(crate) fn sign(self) -> f64 {
        self.mantissa
    }

    /// The value divided by `divisor`.
    pub(crate) fn over(self, divisor: f64) -> f64 {
        self.over_scaled(divisor, 0)
    }

    /// The value divided by `divisor` · 2^`exponent`. Only the last step can underflow.
    pub(crate) fn over_scaled(self, divisor: f64, exponent: i32) -> f64 {
        let divisor = Integer::from_double(divisor);
        let quotient = self.mantissa / divisor.mantissa as f64;
        libm::scalbn(quotient, self.exponent - divisor.exponent - exponent)
    }
}

/// `mantissa` · 2^`exponent`.
#[derive(Clone, Copy, Debug)]
struct Integer {
    mantissa: i128,
    exponent: i32,
}

impl Integer {
    /// The number of bits of a double's mantissa, including the leading one.
    const DOUBLE_BITS: u32 = f64::MANTISSA_DIGITS;

    fn from_double(value: f64) -> Self {
        const LEADING_ONE: u64 = 1 << (Integer::DOUBLE_BITS - 1);
        const EXPONENT_OF_SUBNORMALS: i32 = f64::MIN_EXP - Integer::DOUBLE_BITS as i32;
        let bits = value.abs().to_bits();
        let biased_exponent = (bits / LEADING_ONE) as i32;
        let fraction = bits % LEADING_ONE;
        let (magnitude, exponent) = if biased_exponent == 0 {
            (fraction, EXPONENT_OF_SUBNORMALS)
        } else {
            (fraction + LEADING_ONE, EXPONENT_OF_SUBNORMALS + biased_exponent - 1)
        };
        let magnitude = i128::from(magnitude);
        Self { mantissa: if value < 0.0 { -magnitude } else { magnitude }, exponent }
    }

    /// The product of two doubles. It has at most 106 bits.
    fn product(a: f64, b: f64) -> Self {
        let (a, b) = (Self::from_double(a), Self::from_double(b));
        Self { mantissa: a.mantissa * b.mantissa, exponent: a.exponent + b.exponent }
    }

    /// The number of bits of the mantissa.
    fn bits(self) -> i32 {
        (i128::BITS - self.mantissa.unsigned_abs().leading_zeros()) as i32
    }
}

/// The sum of four products of two doubles.
fn sum(mut terms: [Integer; 4]) -> Scaled {
    /// The largest size of a shifted partial sum, in bits. Adding the remaining terms to it cannot
    /// overflow, and a larger one decides the sign of the total.
    const ROOM: i32 = 124;
    terms.sort_unstable_by_key(|term| Reverse(term.exponent));
    let mut sum = terms[0];
    for (index, &term) in terms.iter().enumerate().skip(1) {
        let shift = sum.exponent - term.exponent;
        if sum.mantissa == 0 {
            sum = term;
        } else if sum.bits() + shift <= ROOM {
            let mantissa = (sum.mantissa << shift) + term.mantissa;
            sum = Integer { mantissa, exponent: term.exponent };
        } else {
            let scaled =
                |term: &Integer| libm::scalbn(term.mantissa as f64, term.exponent - sum.exponent);
            let rest: f64 = terms[index..].iter().map(scaled).sum();
            return Scaled { mantissa: sum.mantissa as f64 + rest, exponent: sum.exponent };
        }
    }
    Scaled { mantissa: sum.mantissa as f64, exponent: sum.exponent }
}

/// `TwoSum`: the rounded sum of `a` and `b`, and its error. The two add up to `a + b` exactly.
#[inline]
pub(crate) fn two_sum(a: f64, b: f64) -> [f64; 2] {
    let sum = a + b;
    let of_b = sum - a;
    let of_a = sum - of_b;
    [sum, (a - of_a) + (b - of_b)]
}

/// `TwoProduct`: the rounded product of `a` and `b`, and its error. The two add up to `a * b` exactly if
/// neither factor exceeds 10³⁰⁰ and the error does not underflow.
#[inline]
pub(crate) fn two_product(a: f64, b: f64) -> [f64; 2] {
    let product = a * b;
    let ([a_high, a_low], [b_high, b_low]) = (split(a), split(b));
    let error = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    [product, error]
}

/// Veltkamp's splitting: two doubles with half the digits, whose sum is `value`.
fn split(value: f64) -> [f64; 2] {
    const SPLITTER: f64 = 134_217_729.0;
    let scaled = value * SPLITTER;
    let high = scaled - (scaled - value);
    [high, value - high]
}

/// The sum of two doubles. The second is at most half a unit in the last place of the first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DoubleDouble {
    high: f64,
    low: f64,
}

impl DoubleDouble {
    /// `a + b`, exactly.
    pub(crate) fn sum(a: f64, b: f64) -> Self {
        let [high, low] = two_sum(a, b);
        Self { high, low }
    }

    /// `a · b`, exactly, if neither exceeds 10³⁰⁰.
    pub(crate) fn product(a: f64, b: f64) -> Self {
        let [high, low] = two_product(a, b);
        Self { high, low }
    }

    /// The square of the number.
    pub(crate) fn square(self) -> Self {
        self * self
    }

    /// The square root of a positive number.
    pub(crate) fn sqrt(self) -> Self {
        let root = self.high.sqrt();
        let rest = self - Self::product(root, root);
        Self::sum(root, rest.high / (2.0 * root))
    }

    /// The number divided by `divisor`, rounded.
    pub(crate) fn over(self, divisor: Self) -> f64 {
        let quotient = self.high / divisor.high;
        let rest = self - divisor * Self::from(quotient);
        quotient + rest.high / divisor.high
    }

    /// The nearest double.
    pub(crate) fn rounded(self) -> f64 {
        self.high
    }
}

impl From<f64> for DoubleDouble {
    fn from(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
}

impl Add for DoubleDouble {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let Self { high, low } = Self::sum(self.high, other.high);
        Self::sum(high, low + self.low + other.low)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + Self { high: -other.high, low: -other.low }
    }
}

impl Mul for DoubleDouble {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let Self { high, low } = Self::product(self.high, other.high);
        Self::sum(high, low + (self.high * other.low + self.low * other.high))
    }
}

#[cfg(test)]
mod tests {
    use num_rational::BigRational;
    use num_traits::{Signed, ToPrimitive};
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn the_smallest_difference_decides_the_sign() {
        let least = 5e-324;
        for (origin, direction, sign) in [
            ((0.0, 0.0), (1.0, 1.0), 0.0),
            ((0.0, least), (1.0, 1.0), 1.0),
            ((0.0, -least), (1.0, 1.0), -1.0),
            ((0.0, least), (1e300, 1e300), 1.0),
            ((0.0, 1.0), (1e300, least), 1.0),
            ((0.0, 1.0), (1e300, -least), -1.0),
            ((-1e308, -1e308), (1e308, 1e308), 0.0),
            ((-1e308, -1e308), (least, least), 0.0),
            ((f64::MAX, f64::MAX.next_down()), (1.0, 1.0), -1.0),
        ] {
            let cross = cross(DVec2::from(origin), DVec2::from(direction), DVec2::ONE);
            assert_eq!(cross.sign().partial_cmp(&0.0), sign.partial_cmp(&0.0), "{origin:?}");
        }
    }

    proptest! {
        /// The rays pass within a few units in the last place of the corner.
        #[test]
        fn the_filter_agrees_with_the_exact_sign(
            (x, y) in (-9.0..9.0, -9.0..9.0),
            corner in (-9_i32..9, -9_i32..9),
            ulps in (-9_i64..9, -9_i64..9),
            exponent in prop_oneof![Just(0), -1060..900],
        ) {
            let (origin, corner) = (DVec2::new(x, y), DVec2::new(corner.0.into(), corner.1.into()));
            let moved = |part: f64, ulps| f64::from_bits((part.to_bits() as i64 + ulps) as u64);
            let way = corner - origin;
            let direction = DVec2::new(moved(way.x, ulps.0), moved(way.y, ulps.1));
            let direction = direction * libm::scalbn(1.0, exponent);
            let signs = [sign_of_cross, |o, d, c| cross(o, d, c).sign()]
                .map(|sign| sign(origin, direction, corner).partial_cmp(&0.0));
            prop_assert_eq!(signs[0], signs[1]);
        }

        /// For numbers that need no rounding, the result equals the integer formula.
        #[test]
        fn the_cross_product_agrees_with_integers(
            numbers in prop::array::uniform4(-(1_i64 << 30)..1 << 30),
            corner in (0..1_i64 << 20, 0..1_i64 << 20),
            exponent in -900..900,
        ) {
            let [x, y, dx, dy] = numbers;
            prop_assume!((dx, dy) != (0, 0));
            let unit = libm::scalbn(1.0, exponent);
            let origin = DVec2::new(x as f64, y as f64);
            let direction = DVec2::new(dx as f64, dy as f64) * unit;
            let expected = (corner.0 - x) * dy - (corner.1 - y) * dx;
            let corner = DVec2::new(corner.0 as f64, corner.1 as f64);
            prop_assert_eq!(cross(origin, direction, corner).over(unit), expected as f64);
        }
    }

    fn exact(value: f64) -> BigRational {
        BigRational::from_float(value).unwrap()
    }

    proptest! {
        /// Rational arithmetic is the oracle.
        #[test]
        fn sums_and_products_have_no_error(a in -1e9..1e9, b in -1e9..1e9) {
            let value_of = |[rounded, error]: [f64; 2]| exact(rounded) + exact(error);
            prop_assert_eq!(value_of(two_sum(a, b)), exact(a) + exact(b));
            prop_assert_eq!(value_of(two_product(a, b)), exact(a) * exact(b));
        }

        #[test]
        fn a_difference_of_squares_has_thirty_digits(a in 0.1_f64..10.0, ulps in -100_i64..100) {
            let b = f64::from_bits((a.to_bits() as i64 + ulps) as u64);
            let difference = DoubleDouble::product(a, a) - DoubleDouble::from(b).square();
            let difference = exact(difference.high) + exact(difference.low);
            let error = difference - (exact(a) * exact(a) - exact(b) * exact(b));
            prop_assert!((error.abs() / (exact(a) * exact(a))).to_f64().unwrap() < 1e-30);
        }
    }
}
