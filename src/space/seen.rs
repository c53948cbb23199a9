//! Bodies as seen from one place, from which all rays of a picture begin.
//!
//! What depends on that place only is computed once, and can afford to be exact: for a sphere the power
//! of the place, which is the difference of two large squares where the sphere is large, in twice the
//! digits. The roots of the quadratic are taken without a difference of like numbers, so that neither a
//! planet underfoot nor a grain of sand on it loses digits.

use glam::DVec3;

use super::body::{Block, Plane, Shape, Sphere};
use crate::numeric::{two_product, two_sum};

/// A shape as seen from one place.
#[derive(Clone, Copy, Debug)]
pub(super) enum Seen {
    Sphere(SeenSphere),
    Plane(SeenPlane),
    Block(SeenBlock),
}

#[derive(Clone, Copy, Debug)]
pub(super) struct SeenSphere {
    /// From the place to the center.
    pub(super) center: DVec3,
    pub(super) radius: f64,
    /// The square of the distance to the center less that of the radius: negative inside.
    power: f64,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct SeenPlane {
    normal: DVec3,
    /// How far the plane is along its normal.
    distance: f64,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct SeenBlock {
    /// From the place to two corners.
    pub(super) low: DVec3,
    pub(super) high: DVec3,
}

impl Seen {
    /// `shape`, as seen from `origin`.
    pub(super) fn new(shape: &Shape, origin: DVec3) -> Self {
        match shape {
            Shape::Sphere(sphere) => Self::Sphere(SeenSphere::new(sphere, origin)),
            Shape::Plane(plane) => Self::Plane(SeenPlane::new(plane, origin)),
            Shape::Block(block) => Self::Block(SeenBlock::new(block, origin)),
        }
    }

    /// How many times `direction` it is to the shape: 0 or more, and finite.
    #[inline]
    pub(super) fn distance(&self, direction: DVec3) -> Option<f64> {
        let t = match self {
            Self::Sphere(sphere) => sphere.distance(direction),
            Self::Plane(plane) => Some(plane.distance(direction)),
            Self::Block(block) => block.distance(direction),
        };
        t.filter(|t| (0.0..f64::INFINITY).contains(t))
    }

    /// The unit vector at a right angle to the shape, on this side of it, where `direction` meets it
    /// after `t`.
    pub(super) fn normal(&self, direction: DVec3, t: f64) -> DVec3 {
        let normal = match self {
            Self::Sphere(sphere) => direction * t - sphere.center,
            Self::Plane(plane) => plane.normal,
            Self::Block(block) => block.normal(direction),
        };
        // Only the exact middle of a sphere has none, and it is not on the sphere.
        let normal = normal.try_normalize().unwrap_or(DVec3::Z);
        if normal.dot(direction) > 0.0 { -normal } else { normal }
    }
}

impl SeenSphere {
    fn new(sphere: &Sphere, origin: DVec3) -> Self {
        let (center, radius) = (sphere.center(), sphere.radius());
        Self { center: center - origin, radius, power: power(origin, center, radius) }
    }

    fn distance(&self, direction: DVec3) -> Option<f64> {
        let Self { center, radius, power } = *self;
        let square = direction.dot(direction);
        let along = center.dot(direction);
        // The square of half the chord, by way of how far the ray passes from the center: the textbook's
        // `b² - 4ac` loses a small sphere far away.
        let beside = center - direction * (along / square);
        let half_chord = (radius * radius - beside.dot(beside)) * square;
        if half_chord < 0.0 {
            return None;
        }
        let root = half_chord.sqrt();
        let is_inside = power < 0.0;
        match (is_inside, along > 0.0) {
            (false, true) => Some(power / (along + root)),
            (false, false) => None,
            (true, true) => Some((along + root) / square),
            (true, false) => Some(power / (along - root)),
        }
    }
}

/// The power of `point` with respect to a sphere, correct to the last digits however much cancels.
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

/// A sum of many numbers, and what was lost in adding them up.
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

impl SeenPlane {
    fn new(plane: &Plane, origin: DVec3) -> Self {
        let normal = plane.normal();
        Self { normal, distance: normal.dot(plane.point() - origin) }
    }

    /// Infinite, or no number, along the plane.
    fn distance(&self, direction: DVec3) -> f64 {
        self.distance / self.normal.dot(direction)
    }

    /// Whether a ray in that direction goes towards the plane.
    pub(super) fn is_ahead(&self, direction: DVec3) -> bool {
        self.distance * self.normal.dot(direction) >= 0.0
    }
}

impl SeenBlock {
    fn new(block: &Block, origin: DVec3) -> Self {
        Self { low: block.low() - origin, high: block.high() - origin }
    }

    fn distance(&self, direction: DVec3) -> Option<f64> {
        let (enters, leaves) = self.crossings(direction);
        let (enter, leave) = (enters.max_element(), leaves.min_element());
        (enter <= leave && leave >= 0.0).then_some(if enter >= 0.0 { enter } else { leave })
    }

    /// When a ray gets between the two sides of each axis, and when it gets out again.
    #[inline]
    fn crossings(&self, direction: DVec3) -> (DVec3, DVec3) {
        let slabs = [
            slab(self.low.x, self.high.x, direction.x),
            slab(self.low.y, self.high.y, direction.y),
            slab(self.low.z, self.high.z, direction.z),
        ];
        let [(x, past_x), (y, past_y), (z, past_z)] = slabs;
        (DVec3::new(x, y, z), DVec3::new(past_x, past_y, past_z))
    }

    fn normal(&self, direction: DVec3) -> DVec3 {
        let (enters, leaves) = self.crossings(direction);
        let (enter, leave) = (enters.max_element(), leaves.min_element());
        let (times, t) = if enter >= 0.0 { (enters, enter) } else { (leaves, leave) };
        if times.x == t {
            DVec3::X
        } else if times.y == t {
            DVec3::Y
        } else {
            DVec3::Z
        }
    }
}

/// When a ray with that component of its direction is between `low` and `high`: for ever, or never,
/// where it goes along them.
#[inline]
fn slab(low: f64, high: f64, direction: f64) -> (f64, f64) {
    if direction == 0.0 {
        let is_between = low <= 0.0 && high >= 0.0;
        return if is_between {
            (f64::NEG_INFINITY, f64::INFINITY)
        } else {
            (f64::INFINITY, f64::NEG_INFINITY)
        };
    }
    let (one, other) = (low / direction, high / direction);
    if one < other { (one, other) } else { (other, one) }
}
