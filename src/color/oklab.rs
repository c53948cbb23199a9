//! Colours as people tell them apart: Oklab, and the amounts of light that it is made of.
//!
//! Oklab is Björn Ottosson's ("A perceptual color space for image processing", 2020): a difference of
//! 0.02 is about the least that people notice. CIE L\*a\*b\* was refused here, as its blues turn purple
//! where they are mixed with grey.

use std::sync::LazyLock;

use super::Rgb;

/// A colour by how light, how red and how yellow it looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Oklab(pub(crate) [f64; 3]);

impl Oklab {
    /// The colour of red, green and blue light, each from 0 to 1.
    pub(crate) fn from_linear(light: [f64; 3]) -> Self {
        let [long, medium, short] = cones(light).map(libm::cbrt);
        Self([
            0.210_454_26 * long + 0.793_617_8 * medium - 0.004_072_05 * short,
            1.977_998_5 * long - 2.428_592_2 * medium + 0.450_593_7 * short,
            0.025_904_04 * long + 0.782_771_77 * medium - 0.808_675_77 * short,
        ])
    }

    /// The square of the distance of two colours.
    pub(crate) fn distance_squared(&self, other: &Self) -> f64 {
        self.0.iter().zip(other.0).map(|(one, other)| (one - other) * (one - other)).sum()
    }
}

impl From<Rgb> for Oklab {
    fn from(color: Rgb) -> Self {
        Self::from_linear(light(color))
    }
}

/// What the eye's three kinds of cones take of light.
pub(super) fn cones([red, green, blue]: [f64; 3]) -> [f64; 3] {
    [
        0.412_221_47 * red + 0.536_332_54 * green + 0.051_445_99 * blue,
        0.211_903_5 * red + 0.680_699_55 * green + 0.107_396_96 * blue,
        0.088_302_46 * red + 0.281_718_84 * green + 0.629_978_7 * blue,
    ]
}

/// The red, green and blue light of a colour, each from 0 to 1.
pub(crate) fn light(color: Rgb) -> [f64; 3] {
    static LIGHT: LazyLock<[f64; 256]> = LazyLock::new(|| {
        std::array::from_fn(|value| {
            let share = value as f64 / 255.0;
            if share <= 0.040_45 { share / 12.92 } else { libm::pow((share + 0.055) / 1.055, 2.4) }
        })
    });
    color.channels().map(|channel| LIGHT[usize::from(channel)])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The values of Ottosson's page.
    #[test]
    fn known_colours_have_their_known_values() {
        for (color, expected) in [
            (Rgb::WHITE, [1.0, 0.0, 0.0]),
            (Rgb::BLACK, [0.0, 0.0, 0.0]),
            (Rgb::new(255, 0, 0), [0.628, 0.225, 0.126]),
            (Rgb::new(0, 255, 0), [0.866, -0.234, 0.179]),
            (Rgb::new(0, 0, 255), [0.452, -0.032, -0.312]),
        ] {
            let found = Oklab::from(color).0;
            let is_near = |(found, expected): (&f64, f64)| (found - expected).abs() < 0.001;
            assert!(found.iter().zip(expected).all(is_near), "{color:?} {found:?}");
        }
    }
}
