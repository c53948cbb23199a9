//! Light: the sun, the ambient light, and the sky.

use glam::DVec3;

use crate::color::Rgb;
use crate::numeric::rounding::rounded_short;
use crate::world::SkyGradient;

/// A fraction from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fraction(f64);

impl Fraction {
    /// The fraction, if it is from 0 to 1.
    pub fn new(fraction: f64) -> Option<Self> {
        (0.0..=1.0).contains(&fraction).then_some(Self(fraction))
    }

    /// The fraction, from 0 to 1.
    pub fn get(self) -> f64 {
        self.0
    }
}

/// The directional light of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    toward: DVec3,
    /// The brightness of a surface that the sun does not reach.
    pub ambient: Fraction,
}

impl Sun {
    /// A sun in the direction `toward`, of any length. `None` if the direction is zero or not
    /// finite.
    pub fn new(toward: DVec3, ambient: Fraction) -> Option<Self> {
        let largest = toward.abs().max_element();
        let has_direction = toward.is_finite() && largest > 0.0;
        has_direction.then(|| Self { toward: (toward / largest).normalize(), ambient })
    }

    /// The unit vector towards the sun.
    pub fn toward(&self) -> DVec3 {
        self.toward
    }

    /// The brightness of a surface with this unit normal, from the ambient fraction to 1. It is
    /// Lambert's cosine law ("Photometria", 1760): proportional to the cosine of the angle to the
    /// sun.
    pub fn brightness(&self, normal: DVec3) -> f64 {
        let Fraction(ambient) = self.ambient;
        ambient + (1.0 - ambient) * self.toward.dot(normal).clamp(0.0, 1.0)
    }
}

impl Default for Sun {
    /// A sun high in the north-west.
    fn default() -> Self {
        const TOWARD: DVec3 = DVec3::new(-2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0);
        Self { toward: TOWARD, ambient: Fraction(0.2) }
    }
}

/// The colour of a sky in this direction. It changes linearly with the slope.
pub(crate) fn sky_color(sky: SkyGradient, direction: DVec3) -> Rgb {
    sky.zenith.over(sky.horizon, sky_share(direction) as u8)
}

/// The share of the zenith's colour in this direction, in 255ths.
#[inline(always)]
pub(crate) fn sky_share(direction: DVec3) -> u32 {
    const STEEPEST: f64 = 0.5;
    let DVec3 { x, y, z } = direction;
    let away = (x * x + y * y).sqrt();
    let height = z / STEEPEST;
    let above = if height > 0.0 { height } else { 0.0 };
    let height = if above < away { above } else { away };
    // Straight up or down, the horizontal distance is zero.
    let vertical = if z > 0.0 { 1.0 } else { 0.0 };
    let share = if away > 0.0 { height / away } else { vertical };
    rounded_short(share * 255.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surfaces_towards_the_sun_are_bright_and_others_ambient() {
        let sun = Sun::new(DVec3::new(0.0, 0.0, 1e-200), Fraction(0.25)).unwrap();
        assert_eq!(sun.brightness(DVec3::Z), 1.0);
        assert_eq!(sun.brightness(DVec3::X), 0.25);
        assert_eq!(sun.brightness(-DVec3::Z), 0.25);
        assert_eq!(Sun::new(DVec3::ZERO, Fraction(0.0)), None);
    }

    #[test]
    fn the_sky_is_above() {
        let sky = SkyGradient::default();
        assert_eq!(sky_color(sky, DVec3::Z), sky.zenith);
        assert_eq!(sky_color(sky, DVec3::new(1.0, 0.0, 0.5)), sky.zenith);
        assert_eq!(sky_color(sky, DVec3::X), sky.horizon);
        assert_eq!(sky_color(sky, -DVec3::Z), sky.horizon);
    }
}
