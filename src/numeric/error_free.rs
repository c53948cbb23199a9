//! Sums and products of two doubles with their rounding errors, which are doubles, too.
//!
//! Sources: D. E. Knuth, *The Art of Computer Programming*, volume 2 (1969), section 4.2.2, theorem
//! B, for the sum; T. J. Dekker, "A Floating-Point Technique for Extending the Available Precision"
//! (1971), for the product. The fused multiply-add, which computes the error of a product in one
//! instruction, was refused: on processors without it, its emulation is slow.

/// `TwoSum`: the rounded sum of `a` and `b`, and its error. The two add up to `a + b` exactly.
#[inline]
pub(crate) fn two_sum(a: f64, b: f64) -> [f64; 2] {
    let sum = a + b;
    let of_b = sum - a;
    let of_a = sum - of_b;
    [sum, (a - of_a) + (b - of_b)]
}

/// `TwoProduct`: the rounded product of `a` and `b`, and its error. The two add up to `a * b`
/// exactly if neither factor exceeds 10³⁰⁰ and the error is not below the least double.
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

#[cfg(test)]
mod tests {
    use num_rational::BigRational;
    use proptest::prelude::*;

    use super::*;

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
    }
}
