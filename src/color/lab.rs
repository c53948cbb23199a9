//! CIE L\*a\*b\* under the standard illuminant D65. The distance between two colours is CIE76's ΔE.
//!
//! Sources: CIE 15 (2004) for L\*a\*b\*; IEC 61966-2-1 (1999) for the primaries of sRGB.
//!
//! Measurements use the doubles of [`Lab`]. The encoder, which converts millions of colours per second,
//! uses the integers of `PackedLab`. There, both nonlinear functions (of sRGB and of L\*a\*b\*) are
//! tables computed at compile time, and distances differ from the distances of `Lab` by less than 0.1.
//! Rejected: a weighted distance of red, green and blue. At the same mean ΔE the encoder took a third
//! more bytes, most of them for dark colours.

#[cfg(feature = "terminal")]
use super::srgb::LINEAR_16;
use super::srgb::linear;
use super::{Rgb, product};

/// A colour in L\*a\*b\*.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lab([f64; 3]);

impl Lab {
    /// The CIE76 distance ΔE between two colours. Most people notice a difference of about 2.3 or more.
    pub fn distance(self, other: Self) -> f64 {
        let squares = self.0.iter().zip(other.0).map(|(one, other)| (one - other) * (one - other));
        libm::sqrt(squares.sum())
    }
}

impl From<Rgb> for Lab {
    fn from(color: Rgb) -> Self {
        let [x, y, z] = product(&SRGB_TO_XYZ, linear(color));
        let [x, y, z] = [x / WHITE[0], y / WHITE[1], z / WHITE[2]]
            .map(|light| response(light, libm::cbrt(light)));
        Self([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)])
    }
}

/// The matrix from linear sRGB to XYZ, by rows.
const SRGB_TO_XYZ: [[f64; 3]; 3] = [
    [0.412_456_4, 0.357_576_1, 0.180_437_5],
    [0.212_672_9, 0.715_152_2, 0.072_175_0],
    [0.019_333_9, 0.119_192_0, 0.950_304_1],
];
/// The illuminant D65, the white of sRGB, in XYZ.
const WHITE: [f64; 3] = [0.950_470, 1.0, 1.088_830];

/// The nonlinear function of L\*a\*b\*: the cube root, with a linear segment where the root would
/// be too steep.
const fn response(light: f64, cube_root: f64) -> f64 {
    const KNEE: f64 = 6.0 / 29.0;
    if light > KNEE * KNEE * KNEE { cube_root } else { light / (3.0 * KNEE * KNEE) + 4.0 / 29.0 }
}

/// A colour in L\*a\*b\*, in 64ths.
#[cfg(feature = "terminal")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct PackedLab([i16; 3]);

/// The number of steps in a ΔE of 1.
#[cfg(feature = "terminal")]
const STEPS: f32 = 64.0;

#[cfg(feature = "terminal")]
impl PackedLab {
    /// Converts an sRGB colour.
    #[inline]
    pub(crate) fn of(channels: [u8; 3]) -> Self {
        let light = |channel: usize| u32::from(LINEAR_16[usize::from(channels[channel])]);
        let (red, green, blue) = (light(0), light(1), light(2));
        let tristimulus =
            |[r, g, b]: [u32; 3]| packed_response((r * red + g * green + b * blue) >> 16);
        let [to_x, to_y, to_z] = LIGHT_TO_XYZ;
        let (x, y, z) = (tristimulus(to_x), tristimulus(to_y), tristimulus(to_z));
        // A response has 21 fractional bits, and a component has 6.
        let steps = |response: i32| (response >> 15) as i16;
        Self([steps(116 * y) - 16 * STEPS as i16, steps(500 * (x - y)), steps(200 * (y - z))])
    }

    /// L*, a* and b*.
    #[inline]
    pub(crate) fn components(self) -> [f32; 3] {
        self.0.map(|steps| f32::from(steps) * (1.0 / STEPS))
    }
}

/// The matrix from linear light to XYZ relative to white, in 65536ths; each row sums to one.
#[cfg(feature = "terminal")]
const LIGHT_TO_XYZ: [[u32; 3]; 3] =
    [[28_440, 24_656, 12_440], [13_938, 46_868, 4_730], [1_164, 7_174, 57_198]];

/// The amount of light between two entries of [`RESPONSE`], in 65535ths.
#[cfg(feature = "terminal")]
const SPACING: u32 = 64;

