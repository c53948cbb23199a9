//! Bodies: what a scene consists of. All of them are convex.

use glam::DVec3;

use super::checker::{self, Footprint};
use crate::color::Rgb;
use crate::color::srgb::mean_of_shares;
use crate::world::Scale;

/// The farthest from the origin that anything is, along each axis, and the largest radius, in cells.
pub const FARTHEST: f64 = 1e9;
/// The smallest radius, and the shortest edge of a block, in cells.
pub const SMALLEST: f64 = 1e-9;

/// Something to be seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Where it is, and of what shape.
    pub shape: Shape,
    /// What colours it has.
    pub coat: Coat,
}

/// Where a body is, and of what shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A ball, hollow to who is inside.
    Sphere(Sphere),
    /// A plane without end, seen from both sides.
    Plane(Plane),
    /// A box along the axes, hollow to who is inside.
    Block(Block),
}

/// What colours a body has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coat {
    /// The same all over.
    Plain(Rgb),
    /// Cubes of two colours by turns, as space is cut into them at whole multiples of the scale.
    Checker([Rgb; 2], Scale),
}

/// A ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    center: DVec3,
    radius: f64,
}

/// A plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    point: DVec3,
    normal: DVec3,
}

/// A box whose edges are along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    low: DVec3,
    high: DVec3,
}

impl Sphere {
    /// A ball of `radius` around `center`. `None` where the center is further away than [`FARTHEST`]
    /// or the radius not between [`SMALLEST`] and that.
    pub fn new(center: DVec3, radius: f64) -> Option<Self> {
        let fits = is_near(center) && (SMALLEST..=FARTHEST).contains(&radius);
        fits.then_some(Self { center, radius })
    }

    /// Its middle.
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// In cells.
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

impl Plane {
    /// The plane through `point` at a right angle to `normal`, of any length. `None` where the point
    /// is further away than [`FARTHEST`], or the normal is zero or not finite.
    pub fn new(point: DVec3, normal: DVec3) -> Option<Self> {
        let largest = normal.abs().max_element();
        let has_direction = normal.is_finite() && largest > 0.0;
        // Scaled first: the squares of the largest and the smallest doubles are none.
        let fits = is_near(point) && has_direction;
        fits.then(|| Self { point, normal: (normal / largest).normalize() })
    }

    /// A point on it.
    pub fn point(&self) -> DVec3 {
        self.point
    }

    /// The unit vector at a right angle to it.
    pub fn normal(&self) -> DVec3 {
        self.normal
    }
}

impl Block {
    /// The box between two opposite corners, in any order. `None` where one is further away than
    /// [`FARTHEST`], or an edge is shorter than [`SMALLEST`].
    pub fn new(corner: DVec3, opposite: DVec3) -> Option<Self> {
        let (low, high) = (corner.min(opposite), corner.max(opposite));
        let fits = is_near(corner) && is_near(opposite) && (high - low).min_element() >= SMALLEST;
        fits.then_some(Self { low, high })
    }

    /// Its corner in the north-west, at the bottom.
    pub fn low(&self) -> DVec3 {
        self.low
    }

