//! Shapes relative to an eye, from which all rays of a picture start.
//!
//! Values that depend only on the eye are computed once, with high precision. The power of the eye
//! with respect to a sphere is a difference of squares, which are large for a large sphere; it is
//! computed with compensated sums. The roots of the quadratic equation are computed without
//! cancellation. Neither a planet under the eye nor a grain of sand on it loses digits.

use glam::{BVec3, DVec3};

use super::lanes::{Lanes, Vectors};
use crate::numeric::{two_product, two_sum};
use crate::world::scene::{Block, BodyShape, Plane, Sphere};

/// A shape relative to an eye.
#[derive(Clone, Copy, Debug)]
pub(crate) enum RelativeShape {
    Sphere(RelativeSphere),
    Plane(RelativePlane),
    Block(RelativeBlock),
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct RelativeSphere {
    /// The vector from the eye to the center.
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
    /// The squared distance to the center minus the squared radius: negative inside.
    power: f64,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct RelativePlane {
    normal: DVec3,
    /// The distance of the plane along its normal.
    distance: f64,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct RelativeBlock {
    /// The vectors from the eye to two corners.
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
}

impl RelativeShape {
    /// `shape` relative to `origin`.
    pub(crate) fn new(shape: &BodyShape, origin: DVec3) -> Self {
        match shape {
            BodyShape::Sphere(sphere) => Self::Sphere(RelativeSphere::new(sphere, origin)),
            BodyShape::Plane(plane) => Self::Plane(RelativePlane::new(plane, origin)),
            BodyShape::Block(block) => Self::Block(RelativeBlock::new(block, origin)),
        }
    }

    /// The distance to the shape in lengths of `direction`: 0 or more, and finite.
    #[inline]
    pub(crate) fn distance(&self, direction: DVec3) -> Option<f64> {
        let t = match self {
            Self::Sphere(sphere) => sphere.distance(direction),
            Self::Plane(plane) => plane.distance(direction),
            Self::Block(block) => block.distance(direction),
        };
        (0.0..f64::INFINITY).contains(&t).then_some(t)
    }

    /// The unit normal of the shape where `direction` meets it at `t`, on the side of the eye.
    pub(crate) fn normal(&self, direction: DVec3, t: f64) -> DVec3 {
        match self {
            Self::Sphere(sphere) => sphere.normal(direction, t),
            Self::Plane(plane) => facing_eye(unit(plane.normal), direction),
            Self::Block(block) => block.normal(direction),
        }
    }

    /// The unit normal on the side of the eye, if it is the same wherever a ray hits the shape.
    pub(crate) fn common_normal(&self) -> Option<DVec3> {
        let Self::Plane(RelativePlane { normal, distance }) = *self else { return None };
        // If the normal is not exactly a unit vector, or if the eye is on the plane, the side
        // depends on the rounding of each ray.
        let is_certain = unit(normal) == normal && distance != 0.0;
        is_certain.then(|| if distance > 0.0 { -normal } else { normal })
    }

    /// Sets each lane of `normals` to the normal for the lane's direction and `t`.
    #[inline(always)]
    pub(crate) fn find_normals(&self, directions: &Vectors, t: &Lanes, normals: &mut Vectors) {
        match self {
            Self::Sphere(sphere) => {
                normals.fill(
                    #[inline(always)]
                    |lane| sphere.normal(directions.get(lane), t[lane]),
                );
            }
            Self::Plane(plane) => {
                let normal = unit(plane.normal);
                normals.fill(
                    #[inline(always)]
                    |lane| facing_eye(normal, directions.get(lane)),
                );
            }
            Self::Block(block) => normals.fill(
                #[inline(always)]
                |lane| block.normal(directions.get(lane)),
            ),
        }
    }
}

/// The vector divided by its length. Only the exact center of a sphere has no direction, and the
/// center is not on the surface.
#[inline(always)]
fn unit(vector: DVec3) -> DVec3 {
    let per_length = 1.0 / vector.dot(vector).sqrt();
    let has_direction = (per_length > 0.0) & (per_length < f64::INFINITY);
    DVec3::select(BVec3::splat(has_direction), vector * per_length, DVec3::Z)
}

/// `normal`, or its opposite if that is on the side of the eye.
#[inline(always)]
fn facing_eye(normal: DVec3, direction: DVec3) -> DVec3 {
    normal * if normal.dot(direction) > 0.0 { -1.0 } else { 1.0 }
}

impl RelativeSphere {
    fn new(sphere: &Sphere, origin: DVec3) -> Self {
        let (center, radius) = (sphere.center(), sphere.radius());
        Self { center: center - origin, radius, power: power(origin, center, radius) }
    }

    /// The distance to the sphere; NaN or negative if the sphere is not ahead. The code has no
    /// branches, so neighbouring rays are calculated together.
    #[inline(always)]
    pub(crate) fn distance(&self, direction: DVec3) -> f64 {
        let Self { center, radius, power } = *self;
        let square = direction.dot(direction);
        let along = center.dot(direction);
        // The squared half of the chord, from the distance between the ray and the center (Haines
        // and others, "Precision Improvements for Ray/Sphere Intersection", 2019). The usual
        // discriminant `b² - 4ac` would lose a small sphere far away.
        let beside = center - direction * (along / square);
        let half_chord = (radius * radius - beside.dot(beside)) * square;
        // NaN if the ray misses the sphere.
        let root = half_chord.sqrt();
        let far = along + root;
        let (dividend, divisor) = match (power < 0.0, along > 0.0) {
            (false, true) => (power, far),
            (false, false) => (f64::NAN, far),
            (true, true) => (far, square),
            (true, false) => (power, along - root),
        };
        dividend / divisor
    }

    #[inline(always)]
    fn normal(&self, direction: DVec3, t: f64) -> DVec3 {
        facing_eye(unit(direction * t - self.center), direction)
    }
}

/// The power of `point` with respect to a sphere, accurate to the last digits despite cancellation.
fn power(point: DVec3, center: DVec3, radius: f64) -> f64 {
    let mut sum = Sum::default();
    for (one, other) in [(center.x, point.x), (center.y, point.y), (center.z, point.z)] {
        let [difference, error] = two_sum(one, -other);
        sum.add_product(difference, difference);
        sum.add_product(2.0 * difference, error);
        sum.add_product(error, error);
    }
    sum.add_product(radius, -radius);
    sum.total + sum.error
}

/// A compensated sum and its rounding error, as in the dot product of Ogita, Rump and Oishi
/// ("Accurate Sum and Dot Product", 2005).
#[derive(Default)]
struct Sum {
    total: f64,
    error: f64,
}

impl Sum {
    fn add(&mut self, term: f64) {
        let [total, error] = two_sum(self.total, term);
        self.total = total;
        self.error += error;
    }

    fn add_product(&mut self, one: f64, other: f64) {
        let [product, error] = two_product(one, other);
        self.add(product);
        self.add(error);
    }
}

impl RelativePlane {
    fn new(plane: &Plane, origin: DVec3) -> Self {
        let normal = plane.normal();
        Self { normal, distance: normal.dot(plane.point() - origin) }
    }

    /// The distance to the plane; negative if the plane is not ahead, infinite or NaN if the
    /// direction is parallel to it.
    #[inline(always)]
    pub(crate) fn distance(&self, direction: DVec3) -> f64 {
        self.distance / self.normal.dot(direction)
    }

    /// Whether the distance depends only on the `z` of a direction.
    pub(crate) fn is_horizontal(&self) -> bool {
        self.normal.x == 0.0 && self.normal.y == 0.0
    }

    /// Whether a ray in this direction approaches the plane.
    pub(crate) fn is_ahead(&self, direction: DVec3) -> bool {
        self.distance * self.normal.dot(direction) >= 0.0
    }
}

impl RelativeBlock {
    #[inline(always)]
    pub(crate) fn new(block: &Block, origin: DVec3) -> Self {
        Self { low: block.low() - origin, high: block.high() - origin }
    }

    /// The distance to the block; NaN or negative if the block is not ahead.
    #[inline(always)]
    pub(crate) fn distance(&self, direction: DVec3) -> f64 {
        let (enters, leaves) = self.crossings(direction);
        let (enter, leave) = (enters.max_element(), leaves.min_element());
        let nearest = if enter >= 0.0 { enter } else { leave };
        if enter <= leave { nearest } else { f64::NAN }
    }

    /// The distances at which a ray enters and leaves the slab between the two faces of each axis,
    /// as in the slab method of Kay and Kajiya ("Ray Tracing Complex Scenes", 1986).
    #[inline(always)]
    pub(crate) fn crossings(&self, direction: DVec3) -> (DVec3, DVec3) {
        let slabs = [
            slab(self.low.x, self.high.x, direction.x),
            slab(self.low.y, self.high.y, direction.y),
            slab(self.low.z, self.high.z, direction.z),
        ];
        let [(x, past_x), (y, past_y), (z, past_z)] = slabs;
        (DVec3::new(x, y, z), DVec3::new(past_x, past_y, past_z))
    }

    /// The unit normal of the face where `direction` meets the block, on the side of the eye.
    #[inline(always)]
    fn normal(&self, direction: DVec3) -> DVec3 {
        let (enters, leaves) = self.crossings(direction);
        let (enter, leave) = (enters.max_element(), leaves.min_element());
        let (times, t) = if enter >= 0.0 { (enters, enter) } else { (leaves, leave) };
        let axis = if times.x == t {
            DVec3::X
        } else if times.y == t {
            DVec3::Y
        } else {
            DVec3::Z
        };
        facing_eye(axis, direction)
    }
}

/// The distances at which a ray enters and leaves the slab between `low` and `high`, for this
/// component of its direction. A ray that is parallel to the slab is always inside or never.
#[inline(always)]
fn slab(low: f64, high: f64, direction: f64) -> (f64, f64) {
    let (one, other) = (low / direction, high / direction);
    let crossings = if one < other { (one, other) } else { (other, one) };
    let is_between = (low <= 0.0) & (high >= 0.0);
    let parallel = if is_between { f64::NEG_INFINITY } else { f64::INFINITY };
    if direction == 0.0 { (parallel, -parallel) } else { crossings }
}
