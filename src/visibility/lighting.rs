//! Lighting: the effect of light and fog on the colours of a surface.
//!
//! Each row of floor and each column of wall has one lighting. It is applied to many colours at once, with
//! several channels per instruction. It is not applied at all if everything is near and fully lit.

use glam::DVec2;

use crate::cast::Side;
use crate::color::Rgb;
use crate::numeric::rounding::rounded;
use crate::world::texture::MipLevel;
use crate::world::{Fog, Light};

/// The fade of colours towards black or the fog's colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Lighting {
    /// The weight of the surface's own colour, in 256ths.
    own: u32,
    fog: Rgb,
    /// The weight of the fog's colour, in 256ths. Both weights add up to at most 256.
    share: u32,
}

impl Lighting {
    /// No effect.
    pub(crate) const FULL: Self = Self { own: FULL, fog: Rgb::BLACK, share: 0 };

    /// The lighting of a floor, a ceiling or a billboard in this light and at this distance.
    pub(crate) fn of_plane(light: Light, fog: Option<Fog>, distance: f64) -> Self {
        Self::new(light.in_256ths(), fog, distance)
    }

    /// The lighting of a side of a wall. A y-side has half brightness, so that the edge between x-sides and
    /// y-sides shows.
    pub(crate) fn of_wall(side: Side, light: Light, fog: Option<Fog>, distance: f64) -> Self {
        let light = match side {
            Side::X => light.in_256ths(),
            Side::Y => light.in_256ths() / 2,
        };
        Self::new(light, fog, distance)
    }

    /// The lighting of a surface with this `normal`, a vector of length 1. A surface parallel to an x-side or a
    /// y-side has the lighting of that side. The lighting of an oblique one is between both.
    pub(crate) fn of_surface(normal: DVec2, light: Light, fog: Option<Fog>, distance: f64) -> Self {
        let share = f64::midpoint(1.0, normal.x * normal.x);
        Self::new((f64::from(light.in_256ths()) * share) as u32, fog, distance)
    }

    fn new(light: u32, fog: Option<Fog>, distance: f64) -> Self {
        let Some(fog) = fog else { return Self { own: light, fog: Rgb::BLACK, share: 0 } };
        let clear = rounded(fog.clearness(distance) * f64::from(FULL)) as u32;
        Self { own: light * clear / FULL, fog: fog.color, share: FULL - clear }
    }

    /// Returns true if it changes no colour.
    #[inline]
    pub(crate) fn is_full(self) -> bool {
        self.own == FULL
    }

    #[inline]
    pub(crate) fn apply(self, color: Rgb) -> Rgb {
        color.blended(self.own, self.fog, self.share)
    }

    /// Applies the lighting to each of `colors`.
    pub(crate) fn apply_to_all(self, colors: &mut [Rgb]) {
        if !self.is_full() {
            Rgb::blend_all(colors, self.own, self.fog, self.share);
        }
    }

    /// The texels of `level` in this lighting, column by column, if the level stores them: in full light and at
    /// half brightness.
    #[inline]
    pub(crate) fn stored_texels(self, level: &MipLevel) -> Option<&[Rgb]> {
        match (self.own, self.share) {
            (FULL, _) => Some(level.texels()),
            (HALF, 0) => Some(level.halved_texels()),
            _ => None,
        }
    }
}

/// The whole of a colour and half of it, in 256ths.
const FULL: u32 = Light::FULL.in_256ths();
const HALF: u32 = FULL / 2;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_near_lit_colour_is_unchanged() {
        let fog = Fog::new(Rgb::new(9, 9, 9), 4.0);
        assert!(Lighting::of_plane(Light::FULL, fog, 0.0).is_full());
        assert!(Lighting::of_plane(Light::FULL, None, 100.0).is_full());
        let wall = Lighting::of_wall(Side::Y, Light::FULL, fog, 0.0);
        assert_eq!(wall.apply(Rgb::WHITE), Rgb::WHITE.halved());
    }

    #[test]
    fn a_grid_aligned_surface_is_as_bright_as_a_wall() {
        let light = Light::new(0.7).unwrap();
        for (normal, side) in [(DVec2::X, Side::X), (-DVec2::X, Side::X), (DVec2::Y, Side::Y)] {
            let wall = Lighting::of_wall(side, light, None, 3.0);
            assert_eq!(Lighting::of_surface(normal, light, None, 3.0), wall);
        }
    }

    #[test]
    fn a_far_colour_is_fog_in_any_light() {
        let fog = Fog::new(Rgb::new(10, 20, 30), 4.0).unwrap();
        for light in [0.0, 0.3, 1.0].map(|share| Light::new(share).unwrap()) {
            let far = Lighting::of_wall(Side::X, light, Some(fog), f64::INFINITY);
            assert_eq!(far.apply(Rgb::WHITE), fog.color);
            let half = Lighting::of_plane(light, Some(fog), 4.0);
            assert!(half.apply(Rgb::WHITE).red() >= fog.color.red() / 2);
        }
    }
}
