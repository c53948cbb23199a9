//! Rounding of doubles by addition.
//!
//! From [`INTEGERS`] to twice that number, the doubles are exactly the integers. Adding [`INTEGERS`] to a
//! number therefore rounds it to an integer, which is in the lower bits of the sum.
//!
//! Rejected: the processor's rounding instruction. The oldest x86-64 processors lack it, and the standard
//! library calls a function there. Rejected: a conversion to an integer. It saturates, which takes
//! comparisons; it takes twice as long as the addition, and it is not vectorized.

/// The addend for numbers of at least 0.
const INTEGERS: f64 = (1_u64 << (f64::MANTISSA_DIGITS - 1)) as f64;
/// The addend for numbers of either sign.
const SIGNED: f64 = 1.5 * INTEGERS;

/// The nearest integer. Ties are rounded away from 0, and values beyond 64 bits wrap around.
#[inline]
pub(crate) fn rounded(number: f64) -> i64 {
    const MAX: f64 = (1_u64 << (f64::MANTISSA_DIGITS - 2)) as f64;
    let sum = number + SIGNED;
    let rest = number - (sum - SIGNED);
    // The addition rounds ties to even.
    if number.abs() < MAX && rest.abs() < 0.5 {
        sum.to_bits().wrapping_sub(SIGNED.to_bits()) as i64
    } else {
        rounded_tie_or_large(number)
    }
}

/// The nearest integer, for numbers from 0 to 2⁶². Ties below 2⁵¹ are rounded to even.
#[inline]
pub(crate) fn rounded_to_even(number: f64) -> i64 {
    if number < INTEGERS / 2.0 {
        (number + SIGNED).to_bits().wrapping_sub(SIGNED.to_bits()) as i64
    } else {
        // Every double of this size is an integer or an integer plus one half, which is truncated.
        number as i64
    }
}

#[cold]
#[inline(never)]
fn rounded_tie_or_large(number: f64) -> i64 {
    const LARGE: f64 = (1_u64 << 62) as f64;
    if number.abs() >= LARGE {
        // Every double of this size is an integer.
        return number as i128 as i64;
    }
    let whole = number as i64;
    let rest = number - whole as f64;
    whole + i64::from(rest >= 0.5) - i64::from(rest <= -0.5)
}

/// The largest integer not above `number`, for numbers from −2⁶² to 2⁶².
#[inline]
pub(crate) fn floor(number: f64) -> i64 {
    const MAX: f64 = (1_u64 << 62) as f64;
    let whole = number.clamp(-MAX, MAX) as i64;
    whole - i64::from(whole as f64 > number)
}

/// The least integer not below `number`, for numbers from −2⁶² to 2⁶².
#[inline]
pub(crate) fn ceil(number: f64) -> i64 {
    -floor(-number)
}

/// The least integer not below `number`, clamped to the range from 0 to `most`. `most` must be an integer
/// of at most 32 bits. Returns 0 for NaN.
#[inline]
pub(crate) fn ceil_within(most: f64, number: f64) -> u32 {
    let number = number.max(0.0).min(most);
    let sum = number + INTEGERS;
    let nearest = sum - INTEGERS;
    sum.to_bits() as u32 + u32::from(nearest < number)
}

/// The largest integer not above `number`, which must be between −2³¹ and 2³¹.
#[cfg(feature = "tui")]
#[inline]
pub(crate) fn floor_short(number: f64) -> i64 {
    let sum = number + SIGNED;
    // The lower bits of the sum are the nearest integer.
    let nearest = sum.to_bits() as i32;
    i64::from(nearest) - i64::from(sum - SIGNED > number)
}

/// The largest integer not above `number`, as a double.
#[expect(clippy::inline_always, reason = "its loops over lanes are vectorized")]
#[inline(always)]
pub(crate) fn floor_double(number: f64) -> f64 {
    let shift = INTEGERS.copysign(number);
    let near = (number + shift) - shift;
    let below = near - if near > number { 1.0 } else { 0.0 };
    if number.abs() < INTEGERS { below } else { number }
}

/// The largest integer not above `number`, as a double, for numbers from −2⁵⁰ to 2⁵⁰.
#[expect(clippy::inline_always, reason = "its loops over lanes are vectorized")]
#[inline(always)]
pub(crate) fn floor_of_small(number: f64) -> f64 {
    let near = (number + SIGNED) - SIGNED;
    near - if near > number { 1.0 } else { 0.0 }
}

/// The integer nearest to `number`, which must be from 0 to 2³¹. Ties are rounded up. Returns 0 for NaN.
#[expect(clippy::inline_always, reason = "its loops over lanes are vectorized")]
#[inline(always)]
pub(crate) fn rounded_short(number: f64) -> u32 {
    let sum = number + INTEGERS;
    // The addition rounds ties to even.
    let is_rounded_down = number - (sum - INTEGERS) == 0.5;
    sum.to_bits() as u32 + u32::from(is_rounded_down)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn ceilings_stay_within_bounds() {
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
        fn ties_round_away_from_zero(number in prop_oneof![
            (-1_i64 << 40..1 << 40).prop_map(|halves| halves as f64 / 2.0),
            any::<f64>().prop_filter("in range", |number| number.abs() < 2.0_f64.powi(62)),
        ]) {
            prop_assert_eq!(rounded(number), number.round() as i64);
        }
    }

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
        fn doubles_round_as_in_the_standard_library(number in number()) {
            prop_assert_eq!(floor_double(number), number.floor());
            if number.abs() <= 2.0_f64.powi(50) {
                prop_assert_eq!(floor_of_small(number), number.floor());
            }
            #[cfg(feature = "tui")]
            if number.abs() < 2.0_f64.powi(31) {
                prop_assert_eq!(floor_short(number), number.floor() as i64);
            }
            if (0.0..2.0_f64.powi(31)).contains(&number) {
                prop_assert_eq!(rounded_short(number), number.round() as u32);
            }
        }
    }

    #[test]
    fn nan_floors_to_nan_and_rounds_to_zero() {
        assert!(floor_double(f64::NAN).is_nan() && floor_of_small(f64::NAN).is_nan());
        assert_eq!(rounded_short(f64::NAN), 0);
    }
}
