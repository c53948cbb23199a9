//! The leaf of a door: a part of a line in the middle of its cell.
//!
//! It is exact as the grid is. The distance comes from the place of the line by one division, and
//! where rounding leaves in doubt whether the ray passes by an end of the leaf, the sign of a cross
//! product tells. The ends belong to the leaf.

use glam::DVec2;

use super::hit::{meeting, texture_coordinate};
use super::{Hit, Ray, Side};
use crate::numeric::cross;
use crate::world::{Cell, Grid, Opening};

/// Where `ray`, which is in `cell` for a while, meets the leaf of the door there. `None` where it
/// passes the leaf by.
pub(super) fn meet(grid: &Grid, ray: &Ray, cell: Cell, opening: Opening) -> Option<Hit> {
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

/// Further from an end of the leaf than that, a rounded place is on the right side of it.
const DOUBT: f64 = 1e-11;

/// The part of a leaf that is not in the jamb.
struct Leaf {
    /// The kind of line that it is part of.
    side: Side,
    /// Its north or west end, which is at the jamb that it slides into.
    start: DVec2,
    end: DVec2,
}

impl Leaf {
    fn new(grid: &Grid, cell: Cell, opening: Opening) -> Self {
        let (column, row) = (f64::from(cell.column), f64::from(cell.row));
        let length = 1.0 - opening.part();
        // A door's jambs are solid, and what is before and behind it is not.
        let is_jamb_in_the_west = grid.is_solid(i64::from(cell.column) - 1, i64::from(cell.row));
        if is_jamb_in_the_west {
            let start = DVec2::new(column, row + 0.5);
            Self { side: Side::Y, start, end: DVec2::new(column + length, start.y) }
        } else {
            let start = DVec2::new(column + 0.5, row);
            Self { side: Side::X, start, end: DVec2::new(start.x, row + length) }
        }
    }

    /// Whether `ray` meets the line that the leaf is part of.
    fn is_ahead(&self, ray: &Ray) -> bool {
        let way = self.start - ray.origin();
        let (way, direction) = match self.side {
            Side::X => (way.x, ray.direction().x),
            Side::Y => (way.y, ray.direction().y),
        };
        direction != 0.0 && (way == 0.0 || (way > 0.0) == (direction > 0.0))
    }

    /// Whether `ray` meets the line between both ends, which is `along` cells from the start but for
    /// rounding.
    fn holds(&self, ray: &Ray, along: f64) -> bool {
        let length = (self.end - self.start).max_element();
        let within = along.min(length - along);
        if within.abs() > DOUBT {
            return within > 0.0;
        }
        self.offset_sign(ray, self.start) >= 0.0 && self.offset_sign(ray, self.end) <= 0.0
    }

    /// The sign of the way to where `ray` meets the line, from a `point` on it.
    fn offset_sign(&self, ray: &Ray, point: DVec2) -> f64 {
        let direction = ray.direction();
        let sign = cross(ray.origin(), direction, point).sign();
        match self.side {
            Side::X => sign * direction.x.signum(),
            Side::Y => -sign * direction.y.signum(),
        }
    }
}
