//! Sampling: the level of a texture from which a surface is drawn.
//!
//! A frame has one [`Filter`](crate::visibility::Filter). The loops are compiled once for each kind
//! of level, so no loop contains code for the other kind.

use std::fmt;

use crate::visibility::{FrameContext, SpanMapping};
use crate::world::Texture;
use crate::world::texture::{AreaLod, MipLevel, Repeat};

/// A kind of texture level.
pub(crate) trait Sampling: Copy {
    /// The key that selects a level of a texture.
    type Lod: Copy + PartialEq + fmt::Debug;

    /// `true` if planes at the same height never overlap, so they may be joined and drawn in any
    /// order. With the area filter, planes continue under the ends of faces.
    const JOINS_PLANES: bool;

    /// The level of detail of a face at distance `t`, which the ray approaches by `slope` cells per unit of
    /// `t`.
    fn lod_on_face(scene: FrameContext<'_>, texture: &Texture, t: f64, slope: f64) -> Self::Lod;

    /// The level of detail of a plane with `per_cell` repeats in a cell.
    fn lod_on_plane(
        scene: FrameContext<'_>,
        texture: &Texture,
        mapping: &SpanMapping,
        per_cell: f64,
    ) -> Self::Lod;

    /// The level of `texture` on a face.
    fn level_on_face(texture: &Texture, lod: Self::Lod) -> &MipLevel;

    /// The level of `texture` on a plane.
    fn level_on_plane(texture: &Texture, lod: Self::Lod) -> &MipLevel;
}

/// Mip levels, selected by the area of a pixel.
#[derive(Clone, Copy)]
pub(crate) struct MipLevels;

/// Means over boxes, selected by the width and the height of a pixel.
#[derive(Clone, Copy)]
pub(crate) struct Means;

impl Sampling for MipLevels {
    type Lod = usize;

    const JOINS_PLANES: bool = true;

    #[inline]
    fn lod_on_face(scene: FrameContext<'_>, texture: &Texture, t: f64, slope: f64) -> usize {
        let area = scene.projection.pixel_area_on_wall(t, slope);
        scene.plan.filter.lod(area * texture.area())
    }

    #[inline]
    fn lod_on_plane(
        scene: FrameContext<'_>,
        texture: &Texture,
        mapping: &SpanMapping,
        per_cell: f64,
    ) -> usize {
        let area = mapping.pixel_area * per_cell * per_cell;
        scene.plan.filter.lod(area * texture.area())
    }

    #[inline]
    fn level_on_face(texture: &Texture, lod: usize) -> &MipLevel {
        texture.level(lod)
    }

    #[inline]
    fn level_on_plane(texture: &Texture, lod: usize) -> &MipLevel {
        texture.level(lod)
    }
}

impl Sampling for Means {
    type Lod = AreaLod;

    const JOINS_PLANES: bool = false;

    #[inline]
    fn lod_on_face(scene: FrameContext<'_>, texture: &Texture, t: f64, slope: f64) -> AreaLod {
        let extent = scene.projection.pixel_extent_on_wall(t, slope);
        let across = extent.x * f64::from(texture.width());
        let down = extent.y * f64::from(texture.height());
        AreaLod::of_squares(across * across, down * down)
    }

    fn lod_on_plane(
        _: FrameContext<'_>,
        texture: &Texture,
        mapping: &SpanMapping,
        per_cell: f64,
    ) -> AreaLod {
        let squares = mapping.squares_of_extent() * (per_cell * per_cell);
        let square = |side: u32| f64::from(side) * f64::from(side);
        AreaLod::of_squares(
            squares.x * square(texture.width()),
            squares.y * square(texture.height()),
        )
    }

    #[inline]
    fn level_on_face(texture: &Texture, lod: AreaLod) -> &MipLevel {
        texture.area_level(lod, Repeat::Across)
    }

    #[inline]
    fn level_on_plane(texture: &Texture, lod: AreaLod) -> &MipLevel {
        texture.area_level(lod, Repeat::Both)
    }
}
