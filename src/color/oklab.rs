//! Oklab, a colour space in which distance is perceived difference.
//!
//! Source: Björn Ottosson, "A perceptual color space for image processing" (2020),
//! <https://bottosson.github.io/posts/oklab/>. People notice a difference of about 0.02 or more.
//! Rejected for choosing among few colours: CIE L\*a\*b\*, whose blues turn purple when they are
//! mixed with grey.

use super::srgb::linear;
use super::{Rgb, product};

/// A colour as its lightness, its red–green component and its yellow–blue component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oklab(pub [f64; 3]);

impl Oklab {
    /// Converts red, green and blue light, each from 0 to 1.
    pub fn from_linear(light: [f64; 3]) -> Self {
        Self(product(&FROM_CONE_ROOTS, cones(light).map(libm::cbrt)))
    }

    /// The square of the distance between two colours.
    pub fn distance_squared(&self, other: &Self) -> f64 {
        self.0.iter().zip(other.0).map(|(one, other)| (one - other) * (one - other)).sum()
    }
}

impl From<Rgb> for Oklab {
    fn from(color: Rgb) -> Self {
        Self::from_linear(linear(color))
    }
}

/// The responses of the long, medium and short wave cones to linear sRGB.
pub(crate) fn cones(light: [f64; 3]) -> [f64; 3] {
    product(&FROM_LINEAR, light)
}

/// The matrix from the cube roots of cone responses to Oklab.
const FROM_CONE_ROOTS: [[f64; 3]; 3] = [
    [0.210_454_26, 0.793_617_8, -0.004_072_05],
    [1.977_998_5, -2.428_592_2, 0.450_593_7],
    [0.025_904_04, 0.782_771_77, -0.808_675_77],
];

/// The matrix from linear sRGB to cone responses.
const FROM_LINEAR: [[f64; 3]; 3] = [
    [0.412_221_47, 0.536_332_54, 0.051_445_99],
    [0.211_903_5, 0.680_699_55, 0.107_396_96],
    [0.088_302_46, 0.281_718_84, 0.629_978_7],
];

#[cfg(test)]
mod tests {
    use super::*;

    /// The expected values are from Ottosson's page.
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
