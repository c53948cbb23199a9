//! The projection: the ray of each column, and the rows of each height at each distance.
//!
//! Proportions are true for any window and any font. The focal length is `(w/2) / tan(fov/2)` pixels across,
//! and this value divided by the pixel aspect down. Rows and columns are sampled at the centres of pixels.

use std::num::NonZeroU32;
use std::ops::{Range, RangeInclusive};

use glam::DVec2;

use super::SpanMapping;
use super::texture_stepper::{FaceTexels, Horizon};
use crate::numeric::rounding::{ceil, ceil_within};
use crate::world::{Camera, Heights};

/// The mapping from the world to the pixels of one frame.
#[derive(Clone, Debug)]
pub struct Projection {
    origin: DVec2,
    direction: DVec2,
    plane: DVec2,
    width: u32,
    height: f64,
    /// The horizon, at eye height, in rows from the top; it may be far outside the picture.
    horizon: f64,
    /// The same horizon, for texture steppers.
    horizon_of_texels: Horizon,
    /// The height of the eye.
    eye: f64,
    /// The number of rows from the horizon to a point 1 above the eye at distance 1.
    focal_length: f64,
    /// The number of columns from the middle to a point 1 to its side at distance 1.
    focal_length_across: f64,
}

/// The position of a point in a picture.
#[derive(Clone, Copy, Debug)]
pub struct ProjectedPoint {
    /// The distance from the camera plane, in cells; at most 0 for a point behind it.
    pub depth: f64,
    /// The number of columns of pixels from the left edge.
    pub column: f64,
}

impl Projection {
    /// The projection of `camera` onto pictures of this size.
    pub fn new(camera: &Camera, size: FrameSize, pixel_aspect: PixelAspect) -> Self {
        Self::of_samples(camera, size, pixel_aspect, 1)
    }

    /// The projection onto the samples of such pictures, with this number of samples along both sides of each
    /// pixel. To it, every sample is a pixel.
    pub(crate) fn of_samples(
        camera: &Camera,
        size: FrameSize,
        pixel_aspect: PixelAspect,
        samples: u32,
    ) -> Self {
        let width = size.width.get() * samples;
        let height = f64::from(size.height.get() * samples);
        let across = f64::from(width) / 2.0 / camera.field_of_view.half_width();
        let focal_length = across / pixel_aspect.height_over_width();
        let samples = f64::from(samples);
        // A change of pitch moves the picture by whole pixels.
        let horizon = height / 2.0 + samples * rows_of_pitch(camera, focal_length / samples);
        Self {
            eye: camera.eye().clamp(-FARTHEST, FARTHEST),
            origin: camera.position(),
            direction: camera.direction(),
            plane: camera.plane(),
            width,
            height,
            horizon,
            horizon_of_texels: Horizon::new(2.0 * horizon),
            focal_length,
            focal_length_across: across,
        }
    }

    /// The height of the eye.
    pub(crate) fn eye(&self) -> f64 {
        self.eye
    }

    /// The position of the camera.
    pub(crate) fn origin(&self) -> DVec2 {
        self.origin
    }

    /// The number of rows of pixels.
    pub(crate) fn rows(&self) -> u32 {
        self.height as u32
    }

    /// The number of columns of pixels.
    pub(crate) fn columns(&self) -> usize {
        self.width as usize
    }

    /// Returns true if neighbouring rays differ by far more than the rounding error.
    pub(crate) fn fans_out(&self) -> bool {
        /// The tangents of half a field of view, for half angles from 0.06° to 89.94°.
        const MODERATE: RangeInclusive<f64> = 1e-3..=1e3;
        /// The greatest number of columns.
        const MAX_WIDTH: u32 = 1 << 16;
        MODERATE.contains(&self.plane.length()) && self.width <= MAX_WIDTH
    }

    /// Returns true if every row above the horizon is the mirror image of a row below it.
    pub(crate) fn is_symmetric(&self) -> bool {
        self.eye == 0.5 && 2.0 * self.horizon == self.height && self.rows().is_multiple_of(2)
    }

