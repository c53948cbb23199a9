//! Numbers of two doubles: twice the digits, for a difference that is nearly nothing.
//!
//! Where a ray just grazes a pillar, it turns on the difference of two squares whether and where it
//! hits, and the square root of that difference makes of the sixteenth digit the eighth. The
//! integers of `cross` were refused here: these are products of four doubles, and their size is not
//! bounded by what an integer of the machine holds.
//!
//! Source: T. J. Dekker, "A Floating-Point Technique for Extending the Available Precision" (1971).

use std::ops::{Add, Mul, Sub};

/// The sum of two doubles, of which the second is at most half a unit in the last place of the first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Double {
    high: f64,
    low: f64,
}

impl Double {
    /// `a + b`, exactly.
    pub(super) fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let of_b = high - a;
        let of_a = high - of_b;
        Self { high, low: (a - of_a) + (b - of_b) }
    }

    /// `a · b`, exactly, where neither is larger than 10³⁰⁰.
    pub(super) fn product(a: f64, b: f64) -> Self {
        let high = a * b;
        let ([a, a_rest], [b, b_rest]) = (halves(a), halves(b));
        let low = ((a * b - high) + a * b_rest + a_rest * b) + a_rest * b_rest;
        Self { high, low }
    }

    /// Its square.
    pub(super) fn square(self) -> Self {
        self * self
    }

    /// The nearest double.
    pub(super) fn rounded(self) -> f64 {
        self.high
    }
}

impl From<f64> for Double {
    fn from(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
}

impl Add for Double {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let Self { high, low } = Self::sum(self.high, other.high);
        Self::sum(high, low + self.low + other.low)
    }
}

impl Sub for Double {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + Self { high: -other.high, low: -other.low }
    }
}

impl Mul for Double {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let Self { high, low } = Self::product(self.high, other.high);
        Self::sum(high, low + (self.high * other.low + self.low * other.high))
    }
}

/// Two doubles of half as many digits, whose sum is `value`.
fn halves(value: f64) -> [f64; 2] {
    const SPLITTER: f64 = 134_217_729.0;
    let scaled = value * SPLITTER;
    let high = scaled - (scaled - value);
    [high, value - high]
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

    fn value_of(double: Double) -> BigRational {
        exact(double.high) + exact(double.low)
    }

    proptest! {
        #[test]
        fn sums_and_products_of_doubles_are_exact(a in -1e9..1e9, b in -1e9..1e9) {
            prop_assert_eq!(value_of(Double::sum(a, b)), exact(a) + exact(b));
            prop_assert_eq!(value_of(Double::product(a, b)), exact(a) * exact(b));
        }

        #[test]
        fn a_difference_of_squares_has_thirty_digits(a in 0.1_f64..10.0, ulps in -100_i64..100) {
            let b = f64::from_bits((a.to_bits() as i64 + ulps) as u64);
            let difference = Double::product(a, a) - Double::from(b).square();
            let error = value_of(difference) - (exact(a) * exact(a) - exact(b) * exact(b));
            prop_assert!((error.abs() / (exact(a) * exact(a))).to_f64().unwrap() < 1e-30);
        }
    }
}
