//! Rays and hits: a half-line, and the point where it enters a cell.

use std::fmt;

use glam::DVec2;

use crate::numeric::cross;
use crate::world::Cell;

/// A half-line on the map, with a finite origin and a finite direction that is not zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    origin: DVec2,
    direction: DVec2,
}

impl Ray {
    /// The ray from `origin`, in cells, along `direction`, which may have any length except zero.
    ///
    /// # Errors
    /// Returns an error if either is not finite, or if the direction is zero.
    pub fn new(origin: DVec2, direction: DVec2) -> Result<Self, RayError> {
        if !origin.is_finite() {
            Err(RayError::Origin)
        } else if !direction.is_finite() {
            Err(RayError::Direction)
        } else if direction == DVec2::ZERO {
            Err(RayError::NoDirection)
        } else {
            Ok(Self { origin, direction })
        }
    }

    /// The start.
    pub fn origin(&self) -> DVec2 {
        self.origin
    }

    /// The direction, whose length is the unit of `t`.
    pub fn direction(&self) -> DVec2 {
        self.direction
    }

    /// The point at `t`.
    pub fn at(&self, t: f64) -> DVec2 {
        self.origin + self.direction * t
    }

    /// The direction scaled by a power of two so that its larger component is between 1/2 and 1,
    /// and the exponent of the divisor. The smaller component underflows to 0 if it is too small
    /// relative to the larger one.
    pub fn scaled_direction(&self) -> (DVec2, i32) {
        let exponent = libm::ilogb(self.direction.abs().max_element()) + 1;
        let scale = |component| libm::scalbn(component, -exponent);
        (DVec2::new(scale(self.direction.x), scale(self.direction.y)), exponent)
    }

    /// A camera's ray. The origin must be finite, and the direction finite and not zero.
    #[inline]
    pub(crate) fn of_camera(origin: DVec2, direction: DVec2) -> Self {
        debug_assert!(Self::new(origin, direction).is_ok(), "{origin} {direction}");
        Self { origin, direction }
    }

    /// A ray made of parts of a valid ray, such as the same line with another origin or another
    /// unit of `t`. The parts are not checked.
    pub fn moved(origin: DVec2, direction: DVec2) -> Self {
        Self { origin, direction }
    }
}

/// The error of [`Ray::new`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayError {
    /// The origin is not finite.
    Origin,
    /// The direction is not finite.
    Direction,
    /// The direction is zero.
    NoDirection,
}

impl fmt::Display for RayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Origin => "a ray's origin must be two finite numbers",
            Self::Direction => "a ray's direction must be two finite numbers",
            Self::NoDirection => "a ray's direction must not be zero",
        })
    }
}

impl std::error::Error for RayError {}

/// The kind of grid line that a ray crosses.
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
    pub(crate) fn other(self) -> Self {
        match self {
            Self::X => Self::Y,
            Self::Y => Self::X,
        }
    }
}

/// The point where a ray enters a solid cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The cell.
    pub cell: Cell,
    /// The kind of line that the ray crosses to enter the cell.
    pub side: Side,
    /// The distance along the ray, in lengths of its direction: at least 0. It is infinite only if
    /// it exceeds the largest double.
    pub t: f64,
    /// The texture coordinate: the position along the face, from 0 at its left end to 1 at its
    /// right end, as the viewer sees it.
    pub u: f64,
}

impl Hit {
    /// The hit of `ray` on `cell` by a line of kind `side`, which the ray must cross into the cell.
    /// `t` is within 2 units in its last place, and `u` within 10⁻¹².
    ///
    /// The distance is computed from the index of the cell, by one subtraction and one division. A
    /// running sum from line to line would accumulate an error for each line.
    #[inline]
    pub fn entering(ray: &Ray, cell: Cell, side: Side) -> Self {
        let direction = ray.direction();
        let (t, along) = meeting(ray, side, corner_of_face(direction, cell, side));
        Self { cell, side, t, u: texture_coordinate(direction, side, along) }
    }
}

/// The distance along `ray` to the line of kind `side` through `corner`, and the distance from the
/// corner to that point, to the south or to the east. The line must not be behind the ray's start.
#[inline]
pub(crate) fn meeting(ray: &Ray, side: Side, corner: DVec2) -> (f64, f64) {
    let offset = corner - ray.origin();
    let t = match side {
        Side::X => (offset.x / ray.direction().x).abs(),
        Side::Y => (offset.y / ray.direction().y).abs(),
    };
    (t, along_line(ray, t, side, corner))
}