    /// Returns true if the horizon is near enough to the picture for exact texels of walls. The first and the
    /// last row of a wall may still be inexact.
    pub(crate) fn is_horizon_near(&self) -> bool {
        self.horizon.abs() <= 4096.0
    }

    /// The direction of the camera.
    pub(crate) fn direction(&self) -> DVec2 {
        self.direction
    }

    /// The vector from the middle of the picture to its right edge, at distance 1.
    pub(crate) fn plane(&self) -> DVec2 {
        self.plane
    }

    /// The position of `column` across the picture, from −1 at the left edge to 1 at the right edge.
    #[inline]
    pub(crate) fn place_of(&self, column: usize) -> f64 {
        let width = f64::from(self.width);
        // A quotient of two integers: a column and its mirror image have exactly opposite positions.
        (column as f64 * 2.0 + 1.0 - width) / width
    }

    /// The first row whose centre is not above a point at `height` at distance `t`.
    #[inline]
    pub(crate) fn row_of_height(&self, height: f64, t: f64) -> u32 {
        let mut row = 0;
        self.rows_of(height, &[t], std::slice::from_mut(&mut row));
        row
    }

    /// Writes the row of `height` at each of `distances` to `rows`, as `row_of_height` does for one distance.
    #[inline]
    pub(crate) fn rows_of(&self, height: f64, distances: &[f64], rows: &mut [u32]) {
        let rise = (height - self.eye) * self.focal_length;
        if rise == 0.0 {
            rows.fill(self.first_row_of_ground());
            return;
        }
        for (row, t) in rows.iter_mut().zip(distances) {
            *row = self.first_row_below(self.horizon - rise / t);
        }
    }

    /// The position in the picture of a point on the map.
    pub fn place(&self, point: DVec2) -> ProjectedPoint {
        let from_eye = point - self.origin;
        let depth = from_eye.dot(self.direction);
        let beside = from_eye.dot(self.direction.perp());
        let column = f64::from(self.width) / 2.0 + self.focal_length_across * beside / depth;
        ProjectedPoint { depth, column }
    }

    /// The number of columns of pixels that an object `width` cells wide covers at `depth`.
    pub(crate) fn columns_for(&self, width: f64, depth: f64) -> f64 {
        self.focal_length_across * width / depth
    }

    /// The columns whose centres are between two positions, in columns from the left edge.
    pub(crate) fn columns_between(&self, left: f64, right: f64) -> Range<usize> {
        let first = |x: f64| (x - 0.5).ceil().clamp(0.0, f64::from(self.width)) as usize;
        first(left)..first(right)
    }

    /// The position of `height` at `depth`, in rows from the top.
    pub fn row_at(&self, height: f64, depth: f64) -> f64 {
        self.horizon + (self.eye - height) * self.focal_length / depth
    }

    /// The rows whose centres are between two positions, in rows from the top.
    pub(crate) fn rows_between(&self, top: f64, bottom: f64) -> Range<u32> {
        self.first_row_below(top)..self.first_row_below(bottom)
    }

    /// The area of a wall's side, in square cells, that a pixel covers at the point where its ray hits the side
    /// at `t`. Per unit of `t`, the ray approaches the side by `slope`.
    #[inline]
    pub(crate) fn pixel_area_on_wall(&self, t: f64, slope: f64) -> f64 {
        let down = t / self.focal_length;
        let across = t / (self.focal_length_across * slope.abs());
        down * across
    }

    /// The mapping of `row` to a floor or a ceiling at `height`.
    pub(crate) fn mapping_at(&self, row: u32, height: f64) -> SpanMapping {
        self.mapping_of(row, (height - self.eye).abs())
    }

