//! The camera: a position, a heading, and an elevation.

use glam::DVec3;

use super::ray::Ray;
use crate::render::{FrameSize, PixelAspect};
use crate::world::scene::{Elevation, Scene, SceneStart, is_near};
use crate::world::{FieldOfView, Heading};

/// A position with a viewing direction and a field of view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    position: DVec3,
    /// The compass direction, as on a map.
    pub heading: Heading,
    /// The angle above or below the horizon.
    pub elevation: Elevation,
    /// The horizontal field of view.
    pub field_of_view: FieldOfView,
}

impl Camera {
    /// A level camera at `position`, in cells. `None` if a coordinate is beyond [`MAX_COORDINATE`](super::MAX_COORDINATE).
    pub fn new(position: DVec3, heading: Heading, field_of_view: FieldOfView) -> Option<Self> {
        let elevation = Elevation::LEVEL;
        is_near(position).then_some(Self { position, heading, elevation, field_of_view })
    }

    /// The same camera with another elevation.
    #[must_use]
    pub fn with_elevation(self, elevation: Elevation) -> Self {
        Self { elevation, ..self }
    }

    /// The position, in cells.
    pub fn position(&self) -> DVec3 {
        self.position
    }

    /// The ray through the middle of a pixel, with columns counted from the left and rows from the
    /// top. Its `t` is the distance to the camera plane.
    pub fn ray(&self, size: FrameSize, pixel_aspect: PixelAspect, column: u32, row: u32) -> Ray {
        let projection = SceneProjection::new(self, size, pixel_aspect);
        Ray::new(self.position, projection.across(column) + projection.upwards(row))
    }

    /// The unit vectors to the right, to the top and into the picture.
    pub fn axes(&self) -> Axes {
        let level = self.heading.direction();
        let radians = self.elevation.radians();
        let (sin, cos) = (libm::sin(radians), libm::cos(radians));
        Axes {
            right: level.perp().extend(0.0),
            up: (level * -sin).extend(cos),
            forward: (level * cos).extend(sin),
        }
    }
}

impl Scene {
    /// A camera at the player's start.
    #[expect(clippy::missing_panics_doc, reason = "a start is where a camera can be")]
    pub fn start_camera(&self, field_of_view: FieldOfView) -> Camera {
        let SceneStart { heading, elevation, .. } = self.start;
        Camera::new(self.start.position(), heading, field_of_view)
            .expect("a start is where a camera can be")
            .with_elevation(elevation)
    }
}

/// Three unit vectors that are perpendicular to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// To the right of the picture.
    pub right: DVec3,
    /// To the top of the picture.
    pub up: DVec3,
    /// Into the picture, through its middle.
    pub forward: DVec3,
}

/// The mapping from the world to the pixels of one frame. A cube looks like a cube with pixels of
/// any shape, as in the grid's renderer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SceneProjection {
    pub(crate) origin: DVec3,
    pub(crate) axes: Axes,
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// The number of columns from the middle of the picture to a point that is 1 to the side at
    /// distance 1.
    pub(crate) columns_a_cell: f64,
    /// The number of rows from the middle of the picture to a point that is 1 above at distance 1.
    pub(crate) rows_a_cell: f64,
}

impl SceneProjection {
    pub(crate) fn new(camera: &Camera, size: FrameSize, pixel_aspect: PixelAspect) -> Self {
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

    /// The direction through the middle of a column, at the middle of the picture's height. Its sum
    /// with [`SceneProjection::upwards`] is the direction of a ray, whose `t` is the distance to the
    /// camera plane.
    pub(crate) fn across(&self, column: u32) -> DVec3 {
        // The offsets are exact halves, so a column and its mirror image have exactly opposite
        // slopes.
        let slope = (f64::from(column) + 0.5 - f64::from(self.width) / 2.0) / self.columns_a_cell;
        self.axes.forward + self.axes.right * slope
    }

    /// The vector from the direction at the middle of the picture's height to the middle of a row.
    pub(crate) fn upwards(&self, row: u32) -> DVec3 {
        let slope = (f64::from(self.height) / 2.0 - f64::from(row) - 0.5) / self.rows_a_cell;
        self.axes.up * slope
    }

    /// The changes of direction from a pixel to the next column and to the next row upwards.
    pub(crate) fn steps(&self) -> [DVec3; 2] {
        [self.axes.right / self.columns_a_cell, self.axes.up / self.rows_a_cell]
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn the_axes_are_perpendicular_and_right_is_to_the_right() {
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
            // South is to the right of a camera that looks east.
            assert!(right.dot(heading.turned(FRAC_PI_2).direction().extend(0.0)) > 0.999);
        }
    }
}
