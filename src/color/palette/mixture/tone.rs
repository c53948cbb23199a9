//! A tone curve: the lightness that a palette with few dark colours shows for each lightness.
//!
//! The palette of 256 has no brown darker than a lightness of 0.51 in Oklab, and no red darker than
//! 0.31. Dark surfaces would have to be grey, or grey with bright dots. The curve lifts dark
//! colours, by 0.12 at most, and hardly those that are almost black; colours lighter than 0.65 remain
//! as they are. It increases everywhere, so that textures and light keep their order, and it is the
//! same for all pixels of all pictures. A curve that lifts the darkest most was refused: rooms
//! without light become grey.
//!
//! Red, green and blue light have the same factor, so that hues remain as they are. A table of each
//! channel was refused: it makes dark colours greyer.

use std::array;

use crate::color::Rgb;
use crate::color::srgb::linear;

/// The factors by which the light of pixels is multiplied.
pub(crate) struct ToneCurve([i32; 256]);

impl ToneCurve {
    /// The factor of light that remains as it is.
    pub(crate) const ONE: i32 = 1 << 12;
    /// The most by which the lightness increases.
    const LIFT: f64 = 0.12;
    /// The lightness from which colours remain as they are.
    const END: f64 = 0.65;

    /// The curve that lifts dark colours.
    pub(super) fn lifted() -> Self {
        Self(array::from_fn(|brightness| {
            let level = brightness as u8;
            let lightness = libm::cbrt(linear(Rgb::new(level, level, level))[0]);
            if lightness <= 0.0 {
                return Self::ONE;
            }
            let ratio = Self::lift(lightness) / lightness;
            libm::round(ratio * ratio * ratio * f64::from(Self::ONE)) as i32
        }))
    }

    /// The curve that leaves all colours as they are.
    pub(super) fn unchanged() -> Self {
        Self([Self::ONE; 256])
    }

    /// The factor for the light of a pixel, in parts of [`ToneCurve::ONE`].
    ///
    /// It depends on the mean of the luma and the largest channel: by luma alone, saturated reds and
    /// blues count as dark, which they are not in Oklab.
    #[inline]
    pub(crate) fn factor(&self, pixel: Rgb) -> i32 {
        let [red, green, blue] = pixel.channels();
        self.0[usize::from(pixel.luma().midpoint(red.max(green).max(blue)))]
    }

    fn lift(lightness: f64) -> f64 {
        let part = (lightness / Self::END).min(1.0);
        let hump = 4.0 * part * (1.0 - part);
        lightness + Self::LIFT * hump * hump
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_increases_with_a_slope_below_two() {
        let steps = 1000;
        let of = |step: i32| ToneCurve::lift(f64::from(step) / f64::from(steps));
        for step in 0..steps {
            let (lightness, next) = (of(step), of(step + 1));
            assert!(lightness < next, "{step}");
            assert!(next - lightness < 2.0 / f64::from(steps), "{step}");
        }
        assert_eq!(of(0), 0.0);
        assert_eq!(of(steps), 1.0);
    }

    #[test]
    fn dark_colours_are_lifted_and_others_are_not() {
        let curve = ToneCurve::lifted();
        assert!(curve.factor(Rgb::new(70, 45, 20)) > 3 * ToneCurve::ONE / 2);
        for color in [Rgb::BLACK, Rgb::WHITE, Rgb::new(200, 160, 120)] {
            assert_eq!(curve.factor(color), ToneCurve::ONE);
        }
    }
}
