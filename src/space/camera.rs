//! The camera: a place, a heading, and how far it is turned up or down.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use super::FARTHEST;
use super::ray::Ray;
use crate::render::{FrameSize, PixelAspect};
use crate::world::{FieldOfView, Heading};

/// How far the eye of a player keeps from every body, in cells.
pub const EYE_ROOM: f64 = 0.25;

/// How far up or down somebody looks: from straight down to straight up.
///
/// Past that they would see the world upside down, and left would be right.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Elevation {
    radians: f64,
}

impl Elevation {
    /// Neither up nor down.
    pub const LEVEL: Self = Self { radians: 0.0 };

    /// An elevation from degrees, from -90, straight down, to 90, straight up. `None` outside that.
    pub fn from_degrees(degrees: f64) -> Option<Self> {
        let is_within = (-90.0..=90.0).contains(&degrees);
        is_within.then(|| Self::LEVEL.raised(degrees.to_radians()))
    }

    /// Degrees, positive for up.
    pub fn degrees(self) -> f64 {
        self.radians.to_degrees()
    }

    /// Radians, positive for up.
    pub fn radians(self) -> f64 {
        self.radians
    }

    /// Raised by `radians`, or lowered where they are negative, up to the limit; what is no number
    /// changes nothing.
    #[must_use]
    pub fn raised(self, radians: f64) -> Self {
        if radians.is_nan() {
            return self;
        }
        Self { radians: (self.radians + radians).clamp(-FRAC_PI_2, FRAC_PI_2) }
    }
}

/// Where somebody is, which way they look, and how wide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    position: DVec3,
    /// Which way it looks, as on a map.
    pub heading: Heading,
    /// How far up or down it looks.
    pub elevation: Elevation,
    /// How wide it sees.
    pub field_of_view: FieldOfView,
}

impl Camera {
    /// A camera at `position`, in cells, that looks level. `None` where the position is further away
    /// than [`FARTHEST`] along any axis.
    pub fn new(position: DVec3, heading: Heading, field_of_view: FieldOfView) -> Option<Self> {
        let is_near = position.is_finite() && position.abs().max_element() <= FARTHEST;
        let elevation = Elevation::LEVEL;
        is_near.then_some(Self { position, heading, elevation, field_of_view })
    }

    /// The same camera, looking up or down.
    #[must_use]
    pub fn with_elevation(self, elevation: Elevation) -> Self {
        Self { elevation, ..self }
    }

    /// Where it is, in cells.
    pub fn position(&self) -> DVec3 {
        self.position
    }

    /// The ray through the middle of a pixel of a picture: of that column from the left, and that row
    /// from the top. Its `t` is the distance to the camera plane.
    pub fn ray(&self, size: FrameSize, pixel_aspect: PixelAspect, column: u32, row: u32) -> Ray {
        let projection = Projection::new(self, size, pixel_aspect);
        Ray::new(self.position, projection.across(column) + projection.upwards(row))
    }

    /// The unit vectors to the right of the picture, to its top, and through its middle.
    pub fn axes(&self) -> Axes {
        let level = self.heading.direction();
        let radians = self.elevation.radians;
        let (sin, cos) = (libm::sin(radians), libm::cos(radians));
        Axes {
            right: level.perp().extend(0.0),
            up: (level * -sin).extend(cos),
            forward: (level * cos).extend(sin),
        }
    }
}

/// Three unit vectors at right angles to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// To the right of the picture.
    pub right: DVec3,
    /// To its top.
    pub up: DVec3,
    /// Through its middle, away from the eye.
    pub forward: DVec3,
}

/// How the world maps to the pixels of one frame, as true as that of the grid's renderer: a cube
/// looks like a cube whatever the shape of a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Projection {
    pub(super) origin: DVec3,
    pub(super) axes: Axes,
    pub(super) width: u32,
    pub(super) height: u32,
    /// Columns from the middle to something 1 beside it at distance 1.
    pub(super) columns_a_cell: f64,
    /// Rows from the middle to something 1 above it at distance 1.
    pub(super) rows_a_cell: f64,
}

impl Projection {
    pub(super) fn new(camera: &Camera, size: FrameSize, pixel_aspect: PixelAspect) -> Self {
        let width = size.width.get();
        let across = f64::from(width) / 2.0 / camera.field_of_view.half_width();
        Self {
            origin: camera.position,
            axes: camera.axes(),
            width,
            height: size.height.get(),
            columns_a_cell: across,
            rows_a_cell: across / pixel_aspect.height_over_width(),
        }
    }

    /// The direction through the middle of a column, as high as the middle of the picture. With
    /// [`Projection::upwards`] it makes that of a ray, whose `t` is the distance to the camera plane.
    pub(super) fn across(&self, column: u32) -> DVec3 {
        // Halves of whole numbers: a column and its mirror image get opposite ones.
        let slope = (f64::from(column) + 0.5 - f64::from(self.width) / 2.0) / self.columns_a_cell;
        self.axes.forward + self.axes.right * slope
    }

    /// From there to the middle of a row.
    pub(super) fn upwards(&self, row: u32) -> DVec3 {
        let slope = (f64::from(self.height) / 2.0 - f64::from(row) - 0.5) / self.rows_a_cell;
        self.axes.up * slope
    }

    /// From the direction through a pixel to those through the next column and the next row up.
    pub(super) fn steps(&self) -> [DVec3; 2] {
        [self.axes.right / self.columns_a_cell, self.axes.up / self.rows_a_cell]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axes_are_at_right_angles_and_right_is_right() {
        for (degrees, elevation) in [(0.0, 0.0), (33.0, 20.0), (270.0, -90.0), (100.0, 90.0)] {
            let heading = Heading::from_degrees(degrees).unwrap();
            let camera = Camera::new(DVec3::ZERO, heading, FieldOfView::default()).unwrap();
            let camera = camera.with_elevation(Elevation::from_degrees(elevation).unwrap());
            let Axes { right, up, forward } = camera.axes();
            for (one, other) in [(right, up), (up, forward), (forward, right)] {
                assert!(one.dot(other).abs() < 1e-15 && (one.length() - 1.0).abs() < 1e-15);
            }
            assert!(up.z >= 0.0);
            assert_eq!(forward.z, libm::sin(camera.elevation.radians()));
            // Who looks east has the south to their right.
            assert!(right.dot(heading.turned(FRAC_PI_2).direction().extend(0.0)) > 0.999);
        }
    }

    #[test]
    fn nobody_looks_past_straight_up() {
        let up = Elevation::from_degrees(90.0).unwrap();
        assert_eq!(Elevation::LEVEL.raised(f64::INFINITY), up);
        assert_eq!(up.raised(f64::NAN), up);
        assert_eq!(Elevation::from_degrees(90.5), None);
        assert_eq!(Elevation::from_degrees(f64::NAN), None);
    }
}
