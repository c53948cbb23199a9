//! Double-double arithmetic: each number is the sum of two doubles and has twice the digits of one.
//!
//! If a ray only just touches a pillar, the difference of two squares decides whether and where it
//! hits, and the square root of that difference turns an error in the sixteenth digit into one in
//! the eighth. The integers of `orientation` were refused here: these are products of four doubles,
//! which exceed every integer type.
//!
//! Source: T. J. Dekker, "A Floating-Point Technique for Extending the Available Precision" (1971).

use std::ops::{Add, Mul, Sub};

use super::error_free::{two_product, two_sum};

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

    fn exact(value: f64) -> BigRational {
        BigRational::from_float(value).unwrap()
    }

    fn value_of(double: DoubleDouble) -> BigRational {
        exact(double.high) + exact(double.low)
    }

    proptest! {
        #[test]
        fn a_difference_of_squares_has_thirty_digits(a in 0.1_f64..10.0, ulps in -100_i64..100) {
            let b = f64::from_bits((a.to_bits() as i64 + ulps) as u64);
            let difference = DoubleDouble::product(a, a) - DoubleDouble::from(b).square();
            let error = value_of(difference) - (exact(a) * exact(a) - exact(b) * exact(b));
            prop_assert!((error.abs() / (exact(a) * exact(a))).to_f64().unwrap() < 1e-30);
        }
    }
}
