//! Tests of colours for people without red or without green cones.
//!
//! Source: Gustavo Machado, Manuel Oliveira and Leandro Fernandes, "A Physiologically-based Model for
//! Simulation of Color Vision Deficiency" (2009), the matrices for severity 1, in linear light.

use super::oklab::Oklab;
use super::palette::{nearest_of_256, of_256};
use super::srgb::linear;
use super::{Rgb, product};

/// Matrices for the colours that people without green cones, and people without red cones, see.
pub(crate) const BLIND: [[[f64; 3]; 3]; 2] = [
    [
        [0.367_322, 0.860_646, -0.227_968],
        [0.280_085, 0.672_501, 0.047_413],
        [-0.011_820, 0.042_940, 0.968_881],
    ],
    [
        [0.152_286, 1.052_583, -0.204_868],
        [0.114_503, 0.786_281, 0.099_216],
        [-0.003_882, -0.048_116, 1.051_998],
    ],
];

/// The distance between two colours, as seen with one of [`BLIND`].
pub(crate) fn distance([one, other]: [Rgb; 2], blind: &[[f64; 3]; 3]) -> f64 {
    let [one, other] = [one, other].map(|color| {
        let light = product(blind, linear(color));
        Oklab::from_linear(light.map(|channel| channel.clamp(0.0, 1.0)))
    });
    libm::sqrt(one.distance_squared(&other))
}

/// Asserts that everybody can tell each two of `colors` apart, in all colours and in 256. The limit
/// is almost three times the smallest difference that people notice.
#[track_caller]
pub(crate) fn assert_apart(colors: &[(&str, Rgb)]) {
    const MIN_DISTANCE: f64 = 0.055;
    let usual = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for (index, &(one, first)) in colors.iter().enumerate() {
        for &(other, second) in &colors[..index] {
            let pair = [first, second];
            for pair in [pair, pair.map(|color| of_256(nearest_of_256(color)))] {
                for eyes in BLIND.iter().chain([&usual]) {
                    let found = distance(pair, eyes);
                    assert!(found >= MIN_DISTANCE, "{one} {other}: {pair:?} {found} {eyes:?}");
                }
            }
        }
    }
}