/// The nonlinear function of L\*a\*b\* at every multiple of [`SPACING`], in 32768ths.
#[cfg(feature = "terminal")]
static RESPONSE: [u16; 1025] = {
    let mut table = [0; 1025];
    let mut index = 0;
    while index < table.len() {
        let light = index as f64 * SPACING as f64 / 65_535.0;
        let response = response(light, cube_root(light));
        table[index] = (response * 32_768.0 + 0.5) as u16;
        index += 1;
    }
    table
};

/// The nonlinear function of L\*a\*b\* for `light` in 65536ths. The result has 21 fractional bits and
/// is interpolated between two entries of [`RESPONSE`].
#[cfg(feature = "terminal")]
#[inline]
fn packed_response(light: u32) -> i32 {
    let index = (light / SPACING) as usize;
    let (lower, upper) = (i32::from(RESPONSE[index]), i32::from(RESPONSE[index + 1]));
    lower * SPACING as i32 + (upper - lower) * (light % SPACING) as i32
}

/// The cube root of a number between 0.001 and 2, by Newton's method, at compile time.
#[cfg(feature = "terminal")]
const fn cube_root(number: f64) -> f64 {
    let mut root = 1.0;
    let mut step = 0;
    while step < NEWTON_STEPS {
        root = (2.0 * root + number / (root * root)) / 3.0;
        step += 1;
    }
    root
}

#[cfg(feature = "terminal")]
const NEWTON_STEPS: u32 = 32;

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn known_colours_have_their_known_values() {
        for (color, expected) in [
            (Rgb::new(255, 255, 255), [100.0, 0.0, 0.0]),
            (Rgb::new(0, 0, 0), [0.0, 0.0, 0.0]),
            (Rgb::new(255, 0, 0), [53.24, 80.09, 67.20]),
            (Rgb::new(0, 0, 255), [32.30, 79.19, -107.86]),
            (Rgb::new(119, 119, 119), [50.03, 0.0, 0.0]),
        ] {
            let Lab(found) = Lab::from(color);
            let is_near = |(found, expected): (&f64, f64)| (found - expected).abs() < 0.02;
            assert!(found.iter().zip(expected).all(is_near), "{color:?} {found:?}");
        }
    }

    #[test]
    fn black_and_white_are_100_apart() {
        let [black, white] = [Rgb::BLACK, Rgb::WHITE].map(Lab::from);
        assert!((black.distance(white) - 100.0).abs() < 0.01);
        assert_eq!(white.distance(white), 0.0);
    }

    fn distance(one: [f64; 3], other: [f64; 3]) -> f64 {
        libm::sqrt(one.into_iter().zip(other).map(|(a, b)| (a - b) * (a - b)).sum())
    }

    /// The oracle: the standard's formulas in doubles. It shares no table with the code.
    fn exact([red, green, blue]: [u8; 3]) -> [f64; 3] {
        let linear = |channel: u8| {
            let signal = f64::from(channel) / 255.0;
            if signal <= 0.040_45 {
                signal / 12.92
            } else {
                libm::pow((signal + 0.055) / 1.055, 2.4)
            }
        };
        let [r, g, b] = [linear(red), linear(green), linear(blue)];
        let response = |light: f64| {
            if light > 0.008_856_451_679 {
                libm::cbrt(light)
            } else {
                7.787_037_037 * light + 4.0 / 29.0
            }
        };
        let x = response((0.412_456_4 * r + 0.357_576_1 * g + 0.180_437_5 * b) / 0.950_47);
        let y = response(0.212_672_9 * r + 0.715_152_2 * g + 0.072_175 * b);
        let z = response((0.019_333_9 * r + 0.119_192 * g + 0.950_304_1 * b) / 1.088_83);
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn distances_match_the_standard(one: [u8; 3], other: [u8; 3]) {
            let [found, other_found] = [one, other].map(|color| PackedLab::of(color).components());
            let found = distance(found.map(f64::from), other_found.map(f64::from));
            let expected = distance(exact(one), exact(other));
            prop_assert!((found - expected).abs() < 0.1, "{} {}", found, expected);
        }
    }

    #[test]
    fn greys_have_no_hue() {
        for value in 0..=255 {
            let PackedLab([lightness, a, b]) = PackedLab::of([value; 3]);
            assert_eq!((a, b), (0, 0), "{value}");
            assert!((0..=6400).contains(&lightness), "{value}: {lightness}");
        }
    }
}
