//! The order of lines by their distances in double precision.
//!
//! The ray meets the next x line at `(x - origin.x) / direction.x`, and the next y line at `(y -
//! origin.y) / direction.y`. A walk only needs their order, so that both are multiplied by
//! `|direction.x · direction.y|`: two products are compared, without a division, and at a corner
//! both are equal. Both are computed from the index of the line. Adding up lengths from line to
//! line was refused, because the error grows with the distance.

use glam::DVec2;

use super::{Order, Ray, Side};

/// The order of lines by their distances in double precision.
#[derive(Clone, Debug)]
pub struct RoundedOrder {
    origin: DVec2,
    /// For each axis, the size of the direction along the other axis, with the sign of this axis.
    pub(crate) weight: DVec2,
}

impl RoundedOrder {
    /// The order for `ray`.
    pub fn new(ray: &Ray) -> Self {
        // The direction is scaled, so that no product of a length and a direction overflows.
        let (scaled, _) = ray.scaled_direction();
        Self::of_direction(ray.origin(), ray.direction(), scaled)
    }

    /// The order for rays from `origin` along `direction`, which is also `scaled`.
    #[inline]
    pub(crate) fn of_direction(origin: DVec2, direction: DVec2, scaled: DVec2) -> Self {
        let weight = |own: f64, other: f64| if own < 0.0 { -other.abs() } else { other.abs() };
        let weight = DVec2::new(weight(direction.x, scaled.y), weight(direction.y, scaled.x));
        Self { origin, weight }
    }

    /// The distances to the lines at `x` and `y`, in a common unit.
    #[inline]
    pub(crate) fn distances(&self, x: f64, y: f64) -> (f64, f64) {
        ((x - self.origin.x) * self.weight.x, (y - self.origin.y) * self.weight.y)
    }
}

impl Order for RoundedOrder {
    #[inline]
    fn next(&mut self, x: f64, y: f64) -> Side {
        let (to_x, to_y) = self.distances(x, y);
        if to_y <= to_x { Side::Y } else { Side::X }
    }
}
