//! Light, fog and sky.

use super::TextureId;
use crate::color::Rgb;

/// The light on a surface, in 256ths of full brightness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Light(u16);

impl Light {
    /// Full brightness: colours are unchanged.
    pub const FULL: Self = Self(256);
    /// Darkness: every colour is black.
    pub const NONE: Self = Self(0);

    /// A light from 0 (darkness) to 1 (full brightness). `None` outside that range.
    pub fn new(share: f64) -> Option<Self> {
        let full = f64::from(Self::FULL.0);
        (0.0..=1.0).contains(&share).then(|| Self((share * full).round() as u16))
    }

    /// The light as a number from 0 to 256.
    pub const fn in_256ths(self) -> u32 {
        self.0 as u32
    }

    /// A light of this many 256ths, at most full brightness.
    pub(crate) fn saturated(in_256ths: u32) -> Self {
        Self(in_256ths.min(u32::from(Self::FULL.0)) as u16)
    }

    /// The sum of two lights, at most full brightness.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self((self.0 + other.0).min(Self::FULL.0))
    }

    /// A light between this one and `other`: this one for a `share` of 0, `other` for 1.
    #[must_use]
    pub(crate) fn towards(self, other: Self, share: f64) -> Self {
        let (from, to) = (f64::from(self.0), f64::from(other.0));
        Self((from + (to - from) * share).round() as u16)
    }

    /// The light multiplied by a share from 0 to 1.
    #[must_use]
    pub(crate) fn dimmed(self, share: f64) -> Self {
        Self((f64::from(self.0) * share).round() as u16)
    }
}

/// A colour that everything fades into with distance.
///
/// At distance `t`, the share of a surface's own colour is `1 / (1 + (t / distance)²)`: nearly 1
/// nearby, a half at `distance`, a fifth at twice that. The function is smooth and costs one
/// division. An exponential was refused: it looks much the same, and needs a table to be as cheap.
/// `t` is the distance to the camera plane, which is the same for a whole row of the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// The colour at an infinite distance.
    pub color: Rgb,
    distance: f64,
}

impl Fog {
    /// Fog that hides half of what is `distance` cells away. `None` unless `distance` is finite and
    /// above 0.
    pub fn new(color: Rgb, distance: f64) -> Option<Self> {
        (distance > 0.0 && distance.is_finite()).then_some(Self { color, distance })
    }

    /// The share of a surface's own colour at distance `t`, in cells: from 1 at 0 down to 0.
    pub fn clearness(&self, t: f64) -> f64 {
        let relative = t / self.distance;
        1.0 / (1.0 + relative * relative)
    }

    /// A distance up to which the share is at least this one, from 0 to 1. Little beyond it, it is less.
    #[cfg_attr(not(feature = "tui"), expect(dead_code, reason = "only the minimap needs it"))]
    pub(crate) fn clear_to(&self, clearness: f64) -> f64 {
        /// Less than 1, by more than rounding.
        const ALMOST: f64 = 1.0 - 1e-9;
        let distance = self.distance * (1.0 / clearness - 1.0).sqrt() * ALMOST;
        if self.clearness(distance) < clearness { 0.0 } else { distance }
    }
}

/// The sky: what shows where there is no ceiling, and outside the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sky {
    /// From one colour overhead to another at the horizon.
    Gradient(SkyGradient),
    /// A texture on the inside of a cylinder around the camera. Its left edge is east, its bottom
    /// is the horizon, and above it the colours of its top edge continue. It turns with the
    /// heading; its texels are square.
    Panorama(TextureId),
}

impl Default for Sky {
    fn default() -> Self {
        Self::Gradient(SkyGradient::default())
    }
}

/// A sky that changes from one colour to another between the horizon and a slope of 1/2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SkyGradient {
    /// The colour at and above a slope of 1/2.
    pub zenith: Rgb,
    /// The colour at and below the height of the eye.
    pub horizon: Rgb,
}

impl Default for SkyGradient {
    /// A blue sky by day.
    fn default() -> Self {
        Self { zenith: Rgb::new(0x5f, 0x97, 0xcc), horizon: Rgb::new(0xb4, 0xd2, 0xe6) }
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
