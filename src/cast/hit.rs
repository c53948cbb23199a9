//! What a ray hits, and where on its face.

use glam::DVec2;

use super::Ray;
use crate::numeric::cross;
use crate::world::Cell;

/// Which kind of grid line a ray crossed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// A line x = const: the west or the east face of a cell.
    X,
    /// A line y = const: the north or the south face of a cell.
    Y,
}

impl Side {
    /// The other kind.
    #[inline]
    pub(super) fn other(self) -> Self {
        match self {
            Self::X => Self::Y,
            Self::Y => Self::X,
        }
    }
}

/// Where a ray enters a solid cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The cell.
    pub cell: Cell,
    /// The kind of line that was crossed into it.
    pub side: Side,
    /// How far along the ray, in lengths of its direction; at least 0, and infinite only where that
    /// is more than the largest double.
    pub t: f64,
    /// How far along the face, from 0 at its left end to 1 at its right, as its viewer sees it.
    pub u: f64,
}

impl Hit {
    /// Where `ray` crosses a line of kind `side` into `cell`, which must be one that it does cross:
    /// `t` within 2 units in its last place, `u` within 10⁻¹².
    ///
    /// The distance comes from the index of the cell, by one subtraction and one division; a sum
    /// that runs from line to line would gather an error at each of them.
    #[inline]
    pub fn entering(ray: &Ray, cell: Cell, side: Side) -> Self {
        let direction = ray.direction();
        let (t, along) = meeting(ray, side, corner_of_face(direction, cell, side));
        Self { cell, side, t, u: texture_coordinate(direction, side, along) }
    }
}

/// How far along `ray` it meets the line of kind `side` through `corner`, which must not lie behind
/// it, and how far from the corner that is, to the south or to the east.
#[inline]
pub(super) fn meeting(ray: &Ray, side: Side, corner: DVec2) -> (f64, f64) {
    let (origin, direction) = (ray.origin(), ray.direction());
    let offset = corner - origin;
    let (t, start, slope) = match side {
        Side::X => ((offset.x / direction.x).abs(), -offset.y, direction.y),
        Side::Y => ((offset.y / direction.y).abs(), -offset.x, direction.x),
    };
    let moved = t * slope;
    let along = if start.abs() + moved.abs() <= FAR {
        start + moved
    } else {
        far_along(origin, direction, side, corner)
    };
    (t, along)
}

/// How far from `corner` a line is met, where the two terms of that are large.
#[cold]
#[inline(never)]
fn far_along(origin: DVec2, direction: DVec2, side: Side, corner: DVec2) -> f64 {
    let cross = cross(origin, direction, corner);
    match side {
        Side::X => cross.over(direction.x),
        Side::Y => -cross.over(direction.y),
    }
}

/// Up to this many cells, two rounded terms of that size add up to within 10⁻¹² of their true sum.
const FAR: f64 = 1024.0;

/// The north or west end of the face by which a ray along `direction` enters `cell`.
#[inline]
fn corner_of_face(direction: DVec2, cell: Cell, side: Side) -> DVec2 {
    let (column, row) = (f64::from(cell.column), f64::from(cell.row));
    match side {
        Side::X if direction.x < 0.0 => DVec2::new(column + 1.0, row),
        Side::Y if direction.y < 0.0 => DVec2::new(column, row + 1.0),
        Side::X | Side::Y => DVec2::new(column, row),
    }
}

/// The texture coordinate of a place on a face, `along` cells from its north or west end, as a
/// viewer sees it who looks along `direction`.
#[inline]
pub(crate) fn texture_coordinate(direction: DVec2, side: Side, along: f64) -> f64 {
    // Zero is added to be rid of its sign.
    let along = along.clamp(0.0, 1.0) + 0.0;
    let from_left = match side {
        Side::X => direction.x > 0.0,
        Side::Y => direction.y < 0.0,
    };
    if from_left { along } else { 1.0 - along }
}
