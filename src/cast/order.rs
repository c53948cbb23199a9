//! The order in which a ray meets the lines of a grid. It is the order in rational arithmetic,
//! mostly at the cost of doubles.
//!
//! The distances of the next two lines are compared in double precision first. The ray meets the
//! next x line at `(x - origin.x) / direction.x`, and the next y line at
//! `(y - origin.y) / direction.y`. Only their order counts, so both are multiplied by
//! `|direction.x · direction.y|`. This leaves two products to compare, without a division, which
//! are equal at a corner. Both are computed from the index of the line. Rejected: adding up lengths
//! from line to line. The error grows with the distance.
//!
//! The result is accepted if the distances differ by more than a bound on their rounding. Otherwise
//! the ray passes so close to the corner of the two lines that only the sign of a cross product,
//! computed without rounding, can tell the side. Ordinary rays never need it, and pay one
//! comparison for each line. This is a floating-point filter before an exact predicate, as in
//! Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates"
//! (1997).
//!
//! The bound on the rounding is computed once for each ray, from the size of the map. Rejected: a
//! bound for each line, tighter near the start. It costs more than the exact cross products that it
//! saves.

use glam::DVec2;

use super::{Ray, Side};
use crate::numeric::cross;
use crate::world::Grid;

/// Decides which line a ray crosses next.
pub trait Order {
    /// [`Side::X`] if the ray meets the line at `x` first, [`Side::Y`] if it meets the line at `y`
    /// first. The walk crosses that line.
    ///
    /// Both lines are ahead of the ray. Along an axis on which the ray does not move, there is no
    /// line ahead and its position is infinite. Selecting it ends the walk.
    fn next(&mut self, x: f64, y: f64) -> Side;
}

/// The order in which a ray meets the lines of a grid.
#[derive(Clone, Debug)]
pub struct ExactOrder {
    ray: Ray,
    rounded: RoundedOrder,
    /// Rounded distances that differ by more than this are in the correct order.
    uncertainty: f64,
}

impl ExactOrder {
    /// The order for `ray` in `grid`.
    pub fn new(grid: &Grid, ray: &Ray) -> Self {
        Self::from_rounded(grid, ray, RoundedOrder::new(ray))
    }

    /// The same order for a camera's ray. The direction is not scaled: if a product overflows, the
    /// difference is either in doubt, or infinite and correct.
    #[cfg(feature = "tui")]
    #[inline]
    pub(crate) fn of_camera(grid: &Grid, ray: &Ray) -> Self {
        let direction = ray.direction();
        Self::from_rounded(
            grid,
            ray,
            RoundedOrder::of_direction(ray.origin(), direction, direction),
        )
    }

    #[inline]
    fn from_rounded(grid: &Grid, ray: &Ray, rounded: RoundedOrder) -> Self {
        let furthest = grid.extent() + ray.origin().abs();
        Self { ray: *ray, uncertainty: uncertainty(furthest, rounded.weight), rounded }
    }
}

/// A bound on the error of a difference of rounded distances to lines that are at most `furthest` away.
#[inline]
fn uncertainty(furthest: DVec2, weight: DVec2) -> f64 {
    // A distance is rounded once by the subtraction and once by the weighting; two epsilons are twice
    // the sum of these errors. The second term bounds the error of underflow.
    let error = weight.abs() * (2.0 * f64::EPSILON) + DVec2::splat(f64::MIN_POSITIVE);
    furthest.dot(error)
}

/// The order in which the rays of a camera meet the lines of a grid.
#[derive(Clone, Debug)]
pub(crate) struct CommonOrder {
    origin: DVec2,
    furthest: DVec2,
}

impl CommonOrder {
    /// The order for rays from `origin` in `grid`, with at most `most_bounces` reflections.
    pub(crate) fn new(grid: &Grid, origin: DVec2, most_bounces: u32) -> Self {
        let furthest = grid.extent() * f64::from(most_bounces + 1) + origin.abs();
        Self { origin, furthest }
    }

    /// The order for the ray in this `direction`. It is not scaled: if a product overflows, the
    /// difference is either in doubt, or infinite and correct.
    #[inline]
    pub(crate) fn along(&self, direction: DVec2) -> ExactOrder {
        let rounded = RoundedOrder::of_direction(self.origin, direction, direction);
        ExactOrder {
            ray: Ray::of_camera(self.origin, direction),
            uncertainty: uncertainty(self.furthest, rounded.weight),
            rounded,
        }
    }
}

/// The kind of line that the ray crosses first, of the lines at `x` and `y`, found without
/// rounding.
///
/// The ray is passed in parts, because a reference would force the walk into memory.
#[cold]
#[inline(never)]
pub(crate) fn decide(origin: DVec2, direction: DVec2, x: f64, y: f64) -> Side {
    let cross = cross(origin, direction, DVec2::new(x, y)).sign();
    // For a ray to the north-east or to the south-west, left and right are swapped.
    let x_behind_y = if (direction.x > 0.0) == (direction.y > 0.0) { cross } else { -cross };
    if x_behind_y >= 0.0 { Side::Y } else { Side::X }
}

impl Order for ExactOrder {
    #[inline]
    fn next(&mut self, x: f64, y: f64) -> Side {
        // The order is computed before the doubt, so that the compiler can select it without a
        // branch: the order looks random to a branch predictor, and the doubt does not.
        let (to_x, to_y) = self.rounded.distances(x, y);
        let side = if to_y <= to_x { Side::Y } else { Side::X };
        if (to_x - to_y).abs() > self.uncertainty {
            side
        } else {
            decide(self.ray.origin(), self.ray.direction(), x, y)
        }
    }
}

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
    fn of_direction(origin: DVec2, direction: DVec2, scaled: DVec2) -> Self {
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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn camera_rays_are_ordered_like_each_ray_alone(
            origin in prop::array::uniform2(prop_oneof![
                -1.0..5.0,
                (-4..20_i32).prop_map(|quarters| f64::from(quarters) / 4.0),
            ]),
            direction in prop::array::uniform2(prop_oneof![
                -2.0..2.0,
                (-8..9_i32).prop_map(|quarters| f64::from(quarters) / 4.0),
            ]),
        ) {
            let [origin, direction] = [origin, direction].map(DVec2::from);
            let ray = Ray::new(origin, direction);
            prop_assume!(ray.is_ok());
            let grid = Grid::sketch(&["....", "....", "...."]).unwrap();
            let mut common = CommonOrder::new(&grid, origin, 0).along(direction);
            let mut order = ExactOrder::new(&grid, &ray.unwrap());
            let is_ahead =
                |line: f64, origin: f64, direction: f64| (line - origin) * direction > 0.0;
            for (x, y) in (0..5).flat_map(|x| (0..4).map(move |y| (f64::from(x), f64::from(y)))) {
                if is_ahead(x, origin.x, direction.x) && is_ahead(y, origin.y, direction.y) {
                    prop_assert_eq!(common.next(x, y), order.next(x, y));
                }
            }
        }
    }
}
