//! The transfer function of sRGB: from stored channels to linear light, and back.
//!
//! Source: IEC 61966-2-1 (1999). One table of doubles contains the function. It is computed at compile
//! time, and all other tables derive from it. Rejected: a power function at run time, because millions
//! of texels are averaged in linear light.

use super::Rgb;

/// Converts a colour to red, green and blue light, each from 0 to 1.
pub fn linear(color: Rgb) -> [f64; 3] {
    color.channels().map(|channel| LINEAR[usize::from(channel)])
}

/// Converts linear light from 0 to 1 to a channel from 0 to 1, without rounding it to 8 bits.
pub fn encoded(light: f64) -> f64 {
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * libm::pow(light, 1.0 / 2.4) - 0.055 }
}

/// Converts a colour to red, green and blue light in 65535ths, rounded to the nearest.
pub(crate) fn linear_16(color: Rgb) -> [u16; 3] {
    color.channels().map(|channel| LINEAR_16[usize::from(channel)])
}

/// Converts linear light in 65535ths to the nearest colour, or to the lighter one if two are equally
/// near.
pub(crate) fn from_linear_16(light: [u16; 3]) -> Rgb {
    let [red, green, blue] = light.map(|channel| {
        let value = NEAREST[usize::from(channel / SPACING)];
        value + u8::from(u32::from(channel) >= THRESHOLDS[usize::from(value) + 1])
    });
    Rgb::new(red, green, blue)
}

/// The mean of two colours in linear light. A surface that is half of each has this colour from far
/// away.
pub(crate) fn mean_of_two(one: Rgb, other: Rgb) -> Rgb {
    let (one, other) = (linear_16(one), linear_16(other));
    from_linear_16(std::array::from_fn(|channel| one[channel].midpoint(other[channel])))
}

/// The light of each value of a channel, from 0 to 1.
pub(crate) static LINEAR: [f64; 256] = {
    let mut table = [0.0; 256];
    let mut value = 0;
    while value < table.len() {
        table[value] = transfer(value as f64 / 255.0);
        value += 1;
    }
    table
};

/// The light of each value of a channel in 65535ths, rounded to the nearest.
pub(crate) static LINEAR_16: [u16; 256] = {
    let mut table = [0; 256];
    let mut value = 0;
    while value < table.len() {
        table[value] = (transfer(value as f64 / 255.0) * u16::MAX as f64 + 0.5) as u16;
        value += 1;
    }
    table
};

/// The transfer function for a signal from 0 to 1.
const fn transfer(signal: f64) -> f64 {
    if signal <= 0.040_45 {
        return signal / 12.92;
    }
    // base^2.4 = base² · (base²)^(1/5)
    let base = (signal + 0.055) / 1.055;
    let square = base * base;
    square * fifth_root(square)
}

/// The fifth root of a number from 0.001 to 2, by Newton's method.
const fn fifth_root(number: f64) -> f64 {
    const STEPS: u32 = 32;
    let mut root = 1.0;
    let mut step = 0;
    while step < STEPS {
        root = (4.0 * root + number / (root * root * root * root)) / 5.0;
        step += 1;
    }
    root
}

/// The channel value nearest to each multiple of [`SPACING`].
static NEAREST: [u8; (u16::MAX / SPACING) as usize + 1] = {
    let mut table = [0; (u16::MAX / SPACING) as usize + 1];
    let (mut index, mut value) = (0, 0);
    while index < table.len() {
        while index as u32 * SPACING as u32 >= THRESHOLDS[value + 1] {
            value += 1;
        }
        table[index] = value as u8;
        index += 1;
    }
    table
};

/// The least light to which each channel value is nearest, in 65535ths.
static THRESHOLDS: [u32; 257] = {
    let mut table = [0; 257];
    let mut value = 1;
    while value < LINEAR_16.len() {
        table[value] = (LINEAR_16[value - 1] as u32 + LINEAR_16[value] as u32).div_ceil(2);
        value += 1;
    }
    table[value] = u16::MAX as u32 + 1;
    table
};

/// The distance between two entries of [`NEAREST`]. It is less than the distance between the two darkest
/// channel values. Light between two entries therefore maps to the channel value of one of them.
const SPACING: u16 = 16;

#[cfg(test)]
mod tests {
    use super::*;

    /// The power function is the oracle.
    #[test]
    fn the_table_matches_the_standard_function() {
        for (value, &light) in LINEAR.iter().enumerate() {
            let signal = value as f64 / 255.0;
            let expected = if signal <= 0.040_45 {
                signal / 12.92
            } else {
                libm::pow((signal + 0.055) / 1.055, 2.4)
            };
            assert!((light - expected).abs() <= 4.0 * f64::EPSILON * expected, "{value}");
            assert_eq!(LINEAR_16[value], (expected * f64::from(u16::MAX)).round() as u16);
        }
    }

    #[test]
    fn every_channel_survives_a_round_trip_to_linear_light() {
        for channel in 0..=255 {
            let gray = Rgb::new(channel, channel, channel);
            assert_eq!(from_linear_16(linear_16(gray)), gray);
        }
    }

    #[test]
    fn the_nearest_stored_channel_is_found() {
        for light in 0..=u16::MAX {
            let found = from_linear_16([light; 3]).red();
            let least = LINEAR_16.iter().map(|linear| linear.abs_diff(light)).min().unwrap();
            assert_eq!(LINEAR_16[usize::from(found)].abs_diff(light), least, "{light}");
            let is_lighter_as_near = LINEAR_16.contains(&light.saturating_add(least))
                && LINEAR_16[usize::from(found)] < light;
            assert!(least == 0 || !is_lighter_as_near, "{light}");
        }
    }
}
