//! A single ray, and its hit.

use glam::DVec3;

use super::relative_shape::RelativeShape;
use crate::world::scene::Scene;

/// A half-line. A ray with a direction of zero hits nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The start.
    pub origin: DVec3,
    /// The direction, of any length.
    pub direction: DVec3,
}

impl Ray {
    /// The ray from `origin` in this direction.
    pub const fn new(origin: DVec3, direction: DVec3) -> Self {
        Self { origin, direction }
    }

    /// The point at `t`.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }
}

/// The first intersection of a ray with a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The index of the body in the scene.
    pub body: usize,
    /// The distance along the ray, in lengths of its direction: 0 or more.
    pub t: f64,
    /// The unit normal of the body's surface, on the side of the ray's start.
    pub normal: DVec3,
}

impl Scene {
    /// The first hit of `ray`.
    pub fn cast(&self, ray: &Ray) -> Option<Hit> {
        let mut nearest: Option<(RelativeShape, usize, f64)> = None;
        for (index, body) in self.bodies.iter().enumerate() {
            let relative = RelativeShape::new(&body.shape, ray.origin);
            let Some(t) = relative.distance(ray.direction) else { continue };
            if nearest.is_none_or(|(_, _, before)| t < before) {
                nearest = Some((relative, index, t));
            }
        }
        let (relative, body, t) = nearest?;
        Some(Hit { body, t, normal: relative.normal(ray.direction, t) })
    }
}