    /// Its corner in the south-east, at the top.
    pub fn high(&self) -> DVec3 {
        self.high
    }
}

impl Shape {
    /// How far `point` is from it, in cells, and the unit vector from its nearest point to there. The
    /// distance is negative inside a sphere or a box, where the vector points outwards too.
    ///
    /// A plane has two outsides.
    pub fn clearance(&self, point: DVec3) -> (f64, DVec3) {
        match self {
            Self::Sphere(sphere) => {
                let from_center = point - sphere.center;
                let distance = from_center.length();
                (distance - sphere.radius, from_center.try_normalize().unwrap_or(DVec3::Z))
            }
            Self::Plane(plane) => {
                let distance = plane.normal.dot(point - plane.point);
                let side = if distance < 0.0 { -1.0 } else { 1.0 };
                (distance.abs(), plane.normal * side)
            }
            Self::Block(block) => block.clearance(point),
        }
    }
}

impl Block {
    fn clearance(&self, point: DVec3) -> (f64, DVec3) {
        let beside = point - point.clamp(self.low, self.high);
        if let Some(outwards) = beside.try_normalize() {
            return (beside.length(), outwards);
        }
        let outside = (self.low - point).max(point - self.high);
        let distance = outside.max_element();
        let axis = DVec3::AXES.into_iter().find(|&axis| axis.dot(outside) == distance);
        let axis = axis.unwrap_or(DVec3::Z);
        let middle = (self.low + self.high) / 2.0;
        (distance, if axis.dot(point - middle) < 0.0 { -axis } else { axis })
    }
}

impl Coat {
    /// The mean colour of what a pixel covers of a surface at `point`, with that unit normal on the
    /// side of the eye.
    ///
    /// It is looked up a little below the surface: one that lies between two layers of cubes would
    /// show both by chance.
    pub(super) fn mean_color(
        &self,
        point: DVec3,
        normal: DVec3,
        footprint: impl FnOnce() -> Footprint,
    ) -> Rgb {
        /// A share of a cube that is larger than any rounding, and too small to see.
        const DEPTH: f64 = 1.0 / 1024.0;
        match *self {
            Self::Plain(color) => color,
            Self::Checker(colors, scale) => {
                let Footprint(widths) = footprint();
                let below = point / scale.cells() - normal * DEPTH;
                let mean = checker::mean(below, widths / scale.cells());
                // The one at the origin is +1, the other -1.
                mean_of_shares(colors, (1.0 - mean) / 2.0)
            }
        }
    }

    /// The colour at `point`.
    pub fn color_at(&self, point: DVec3) -> Rgb {
        self.mean_color(point, DVec3::ZERO, || Footprint(DVec3::ZERO))
    }
}

fn is_near(point: DVec3) -> bool {
    point.is_finite() && point.abs().max_element() <= FARTHEST
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_size_or_no_place_is_no_body() {
        let far = DVec3::new(0.0, 1.1e9, 0.0);
        assert_eq!(Sphere::new(DVec3::ZERO, 0.0), None);
        assert_eq!(Sphere::new(DVec3::ZERO, f64::NAN), None);
        assert_eq!(Sphere::new(far, 1.0), None);
        assert_eq!(Plane::new(DVec3::ZERO, DVec3::ZERO), None);
        assert_eq!(Plane::new(DVec3::NAN, DVec3::X), None);
        assert_eq!(Block::new(DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0)), None);
        assert!(Sphere::new(DVec3::splat(FARTHEST), FARTHEST).is_some());
        assert!(Sphere::new(DVec3::ZERO, SMALLEST).is_some());
    }

    #[test]
    fn a_normal_may_have_any_length() {
        for length in [1e-320, 1e-200, 1.0, 1e300] {
            let plane = Plane::new(DVec3::ZERO, DVec3::new(0.0, length, -length)).unwrap();
            assert!((plane.normal().length() - 1.0).abs() < 1e-12, "{length}");
        }
    }

    #[test]
    fn clearance_is_negative_inside() {
        let sphere = Shape::Sphere(Sphere::new(DVec3::ZERO, 2.0).unwrap());
        assert_eq!(sphere.clearance(DVec3::new(3.0, 0.0, 0.0)), (1.0, DVec3::X));
        assert_eq!(sphere.clearance(DVec3::new(0.0, -1.0, 0.0)), (-1.0, -DVec3::Y));
        let block = Shape::Block(Block::new(DVec3::ZERO, DVec3::splat(4.0)).unwrap());
        assert_eq!(block.clearance(DVec3::new(2.0, 2.0, 5.0)), (1.0, DVec3::Z));
        assert_eq!(block.clearance(DVec3::new(2.0, 0.5, 2.0)), (-0.5, -DVec3::Y));
        let plane = Shape::Plane(Plane::new(DVec3::ZERO, DVec3::Z).unwrap());
        assert_eq!(plane.clearance(DVec3::new(9.0, 9.0, -2.0)), (2.0, -DVec3::Z));
    }
}
