//! Rays clipped to the map, for the approximate methods.
//!
//! A table, a running sum or constant steps cannot cross 10¹⁵ empty cells, and single precision or
//! fixed point cannot represent such a position. Therefore a ray that starts off the map is first
//! moved to the edge of the map, in double precision, and its direction is scaled. The comparison
//! is about behaviour on the map.

use glam::DVec2;

use cellcaster::cast::texture_coordinate;
use cellcaster::cast::{Hit, Ray, Side};
use cellcaster::world::{Cell, Grid};

/// A ray that starts on the map or at its edge. The larger component of its direction is between
/// 1/2 and 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClippedRay {
    /// The ray from that point on.
    pub(crate) ray: Ray,
    /// The distance from the original origin, in lengths of the scaled direction.
    skipped: f64,
    /// The exponent of the power of two that divides the direction.
    exponent: i32,
}

impl ClippedRay {
    /// `ray` from its first point on the map; `None` if it misses the map.
    pub(crate) fn new(grid: &Grid, ray: &Ray) -> Option<Self> {
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

    /// The hit at a distance that a method found, in lengths of the scaled direction from the
    /// clipped origin, and at a position `along` cells from the north or west end of the face.
    pub(crate) fn hit(&self, cell: Cell, side: Side, distance: f64, along: f64) -> Hit {
        let t = libm::scalbn(self.skipped + distance, -self.exponent);
        Hit { cell, side, t, u: texture_coordinate(self.ray.direction(), side, along) }
    }

    /// The hit at a distance that a method found. Computes the position on the face from the
    /// distance.
    pub(crate) fn hit_at(&self, cell: Cell, side: Side, distance: f64) -> Hit {
        let point = self.ray.at(distance);
        let along = match side {
            Side::X => point.y - f64::from(cell.row),
            Side::Y => point.x - f64::from(cell.column),
        };
        self.hit(cell, side, distance, along)
    }
}
