//! CIE L\*a\*b\* under the standard illuminant D65, in which distance is CIE76's ΔE.
//!
//! Sources: CIE 15 (2004) for L\*a\*b\*; IEC 61966-2-1 (1999) for the primaries of sRGB.
//! Measurements use the doubles of this module, the encoder the integers of `packed`.

#[cfg(feature = "terminal")]
mod packed;

#[cfg(feature = "terminal")]
pub(crate) use packed::PackedLab;

use super::srgb::linear;
use super::{Rgb, product};

/// A colour in L\*a\*b\*.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lab([f64; 3]);

impl Lab {
    /// The distance of two colours by CIE76, ΔE. Most people notice a difference of about 2.3 or
    /// more.
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

#[cfg(test)]
mod tests {
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
}
