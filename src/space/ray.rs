//! A ray, and what it hits.

use glam::DVec3;

/// A half-line. One without a direction hits nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it begins.
    pub origin: DVec3,
    /// Where it goes, of any length.
    pub direction: DVec3,
}

impl Ray {
    /// The ray from `origin` in that direction.
    pub const fn new(origin: DVec3, direction: DVec3) -> Self {
        Self { origin, direction }
    }

    /// Where it is at `t`.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }
}

/// What a ray hits first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Which body, by its place in the scene.
    pub body: usize,
    /// How far along the ray, in lengths of its direction: 0 or more.
    pub t: f64,
    /// The unit vector at a right angle to the body's surface there, on the side of the ray.
    pub normal: DVec3,
}
