//! Lighting: the effect of light and fog on the colour of a texel.
//!
//! Each row of floor and each column of wall has one lighting. It is applied to many colours at once, with
//! several channels per instruction. It is not applied at all if everything is near and fully lit.

use glam::DVec2;

use crate::cast::Side;
use crate::color::Rgb;
use crate::numeric::rounding::rounded;
use crate::world::texture::MipLevel;
use crate::world::{Fog, Light};

/// The effect of light and fog on colours.
pub(crate) trait Lighting: Copy + PartialEq {
    /// `true` if mip levels store texels in this lighting.
    const HAS_TEXELS: bool;

    fn apply(self, color: Rgb) -> Rgb;

    /// Applies the lighting to each of `colors`.
    fn apply_to_all(self, colors: &mut [Rgb]);

    /// The texels of `level`, column by column: lit if the level stores them in this lighting, else unlit.
    fn texels(self, level: &MipLevel) -> &[Rgb];
}

/// No effect: the surface is near and in full light.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct FullyLit;

/// Half brightness on a y-side, so that the edge between x-sides and y-sides shows.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct SideLit(pub(crate) Side);

/// A fade towards black or the fog's colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Faded {
    /// The weight of the surface's own colour, in 256ths.
    own: u32,
    fog: Rgb,
    /// The weight of the fog's colour, in 256ths. Both weights add up to at most 256.
    share: u32,
}

impl Lighting for FullyLit {
    const HAS_TEXELS: bool = true;

    #[inline]
    fn apply(self, color: Rgb) -> Rgb {
        color
    }

    #[inline]
    fn apply_to_all(self, _: &mut [Rgb]) {}

    #[inline]
    fn texels(self, level: &MipLevel) -> &[Rgb] {
        level.texels()
    }
}

impl Lighting for SideLit {
    const HAS_TEXELS: bool = true;

    #[inline]
    fn apply(self, color: Rgb) -> Rgb {
        match self.0 {
            Side::X => color,
            Side::Y => color.halved(),
        }
    }

    #[inline]
    fn apply_to_all(self, colors: &mut [Rgb]) {
        if self.0 == Side::Y {
            for color in colors {
                *color = color.halved();
            }
        }
    }

    #[inline]
    fn texels(self, level: &MipLevel) -> &[Rgb] {
        match self.0 {
            Side::X => level.texels(),
            Side::Y => level.halved_texels(),
        }
    }
}

impl Lighting for Faded {
    const HAS_TEXELS: bool = false;

    #[inline]
    fn apply(self, color: Rgb) -> Rgb {
        color.blended(self.own, self.fog, self.share)
    }

    fn apply_to_all(self, colors: &mut [Rgb]) {
        Rgb::blend_all(colors, self.own, self.fog, self.share);
    }

    #[inline]
    fn texels(self, level: &MipLevel) -> &[Rgb] {
        level.texels()
    }
}

impl Faded {
    /// The fade of a floor or a ceiling in this light and at this distance; `None` for no effect.
    pub(crate) fn of_plane(light: Light, fog: Option<Fog>, distance: f64) -> Option<Self> {
        let faded = Self::new(light.in_256ths(), fog, distance);
        (faded.own < FULL).then_some(faded)
    }

    /// The fade of a side of a wall.
    pub(crate) fn of_wall(side: Side, light: Light, fog: Option<Fog>, distance: f64) -> Self {
        let light = match side {
            Side::X => light.in_256ths(),
            Side::Y => light.in_256ths() / 2,
        };
        Self::new(light, fog, distance)
    }

    /// The fade of a surface with this `normal`, a vector of length 1. A surface parallel to an x-side or a
    /// y-side has the fade of that side. An oblique one is between both.
    pub(crate) fn of_surface(normal: DVec2, light: Light, fog: Option<Fog>, distance: f64) -> Self {
        let share = f64::midpoint(1.0, normal.x * normal.x);
        Self::new((f64::from(light.in_256ths()) * share) as u32, fog, distance)
    }

    fn new(light: u32, fog: Option<Fog>, distance: f64) -> Self {
        let Some(fog) = fog else { return Self { own: light, fog: Rgb::BLACK, share: 0 } };
        let clear = rounded(fog.clearness(distance) * f64::from(FULL)) as u32;
        Self { own: light * clear / FULL, fog: fog.color, share: FULL - clear }
    }
}

/// The whole of a colour, in 256ths.
const FULL: u32 = Light::FULL.in_256ths();

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_near_lit_colour_is_unchanged() {
        let fog = Fog::new(Rgb::new(9, 9, 9), 4.0);
        assert_eq!(Faded::of_plane(Light::FULL, fog, 0.0), None);
        assert_eq!(Faded::of_plane(Light::FULL, None, 100.0), None);
        let wall = Faded::of_wall(Side::Y, Light::FULL, fog, 0.0);
        assert_eq!(wall.apply(Rgb::WHITE), Rgb::WHITE.halved());
    }

    #[test]
    fn a_grid_aligned_surface_is_as_bright_as_a_wall() {
        let light = Light::new(0.7).unwrap();
        for (normal, side) in [(DVec2::X, Side::X), (-DVec2::X, Side::X), (DVec2::Y, Side::Y)] {
            let wall = Faded::of_wall(side, light, None, 3.0);
            assert_eq!(Faded::of_surface(normal, light, None, 3.0), wall);
        }
    }

    #[test]
    fn a_far_colour_is_fog_in_any_light() {
        let fog = Fog::new(Rgb::new(10, 20, 30), 4.0).unwrap();
        for light in [0.0, 0.3, 1.0].map(|share| Light::new(share).unwrap()) {
            let far = Faded::of_wall(Side::X, light, Some(fog), f64::INFINITY);
            assert_eq!(far.apply(Rgb::WHITE), fog.color);
            let half = Faded::of_plane(light, Some(fog), 4.0).unwrap();
            assert!(half.apply(Rgb::WHITE).red() >= fog.color.red() / 2);
        }
    }
}
