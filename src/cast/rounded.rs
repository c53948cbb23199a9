//! The order of lines by their distances in double precision.
//!
//! The ray meets the next x line at `(x - origin.x) / direction.x` and the next y line at
//! `(y - origin.y) / direction.y`. Only their order matters while walking, so both are multiplied by
//! `|direction.x · direction.y|`: two products are compared, nothing is divided, and a ray through a
//! corner compares equal. Both are computed from the index of the line; adding up a length from line
//! to line was refused because its error grows with the distance.

use glam::DVec2;

use super::{Order, Ray, Side};

/// The order of lines by their distances in double precision.
#[derive(Clone, Debug)]
pub struct RoundedOrder {
    origin: DVec2,
    /// For each axis the share of the direction that the other one has, with the sign of its own.
    pub(super) weight: DVec2,
}

impl RoundedOrder {
    /// The order for `ray`.
    pub fn new(ray: &Ray) -> Self {
        // Scaled, so that no product of a length and a direction overflows.
        let (scaled, _) = ray.scaled_direction();
        let direction = ray.direction();
        let weight = |own: f64, other: f64| if own < 0.0 { -other.abs() } else { other.abs() };
        let weight = DVec2::new(weight(direction.x, scaled.y), weight(direction.y, scaled.x));
        Self { origin: ray.origin(), weight }
    }

    /// How far the lines at `x` and `y` are, in a measure that both share.
    #[inline]
    pub(super) fn distances(&self, x: f64, y: f64) -> (f64, f64) {
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
