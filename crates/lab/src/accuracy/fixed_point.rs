//! Numbers in fixed point, for references that are not fractions.
//!
//! A number is an integer in units of 2⁻⁵¹². Every double is such a number if its last place is not
//! smaller, which holds for all coordinates and times of the report. Products, quotients and roots
//! are cut off at this unit, so a result of common size has some 150 digits.

use std::ops::{Add, Div, Mul, Neg, Sub};

use num_bigint::{BigInt, Sign};

use super::reference::integer;

const BITS: u32 = 512;

/// A number in fixed point.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct FixedPoint(BigInt);

impl FixedPoint {
    /// Converts a finite double. Digits below 2⁻⁵¹² are cut off.
    pub(crate) fn new(value: f64) -> Self {
        let (integer, exponent) = integer(value);
        let shift = exponent + i64::from(BITS);
        Self(if shift >= 0 { integer << shift } else { integer >> -shift })
    }

    /// The nearest double, or the next one to it.
    pub(crate) fn to_f64(&self) -> f64 {
        let excess = self.0.bits().saturating_sub(64);
        let digits = (self.0.magnitude() >> excess).iter_u64_digits().next().unwrap_or(0);
        let exponent = (excess as i64 - i64::from(BITS)).clamp(-5000, 5000) as i32;
        let magnitude = libm::scalbn(digits as f64, exponent);
        if self.is_negative() { -magnitude } else { magnitude }
    }

    pub(crate) fn is_negative(&self) -> bool {
        self.0.sign() == Sign::Minus
    }

    pub(crate) fn is_zero(&self) -> bool {
        self.0.sign() == Sign::NoSign
    }

    /// The square root of a number that is not negative.
    pub(crate) fn square_root(&self) -> Self {
        Self((&self.0 << BITS).sqrt())
    }

    /// The relative error of a finite `value`, or the absolute error if this number is 0.
    pub(crate) fn relative_error(&self, value: f64) -> f64 {
        let difference = &Self::new(value) - self;
        let share = if self.is_zero() { difference } else { &difference / self };
        share.to_f64().abs()
    }

    /// e to the power of minus this number, which must not be negative. Sums the series at a number
    /// below 2⁻⁸, and squares the sum once for each halving of the number.
    pub(crate) fn exponential_of_minus(&self) -> Self {
        const TERMS: u32 = 60;
        // e^−355 is below 2⁻⁵¹².
        if *self > Self::new(355.0) {
            return Self::new(0.0);
        }
        let halvings = (self.0.bits() + 8).saturating_sub(u64::from(BITS));
        let small = Self(&self.0 >> halvings);
        let (mut sum, mut term) = (Self::new(1.0), Self::new(1.0));
        for count in 1..=TERMS {
            term = Self((&term * &small).0 / count);
            sum = &sum + &term;
        }
        for _ in 0..halvings {
            sum = &sum * &sum;
        }
        &Self::new(1.0) / &sum
    }
}

impl Add for &FixedPoint {
    type Output = FixedPoint;

    fn add(self, other: Self) -> FixedPoint {
        FixedPoint(&self.0 + &other.0)
    }
}

impl Sub for &FixedPoint {
    type Output = FixedPoint;

    fn sub(self, other: Self) -> FixedPoint {
        FixedPoint(&self.0 - &other.0)
    }
}

impl Mul for &FixedPoint {
    type Output = FixedPoint;

    fn mul(self, other: Self) -> FixedPoint {
        FixedPoint((&self.0 * &other.0) >> BITS)
    }
}

impl Div for &FixedPoint {
    type Output = FixedPoint;

    fn div(self, other: Self) -> FixedPoint {
        FixedPoint((&self.0 << BITS) / &other.0)
    }
}

impl Neg for &FixedPoint {
    type Output = FixedPoint;

    fn neg(self) -> FixedPoint {
        FixedPoint(-&self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arithmetic_matches_exact_doubles() {
        let [a, b] = [-1.75, 0.375].map(FixedPoint::new);
        let results = [&a + &b, &a - &b, &a * &b, &a / &b, -&a].map(|number| number.to_f64());
        assert_eq!(results[..3], [-1.375, -2.125, -0.65625]);
        assert!((results[3] + 14.0 / 3.0).abs() < 1e-15 && results[4] == 1.75);
        assert_eq!(FixedPoint::new(2.25).square_root().to_f64(), 1.5);
        assert!(a.is_negative() && !b.is_negative() && FixedPoint::new(-0.0).is_zero());
        assert_eq!((b.relative_error(0.75), FixedPoint::new(0.0).relative_error(-0.5)), (1.0, 0.5));
    }

    #[test]
    fn the_series_converges_to_the_exponential() {
        for x in [0.0, 1e-9, 0.5, 1.0, 12.0, 40.0, 300.0] {
            let series = FixedPoint::new(x).exponential_of_minus().to_f64();
            let expected = libm::exp(-x);
            assert!((series - expected).abs() <= 4e-16 * expected, "{x}: {series}");
        }
    }

    /// ln 2 is not a double. e to the power of minus the nearest double is therefore not exactly a
    /// half; the exponents differ by 2.319e-17.
    #[test]
    fn the_exponential_is_more_precise_than_a_double() {
        let half = FixedPoint::new(std::f64::consts::LN_2).exponential_of_minus();
        let difference = (&half - &FixedPoint::new(0.5)).to_f64();
        assert!((difference - 0.5 * 2.319_046_813_846_3e-17).abs() < 1e-28, "{difference}");
    }
}
