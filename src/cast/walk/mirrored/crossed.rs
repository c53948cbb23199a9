//! The lines that a walk crosses, and the faces on them.

use glam::DVec2;

use crate::cast::hit::{along_line, from_left};
use crate::cast::{Ray, Side};
use crate::world::{Cell, TileId};

/// A line that a walk has crossed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossed {
    /// The kind of line.
    pub(crate) side: Side,
    /// The cell behind the line; `None` for the edge of the map, where the walk ends.
    pub(crate) into: Option<(Cell, TileId)>,
    /// The coordinate of the line along the straight ray.
    pub(crate) line: f64,
}

impl Crossed {
    /// The distance of the line along a ray, from the components of its origin and its direction across
    /// the line.
    #[inline]
    pub(crate) fn distance(&self, origin: f64, direction: f64) -> f64 {
        ((self.line - origin) / direction).abs()
    }
}

/// The face on a line that rays have crossed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CrossedFace {
    pub(crate) side: Side,
    /// The north or west end, along the straight rays.
    pub(crate) corner: DVec2,
    /// Whether the face is mirrored along its line.
    pub(crate) is_mirrored: bool,
    /// Whether the north or west end is on the left.
    pub(crate) is_from_left: bool,
}

impl CrossedFace {
    /// The position along the face at which `ray` has crossed the line at `t`, as in
    /// [`Hit`](crate::cast::Hit).
    #[inline]
    pub(crate) fn u(&self, ray: &Ray, t: f64) -> f64 {
        let along = along_line(ray, t, self.side, self.corner).clamp(0.0, 1.0);
        let along = if self.is_mirrored { 1.0 - along } else { along };
        from_left(along, self.is_from_left)
    }
}
