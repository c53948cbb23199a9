//! A ray in the shape that the approximate methods take it.
//!
//! A table, a running sum or a constant step can't cross 10¹⁵ cells of nothing, and single precision
//! or a fixed point can't even say where that is. So a ray that starts off the map is first moved to
//! its edge, in double precision, and its direction is scaled. What the methods are compared on is
//! what they do on the map.

use glam::DVec2;

use crate::cast::texture_coordinate;
use crate::cast::{Hit, Ray, Side};
use crate::world::{Cell, Grid};

/// A ray that starts on the map or at its edge, its larger component between 1/2 and 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Approach {
    /// The ray from there on.
    pub(super) ray: Ray,
    /// How far it has come, in lengths of the scaled direction.
    skipped: f64,
    /// The power of two that the direction was divided by.
    exponent: i32,
}

impl Approach {
    /// `ray` from where it is on the map; `None` where it never is.
    pub(super) fn new(grid: &Grid, ray: &Ray) -> Option<Self> {
        let (direction, exponent) = ray.scaled_direction();
        let size = DVec2::new(f64::from(grid.width()), f64::from(grid.height()));
        let origin = ray.origin();
        let nearest = origin.clamp(DVec2::ZERO, size);
        if nearest == origin {
            return Some(Self { ray: Ray::moved(origin, direction), skipped: 0.0, exponent });
        }
        let gap = nearest - origin;
        let reach = |gap: f64, direction: f64| if gap == 0.0 { 0.0 } else { gap / direction };
        let (x, y) = (reach(gap.x, direction.x), reach(gap.y, direction.y));
        let skipped = x.max(y);
        if x < 0.0 || y < 0.0 || !skipped.is_finite() {
            return None;
        }
        let mut start = origin + direction * skipped;
        if x > y {
            start.x = nearest.x;
        } else {
            start.y = nearest.y;
        }
        let is_at_edge = start == start.clamp(DVec2::ZERO, size);
        is_at_edge.then(|| Self { ray: Ray::moved(start, direction), skipped, exponent })
    }

    /// A hit at a distance that a method found, in lengths of the scaled direction from the start of
    /// the approached ray, and at a place `along` cells from the north or west end of the face.
    pub(super) fn hit(&self, cell: Cell, side: Side, distance: f64, along: f64) -> Hit {
        let t = libm::scalbn(self.skipped + distance, -self.exponent);
        Hit { cell, side, t, u: texture_coordinate(self.ray.direction(), side, along) }
    }

    /// A hit at a distance that a method found; its place on the face follows from it.
    pub(super) fn hit_at(&self, cell: Cell, side: Side, distance: f64) -> Hit {
        let point = self.ray.at(distance);
        let along = match side {
            Side::X => point.y - f64::from(cell.row),
            Side::Y => point.x - f64::from(cell.column),
        };
        self.hit(cell, side, distance, along)
    }
}
