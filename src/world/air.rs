//! What is between the eye and the walls, and behind them all: light, fog and the sky.

use super::TextureId;
use crate::color::Rgb;

/// How bright a surface is lit, in 256ths of full brightness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Light(u16);

impl Light {
    /// Every colour as it is.
    pub const FULL: Self = Self(256);
    /// Every colour black.
    pub const NONE: Self = Self(0);

    /// A light of `share`, from 0 for darkness to 1 for full brightness. `None` outside that.
    pub fn new(share: f64) -> Option<Self> {
        let full = f64::from(Self::FULL.0);
        (0.0..=1.0).contains(&share).then(|| Self((share * full).round() as u16))
    }

    /// From 0 to 256.
    pub const fn in_256ths(self) -> u32 {
        self.0 as u32
    }

    /// Both together, full at most.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self((self.0 + other.0).min(Self::FULL.0))
    }

    /// On the way from this light to `other`: a share of that way, from 0 to 1.
    #[must_use]
    pub(crate) fn towards(self, other: Self, share: f64) -> Self {
        let (from, to) = (f64::from(self.0), f64::from(other.0));
        Self((from + (to - from) * share).round() as u16)
    }

    /// A share of it, from 0 to 1.
    #[must_use]
    pub(crate) fn dimmed(self, share: f64) -> Self {
        Self((f64::from(self.0) * share).round() as u16)
    }
}

/// A colour that everything fades into with the distance.
///
/// At distance `t` the share of a surface's own colour is `1 / (1 + (t / distance)²)`: nearly all of
/// it close by, half at `distance`, a fifth at twice that. It is smooth, ends nowhere, and costs a
/// division. An exponential was refused: it looks much the same, and takes a table to be as cheap.
/// `t` is the distance to the camera plane, as it is one number for a whole row of the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// What is infinitely far away.
    pub color: Rgb,
    distance: f64,
}

impl Fog {
    /// Fog that hides half of what is `distance` cells away. `None` where that is not above 0 and
    /// finite.
    pub fn new(color: Rgb, distance: f64) -> Option<Self> {
        (distance > 0.0 && distance.is_finite()).then_some(Self { color, distance })
    }

    /// How much shows of a surface at distance `t`, in cells: from 1 at 0 down to 0.
    pub fn clearness(&self, t: f64) -> f64 {
        let relative = t / self.distance;
        1.0 / (1.0 + relative * relative)
    }
}

/// What is seen overhead where there is no ceiling, and beyond the edge of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sky {
    /// From one colour, high up, to another, at the horizon.
    Gradient {
        /// At half a cell up for each cell away, and above.
        zenith: Rgb,
        /// At the height of the eye.
        horizon: Rgb,
    },
    /// A texture all around, as on the inside of a cylinder: its left edge in the east, its bottom
    /// at the horizon, and above its top edge the colours of that. It turns with the heading, and
    /// its texels are as high as they are wide.
    Panorama(TextureId),
}

impl Default for Sky {
    /// A fair day.
    fn default() -> Self {
        Self::Gradient { zenith: Rgb::new(0x5f, 0x97, 0xcc), horizon: Rgb::new(0xb4, 0xd2, 0xe6) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_is_a_share() {
        assert_eq!(Light::new(1.0), Some(Light::FULL));
        assert_eq!(Light::new(0.5).unwrap().in_256ths(), 128);
        for share in [-0.1, 1.1, f64::NAN] {
            assert_eq!(Light::new(share), None);
        }
    }

    #[test]
    fn half_is_left_at_the_distance_of_a_fog() {
        let fog = Fog::new(Rgb::BLACK, 8.0).unwrap();
        assert_eq!([0.0, 8.0, f64::INFINITY].map(|t| fog.clearness(t)), [1.0, 0.5, 0.0]);
        for distance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(Fog::new(Rgb::BLACK, distance), None);
        }
    }
}
