//! Rounding of doubles to integers, without the calls that it takes on old processors, and without
//! the comparisons that a saturating conversion takes.

/// The nearest integer, away from 0 for ties; values beyond 64 bits wrap around.
#[inline]
pub(crate) fn rounded(number: f64) -> i64 {
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
pub(crate) fn floor(number: f64) -> i64 {
    const MOST: f64 = (1_u64 << 62) as f64;
    let whole = number.clamp(-MOST, MOST) as i64;
    whole - i64::from(whole as f64 > number)
}

/// The least integer not below `number`, for the same numbers.
#[inline]
pub(crate) fn ceil(number: f64) -> i64 {
    -floor(-number)
}

/// The least integer not below `number`, where that is at least 0 and at most `most`, an integer of 32
/// bits; 0 for NaN.
#[inline]
pub(crate) fn ceil_within(most: f64, number: f64) -> u32 {
    // Doubles of this size are the integers, so that the addition rounds to an integer. Unlike a
    // conversion, it is vectorized.
    const INTEGERS: f64 = (1_u64 << (f64::MANTISSA_DIGITS - 1)) as f64;
    let number = number.max(0.0).min(most);
    let sum = number + INTEGERS;
    let nearest = sum - INTEGERS;
    sum.to_bits() as u32 + u32::from(nearest < number)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn bounds_are_kept() {
        let numbers = [-1e300, -0.5, 0.0, 1e-300, 6.5, 7.0, 7.1, f64::INFINITY, f64::NAN];
        let ceilings = numbers.map(|number| ceil_within(7.0, number));
        assert_eq!(ceilings, [0, 0, 0, 1, 7, 7, 7, 7, 0]);
    }

    proptest! {
        #[test]
        fn a_ceiling_is_the_next_integer(number in prop_oneof![
            0.0..1e4_f64,
            (0..1_u32 << 31).prop_map(|halves| f64::from(halves) / 2.0),
            (0..1_u64 << 32).prop_map(|number| (number as f64).next_up()),
        ]) {
            let most = f64::from(u32::MAX);
            prop_assert_eq!(ceil_within(most, number), number.ceil().min(most) as u32);
        }

        #[test]
        fn ties_are_rounded_away_from_zero(number in prop_oneof![
            (-1_i64 << 40..1 << 40).prop_map(|halves| halves as f64 / 2.0),
            any::<f64>().prop_filter("in range", |number| number.abs() < 2.0_f64.powi(62)),
        ]) {
            prop_assert_eq!(rounded(number), number.round() as i64);
        }
    }
}
