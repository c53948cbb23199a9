//! The projection: which ray a column stands for, and which rows a wall covers.
//!
//! It is true on any window and any font: the focal length in pixels is `(w/2) / tan(fov/2)`, and
//! vertically that divided by the shape of a pixel, so that a cube looks like a cube. Rows and
//! columns are taken at the centres of pixels.

use std::ops::Range;

use glam::DVec2;

use super::texels_down::TexelsDown;
use super::track::Track;
use super::{FrameSize, PixelAspect};
use crate::cast::Ray;
use crate::world::Camera;

/// How the world maps to the pixels of one frame.
#[derive(Clone, Debug)]
pub(super) struct Projection {
    origin: DVec2,
    direction: DVec2,
    plane: DVec2,
    width: u32,
    height: f64,
    /// The row that the eye's own height falls on, in pixels from the top.
    horizon: f64,
    /// Rows from the horizon to something 1 above the eye at distance 1.
    focal_length: f64,
    /// Columns from the middle to something 1 beside it at distance 1.
    focal_length_across: f64,
}

impl Projection {
    pub(super) fn new(camera: &Camera, size: FrameSize, pixel_aspect: PixelAspect) -> Self {
        let width = size.width.get();
        let height = f64::from(size.height.get());
        let across = f64::from(width) / 2.0 / camera.field_of_view.half_width();
        Self {
            origin: camera.position(),
            direction: camera.direction(),
            plane: camera.plane(),
            width,
            height,
            horizon: height / 2.0,
            focal_length: across / pixel_aspect.height_over_width(),
            focal_length_across: across,
        }
    }

    /// Where the camera stands.
    pub(super) fn origin(&self) -> DVec2 {
        self.origin
    }

    /// How many columns of pixels there are.
    pub(super) fn columns(&self) -> usize {
        self.width as usize
    }

    /// The rays of all columns, from left to right, each through the middle of its pixels.
    ///
    /// A ray's `t` is the distance to the camera plane, so nothing needs correcting afterwards.
    pub(super) fn rays(&self) -> impl Iterator<Item = Ray> {
        (0..self.width).map(move |column| {
            Ray::new(self.origin, self.direction_of(column))
                .expect("a camera is at a finite place, and its plane is not parallel to its view")
        })
    }

    /// The direction of the ray of `column`.
    pub(super) fn direction_of(&self, column: u32) -> DVec2 {
        let width = f64::from(self.width);
        // The quotient of two whole numbers: a column and its mirror image get opposite ones.
        let across = (f64::from(column) * 2.0 + 1.0 - width) / width;
        self.direction + self.plane * across
    }

    /// The rows whose centres are between the top and the bottom of a wall, 1 high, at distance `t`.
    pub(super) fn wall_rows(&self, t: f64) -> Range<u32> {
        let half = 0.5 * self.focal_length / t;
        self.first_row_below(self.horizon - half)..self.first_row_below(self.horizon + half)
    }

    /// Where on a wall at distance `t` the rows of pixels are, in `count` texels from its top to its
    /// bottom.
    pub(super) fn texels_down_the_wall(&self, t: f64, count: usize) -> TexelsDown {
        TexelsDown::new(2.0 * self.horizon, t / self.focal_length, count)
    }

    /// How much of a wall's side the pixels of a column cover, in square cells each: where its ray,
    /// at `t`, meets the wall with a `slope` of that much towards it for each unit of `t`.
    pub(super) fn pixel_area_on_wall(&self, t: f64, slope: f64) -> f64 {
        let down = t / self.focal_length;
        let across = t / (self.focal_length_across * slope.abs());
        down * across
    }

    /// What `row` shows of the floor or the ceiling: they are half a cell from the eye.
    pub(super) fn track(&self, row: u32) -> Track {
        let slope = self.slope(row).abs();
        let distance = 0.5 / slope;
        // A row further down, the distance is less by that.
        let along = distance / slope / self.focal_length;
        Track {
            distance,
            pixel_area: along * distance / self.focal_length_across,
            middle: self.origin + self.direction * distance,
            half_step: self.plane * (distance / f64::from(self.width)),
            width: self.width,
        }
    }

    /// How much higher than the eye something is that shows in the middle of `row`, for each cell
    /// that it is away; negative below the horizon.
    pub(super) fn slope(&self, row: u32) -> f64 {
        (self.horizon - (f64::from(row) + 0.5)) / self.focal_length
    }

    /// The angles, in radians, that a pixel in the middle of the picture covers, across and down.
    pub(super) fn pixel_angles(&self) -> DVec2 {
        DVec2::new(1.0 / self.focal_length_across, 1.0 / self.focal_length)
    }

    /// The first row with its centre at `y` or below; the number of rows where there is none.
    fn first_row_below(&self, y: f64) -> u32 {
        // The cast takes what is not a number, as of a wall infinitely far through an infinitely
        // long lens, to 0.
        (y - 0.5).ceil().clamp(0.0, self.height) as u32
    }
}
