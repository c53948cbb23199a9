//! Colours as people tell them apart: CIE L*a*b* under the light D65.

use std::sync::LazyLock;

use crate::color::Rgb;

/// The distance of two colours, CIE76's ΔE: about 2.3 is the least that most people notice.
pub(super) fn distance(one: Rgb, other: Rgb) -> f64 {
    if one == other {
        return 0.0;
    }
    let (one, other) = (lab(one), lab(other));
    let squares = one.iter().zip(other).map(|(one, other)| (one - other) * (one - other));
    libm::sqrt(squares.sum())
}

fn lab(color: Rgb) -> [f64; 3] {
    let [red, green, blue] = color.channels().map(|channel| LINEAR[usize::from(channel)]);
    let tristimulus = |[r, g, b]: [f64; 3]| r * red + g * green + b * blue;
    let [x, y, z] = SRGB_TO_XYZ.map(tristimulus);
    let [x, y, z] = [x / WHITE[0], y / WHITE[1], z / WHITE[2]].map(response);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// sRGB's primaries in XYZ, by row.
const SRGB_TO_XYZ: [[f64; 3]; 3] = [
    [0.412_456_4, 0.357_576_1, 0.180_437_5],
    [0.212_672_9, 0.715_152_2, 0.072_175_0],
    [0.019_333_9, 0.119_192_0, 0.950_304_1],
];
/// D65, which is what sRGB's white is.
const WHITE: [f64; 3] = [0.950_470, 1.0, 1.088_830];

/// The light that each value of a channel gives off.
static LINEAR: LazyLock<[f64; 256]> = LazyLock::new(|| {
    std::array::from_fn(|value| {
        let value = value as f64 / 255.0;
        if value <= 0.04045 { value / 12.92 } else { libm::pow((value + 0.055) / 1.055, 2.4) }
    })
});

/// The eye's answer to light: a cube root, and a line where it would be too steep.
fn response(light: f64) -> f64 {
    const KNEE: f64 = 6.0 / 29.0;
    if light > KNEE * KNEE * KNEE {
        libm::cbrt(light)
    } else {
        light / (3.0 * KNEE * KNEE) + 4.0 / 29.0
    }
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
            let found = lab(color);
            let is_near = |(found, expected): (&f64, f64)| (found - expected).abs() < 0.02;
            assert!(found.iter().zip(expected).all(is_near), "{color:?} {found:?}");
        }
    }

    #[test]
    fn the_distance_of_black_and_white_is_100() {
        let (black, white) = (Rgb::new(0, 0, 0), Rgb::new(255, 255, 255));
        assert!((distance(black, white) - 100.0).abs() < 0.01);
        assert_eq!(distance(white, white), 0.0);
    }
}