    /// The mapping of `row` to a floor or a ceiling `height` cells below or above the eye.
    fn mapping_of(&self, row: u32, height: f64) -> SpanMapping {
        let slope = self.slope(row).abs();
        let distance = height / slope;
        // The decrease of the distance from a row to the one below it.
        let along = distance / slope / self.focal_length;
        SpanMapping {
            distance,
            pixel_area: along * distance / self.focal_length_across,
            middle: self.origin + self.direction * distance,
            half_step: self.plane * (distance / f64::from(self.width)),
            width: self.width,
        }
    }

    /// The rise above eye height, per cell of distance, in the middle of `row`; negative below the
    /// horizon.
    pub(crate) fn slope(&self, row: u32) -> f64 {
        (self.horizon - (f64::from(row) + 0.5)) / self.focal_length
    }

    /// The angles that a pixel in the middle of the picture covers, across and down, in radians.
    pub(crate) fn pixel_angles(&self) -> DVec2 {
        DVec2::new(1.0 / self.focal_length_across, 1.0 / self.focal_length)
    }

    /// The first row that shows the ground if no wall covers it: the first with its centre at or
    /// below the horizon.
    #[inline]
    pub(crate) fn first_row_of_ground(&self) -> u32 {
        self.first_row_below(self.horizon)
    }

    /// The first row with its centre at or below `y`; the number of rows if there is none.
    #[inline]
    fn first_row_below(&self, y: f64) -> u32 {
        ceil_within(self.height, y - 0.5)
    }
}

/// The greatest height of an eye, up or down. An eye beyond it has the same view, because no height is as far.
const FARTHEST: f64 = 4.0 * Heights::MAX;

/// The number of rows from the middle of the picture down to the horizon. It is an integer, so that a change of
/// pitch moves the picture by whole rows.
fn rows_of_pitch(camera: &Camera, focal_length: f64) -> f64 {
    /// A number of rows that is outside any picture and exact as a double.
    const FAR: f64 = 1e9;
    let slope = camera.pitch.slope();
    if slope == 0.0 { 0.0 } else { (slope * focal_length).round().clamp(-FAR, FAR) }
}

impl Projection {
    /// The texels of a face from the height `bottom` to `top`. The texture has `count` texels per cell of
    /// height, and starts again at each integer height.
    pub(crate) fn face_texels(&self, count: usize, (bottom, top): (f64, f64)) -> FaceTexels {
        // On old processors `f64::ceil` is a call.
        let above = ceil(top) as f64;
        let in_picture = (self.horizon_of_texels, 1.0 / self.focal_length);
        FaceTexels::new(count, (above - top, above - bottom), above - self.eye, in_picture)
    }
}

/// The size of a frame in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameSize {
    /// The number of columns.
    pub width: NonZeroU32,
    /// The number of rows.
    pub height: NonZeroU32,
}

impl FrameSize {
    /// A size of `width` × `height` pixels; `None` if either is zero.
    pub fn new(width: u32, height: u32) -> Option<Self> {
        Some(Self { width: NonZeroU32::new(width)?, height: NonZeroU32::new(height)? })
    }

    /// The number of pixels.
    pub(crate) fn area(self) -> usize {
        self.width.get() as usize * self.height.get() as usize
    }
}

/// The height of a pixel over its width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelAspect(f64);

impl PixelAspect {
    /// The aspect of square pixels.
    pub const SQUARE: Self = Self(1.0);
    /// The greatest ratio of the longer side to the shorter one. Far beyond it, the slopes of rays
    /// would not be finite.
    pub const MAX: f64 = 1e6;

    /// The aspect with this ratio; `None` unless it is between 1 / [`PixelAspect::MAX`] and
    /// [`PixelAspect::MAX`].
    pub fn new(height_over_width: f64) -> Option<Self> {
        let is_possible = (1.0 / Self::MAX..=Self::MAX).contains(&height_over_width);
        is_possible.then_some(Self(height_over_width))
    }

    /// The height of a pixel over its width, from 1 / [`PixelAspect::MAX`] to
    /// [`PixelAspect::MAX`].
    pub fn height_over_width(self) -> f64 {
        self.0
    }
}
