//! The ray, and the scaling of its direction.

use std::fmt;

use glam::DVec2;

/// A half-line on the map, with a finite origin and a finite direction that is not zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    origin: DVec2,
    direction: DVec2,
}

impl Ray {
    /// The ray from `origin`, in cells, along `direction`, which may have any length but zero.
    ///
    /// # Errors
    /// Returns an error if either is not finite, or if the direction is zero.
    pub fn new(origin: DVec2, direction: DVec2) -> Result<Self, RayError> {
        if !origin.is_finite() {
            Err(RayError::Origin)
        } else if !direction.is_finite() {
            Err(RayError::Direction)
        } else if direction == DVec2::ZERO {
            Err(RayError::NoDirection)
        } else {
            Ok(Self { origin, direction })
        }
    }

    /// The start.
    pub fn origin(&self) -> DVec2 {
        self.origin
    }

    /// The direction, whose length is the unit of `t`.
    pub fn direction(&self) -> DVec2 {
        self.direction
    }

    /// The point at `t`.
    pub fn at(&self, t: f64) -> DVec2 {
        self.origin + self.direction * t
    }

    /// The direction scaled by a power of two so that its larger component is between 1/2 and 1,
    /// and the exponent of the divisor. The smaller component underflows to 0 if it is too small
    /// relative to the larger one.
    pub fn scaled_direction(&self) -> (DVec2, i32) {
        let exponent = libm::ilogb(self.direction.abs().max_element()) + 1;
        let scale = |component| libm::scalbn(component, -exponent);
        (DVec2::new(scale(self.direction.x), scale(self.direction.y)), exponent)
    }

    /// The ray of a camera, which is at a finite place and whose directions are finite and not zero.
    #[inline]
    pub(crate) fn of_camera(origin: DVec2, direction: DVec2) -> Self {
        debug_assert!(Self::new(origin, direction).is_ok(), "{origin} {direction}");
        Self { origin, direction }
    }

    /// The ray of the same line with another origin and another unit of `t`.
    pub fn moved(origin: DVec2, direction: DVec2) -> Self {
        Self { origin, direction }
    }
}

/// The error of [`Ray::new`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayError {
    /// The origin is not finite.
    Origin,
    /// The direction is not finite.
    Direction,
    /// The direction is zero.
    NoDirection,
}

impl fmt::Display for RayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Origin => "a ray's origin must be two finite numbers",
            Self::Direction => "a ray's direction must be two finite numbers",
            Self::NoDirection => "a ray's direction must not be zero",
        })
    }
}

impl std::error::Error for RayError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_ray_without_a_direction() {
        let ray = |x, y, dx, dy| Ray::new(DVec2::new(x, y), DVec2::new(dx, dy));
        assert_eq!(ray(0.0, 0.0, 0.0, -0.0), Err(RayError::NoDirection));
        assert_eq!(ray(0.0, f64::NAN, 1.0, 0.0), Err(RayError::Origin));
        assert_eq!(ray(0.0, 0.0, f64::INFINITY, 0.0), Err(RayError::Direction));
    }

    #[test]
    fn scaling_a_direction_keeps_its_slope() {
        for (direction, scaled) in [
            ((3.0, -4.0), (0.375, -0.5)),
            ((1.0, 0.0), (0.5, 0.0)),
            ((5e-324, -5e-324), (0.5, -0.5)),
            ((2f64.powi(1023), 5e-324), (0.5, 0.0)),
        ] {
            let ray = Ray::new(DVec2::ZERO, DVec2::from(direction)).unwrap();
            assert_eq!(ray.scaled_direction().0, DVec2::from(scaled));
        }
    }
}
