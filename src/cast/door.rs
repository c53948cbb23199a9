//! The leaf of a door: a segment of a line in the middle of its cell.
//!
//! The result is as exact as for walls. The distance is computed from the position of the line by
//! one division. Where rounding leaves in doubt whether the ray misses an end of the leaf, the sign
//! of a cross product decides. The ends belong to the leaf.

use glam::DVec2;

use super::hit::{meeting, texture_coordinate};
use super::{Hit, Ray, Side};
use crate::numeric::cross;
use crate::world::{Cell, Grid, Opening};

/// The hit of `ray`, which passes through `cell`, on the leaf of the door there. `None` if it
/// misses the leaf.
pub(crate) fn meet(grid: &Grid, ray: &Ray, cell: Cell, opening: Opening) -> Option<Hit> {
    let leaf = Leaf::new(grid, cell, opening);
    if !leaf.is_ahead(ray) {
        return None;
    }
    let (t, along) = meeting(ray, leaf.side, leaf.start);
    leaf.holds(ray, along).then(|| {
        let u = texture_coordinate(ray.direction(), leaf.side, along + opening.part());
        Hit { cell, side: leaf.side, t, u }
    })
}

/// At more than this distance from an end of the leaf, a rounded position is on the correct side of
/// the end.
const UNCERTAINTY: f64 = 1e-11;

/// The part of a leaf that is not inside the jamb.
struct Leaf {
    /// The kind of line that contains the leaf.
    side: Side,
    /// The north or west end, at the jamb into which the leaf slides.
    start: DVec2,
    end: DVec2,
}

impl Leaf {
    fn new(grid: &Grid, cell: Cell, opening: Opening) -> Self {
        let (column, row) = (f64::from(cell.column), f64::from(cell.row));
        let length = 1.0 - opening.part();
        // A door has solid jambs on two sides, and open cells on the other two.
        let is_jamb_in_the_west = grid.is_solid(i64::from(cell.column) - 1, i64::from(cell.row));
        if is_jamb_in_the_west {
            let start = DVec2::new(column, row + 0.5);
            Self { side: Side::Y, start, end: DVec2::new(column + length, start.y) }
        } else {
            let start = DVec2::new(column + 0.5, row);
            Self { side: Side::X, start, end: DVec2::new(start.x, row + length) }
        }
    }

    /// Whether `ray` meets the line that contains the leaf.
    fn is_ahead(&self, ray: &Ray) -> bool {
        let way = self.start - ray.origin();
        let (way, direction) = match self.side {
            Side::X => (way.x, ray.direction().x),
            Side::Y => (way.y, ray.direction().y),
        };
        direction != 0.0 && (way == 0.0 || (way > 0.0) == (direction > 0.0))
    }

    /// Whether `ray` meets the line between both ends. `along` is the rounded distance from the
    /// start to that point, in cells.
    fn holds(&self, ray: &Ray, along: f64) -> bool {
        let length = (self.end - self.start).max_element();
        let within = along.min(length - along);
        if within.abs() > UNCERTAINTY {
            return within > 0.0;
        }
        self.offset_sign(ray, self.start) >= 0.0 && self.offset_sign(ray, self.end) <= 0.0
    }

    /// The sign of the offset from `point`, on the line, to the point where `ray` meets the line.
    fn offset_sign(&self, ray: &Ray, point: DVec2) -> f64 {
        let direction = ray.direction();
        let sign = cross(ray.origin(), direction, point).sign();
        match self.side {
            Side::X => sign * direction.x.signum(),
            Side::Y => -sign * direction.y.signum(),
        }
    }
}