/// The distance from `corner` to the point where `ray` meets its line of kind `side` at `t`, to the south or
/// to the east.
#[inline]
fn along_line(ray: &Ray, t: f64, side: Side, corner: DVec2) -> f64 {
    let (origin, direction) = (ray.origin(), ray.direction());
    let offset = corner - origin;
    let (start, slope) = match side {
        Side::X => (-offset.y, direction.y),
        Side::Y => (-offset.x, direction.x),
    };
    let moved = t * slope;
    if start.abs() + moved.abs() <= FAR {
        start + moved
    } else {
        far_along(origin, direction, side, corner)
    }
}

/// The distance from `corner` to the crossing, if both terms of the sum are large.
#[cold]
#[inline(never)]
fn far_along(origin: DVec2, direction: DVec2, side: Side, corner: DVec2) -> f64 {
    let cross = cross(origin, direction, corner);
    match side {
        Side::X => cross.over(direction.x),
        Side::Y => -cross.over(direction.y),
    }
}

/// For terms of up to this many cells, the sum of two rounded terms is within 10⁻¹² of the true
/// sum.
const FAR: f64 = 1024.0;

/// The north or west end of the face through which a ray along `direction` enters `cell`.
#[inline]
fn corner_of_face(direction: DVec2, cell: Cell, side: Side) -> DVec2 {
    let (column, row) = (f64::from(cell.column), f64::from(cell.row));
    match side {
        Side::X if direction.x < 0.0 => DVec2::new(column + 1.0, row),
        Side::Y if direction.y < 0.0 => DVec2::new(column, row + 1.0),
        Side::X | Side::Y => DVec2::new(column, row),
    }
}

/// The column and the row of the cell that a ray along `direction` leaves when it enters `cell` by
/// a line of kind `side`.
pub(crate) fn cell_before(direction: DVec2, cell: Cell, side: Side) -> [i64; 2] {
    let back = |direction: f64| if direction > 0.0 { -1 } else { 1 };
    let (column, row) = (i64::from(cell.column), i64::from(cell.row));
    match side {
        Side::X => [column + back(direction.x), row],
        Side::Y => [column, row + back(direction.y)],
    }
}

/// The texture coordinate of a point `along` cells from the north or west end of a face, for a
/// viewer who looks along `direction`.
#[inline]
pub fn texture_coordinate(direction: DVec2, side: Side, along: f64) -> f64 {
    from_left(along, is_from_left(direction, side))
}

/// Returns whether a viewer who looks along `direction` sees the north or west end of a face on the
/// left.
#[inline]
pub(crate) fn is_from_left(direction: DVec2, side: Side) -> bool {
    match side {
        Side::X => direction.x > 0.0,
        Side::Y => direction.y < 0.0,
    }
}

#[inline]
pub(crate) fn from_left(along: f64, is_from_left: bool) -> f64 {
    // Adding zero turns −0 into +0.
    let along = along.clamp(0.0, 1.0) + 0.0;
    if is_from_left { along } else { 1.0 - along }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_needs_a_finite_origin_and_direction() {
        let ray = |x, y, dx, dy| Ray::new(DVec2::new(x, y), DVec2::new(dx, dy));
        assert_eq!(ray(0.0, 0.0, 0.0, -0.0), Err(RayError::NoDirection));
        assert_eq!(ray(0.0, f64::NAN, 1.0, 0.0), Err(RayError::Origin));
        assert_eq!(ray(0.0, 0.0, f64::INFINITY, 0.0), Err(RayError::Direction));
    }

    #[test]
    fn scaling_a_direction_keeps_its_slope() {
        for (direction, scaled) in [
            ((3.0, -4.0), (0.375, -0.5)),
            ((1.0, 0.0), (0.5, 0.0)),
            ((5e-324, -5e-324), (0.5, -0.5)),
            ((2f64.powi(1023), 5e-324), (0.5, 0.0)),
        ] {
            let ray = Ray::new(DVec2::ZERO, DVec2::from(direction)).unwrap();
            assert_eq!(ray.scaled_direction().0, DVec2::from(scaled));
        }
    }
}
