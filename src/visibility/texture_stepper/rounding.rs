//! Rounding of doubles to integers, without the calls that it takes on old processors, and without
//! the comparisons that a saturating conversion takes.

/// The nearest integer, away from 0 for ties; values beyond 64 bits wrap around.
#[inline]
pub(super) fn rounded(number: f64) -> i64 {
    // Doubles of this size are the integers, so that the addition rounds to an integer.
    const INTEGERS: f64 = 1.5 * (1_u64 << (f64::MANTISSA_DIGITS - 1)) as f64;
    const MOST: f64 = (1_u64 << (f64::MANTISSA_DIGITS - 2)) as f64;
    let sum = number + INTEGERS;
    let rest = number - (sum - INTEGERS);
    // The addition rounds ties to even.
    if number.abs() < MOST && rest.abs() < 0.5 {
        sum.to_bits().wrapping_sub(INTEGERS.to_bits()) as i64
    } else {
        rounded_tie_or_large(number)
    }
}

#[cold]
#[inline(never)]
fn rounded_tie_or_large(number: f64) -> i64 {
    const LARGE: f64 = (1_u64 << 62) as f64;
    if number.abs() >= LARGE {
        // It is an integer.
        return number as i128 as i64;
    }
    let whole = number as i64;
    let rest = number - whole as f64;
    whole + i64::from(rest >= 0.5) - i64::from(rest <= -0.5)
}

/// The largest integer not above `number`, for numbers in the middle half of 64 bits.
#[inline]
pub(super) fn floor(number: f64) -> i64 {
    const MOST: f64 = (1_u64 << 62) as f64;
    let whole = number.clamp(-MOST, MOST) as i64;
    whole - i64::from(whole as f64 > number)
}

/// The least integer not below `number`, for the same numbers.
#[inline]
pub(crate) fn ceil(number: f64) -> i64 {
    -floor(-number)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn ties_are_rounded_away_from_zero(number in prop_oneof![
            (-1_i64 << 40..1 << 40).prop_map(|halves| halves as f64 / 2.0),
            any::<f64>().prop_filter("in range", |number| number.abs() < 2.0_f64.powi(62)),
        ]) {
            prop_assert_eq!(rounded(number), number.round() as i64);
        }
    }
}
