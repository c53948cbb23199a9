//! Face columns: upright faces as wide as a pixel, one by one or in runs, and the directions they face.

use std::ops::Range;

use glam::DVec2;

use super::Column;
use crate::cast::{Hit, Side, cell_before};
use crate::world::{Cell, Glass, Grid, Light, Outline, Paint, TextureId, TileId};

/// The visible part of an upright face that is as wide as a pixel, with a material of this kind.
#[derive(Clone, Debug)]
pub(crate) struct FaceColumn<M> {
    pub(crate) column: u32,
    pub(crate) rows: Range<u32>,
    pub(crate) facing: Facing,
    /// The approach of the ray to the face, in cells per unit of `t`.
    pub(crate) slope: f64,
    pub(crate) t: f64,
    pub(crate) u: f64,
    pub(crate) light: Light,
    pub(crate) material: M,
    pub(crate) extent: Extent,
}

/// A column of an opaque wall.
pub(crate) type WallColumn = FaceColumn<Paint>;

/// A column of a masked or translucent face, or the tint of a mirror.
pub(crate) type SeeThroughColumn = FaceColumn<Material>;

/// The material of a see-through face.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Material {
    /// A texture with holes.
    Masked(TextureId),
    /// A tint.
    Translucent(Glass),
}

/// The heights between which a face extends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Extent {
    /// From floor to ceiling of a level scene: from 0 to 1.
    Level,
    /// From `bottom` to `top`.
    Heights { bottom: f64, top: f64 },
}

/// Neighbouring wall columns of a level scene that show one paint on one kind of side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WallRun<'l> {
    /// The index of the first column.
    pub(crate) first: u32,
    /// The columns, each of which has a hit.
    pub(crate) columns: &'l [Column],
    pub(crate) side: Side,
    pub(crate) paint: Paint,
}

/// A receiver of wall columns.
///
/// It is a trait and not a closure, because each loop over wall columns must inline it.
pub(crate) trait WallSink {
    /// Receives the part of `wall` in `rows`, which are not empty.
    fn take(&mut self, wall: &WallColumn, rows: Range<u32>);
}

/// The direction of a face.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Facing {
    /// Along an axis, perpendicular to a side.
    Side(Side),
    /// Along a vector of length 1, in either direction.
    Normal(DVec2),
}

impl Facing {
    /// The facing of a shape that is hit at `point`.
    pub(crate) fn of_shape(outline: Outline, point: DVec2, hit: &Hit) -> Self {
        Self::Normal(match outline {
            Outline::Line(line) => line.stretch().perp().normalize(),
            Outline::Pillar(_) => (point - hit.cell.center()).normalize_or_zero(),
        })
    }

    /// The approach of a ray along `direction` to the face, in cells per unit of its `t`.
    #[inline]
    pub(crate) fn slope(self, direction: DVec2) -> f64 {
        match self {
            Self::Side(Side::X) => direction.x,
            Self::Side(Side::Y) => direction.y,
            Self::Normal(normal) => normal.dot(direction),
        }
    }
}

/// The cell from which a ray along `direction` sees the side of `hit`, and its tile; `None` off the map.
pub(crate) fn place_before(grid: &Grid, direction: DVec2, hit: &Hit) -> Option<(Cell, TileId)> {
    let [column, row] = cell_before(direction, hit.cell, hit.side);
    grid.cell(column, row)
}
