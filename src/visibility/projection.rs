//! The projection: which ray a column stands for, and which rows a wall covers.
//!
//! It is true on any window and any font: the focal length in pixels is `(w/2) / tan(fov/2)`, and
//! vertically that divided by the shape of a pixel, so that a cube looks like a cube. Rows and
//! columns are taken at the centres of pixels.

use std::ops::{Range, RangeInclusive};

use glam::DVec2;

use super::texture_stepper::{FaceTexels, TextureStepper, ceil};
use super::{FrameSize, PixelAspect, SpanMapping};
use crate::cast::Ray;
use crate::world::{Camera, Heights};

/// How the world maps to the pixels of one frame.
#[derive(Clone, Debug)]
pub(crate) struct Projection {
    origin: DVec2,
    direction: DVec2,
    plane: DVec2,
    width: u32,
    height: f64,
    /// The row that the eye's own height falls on, in pixels from the top; far outside the picture
    /// where the camera looks that far up or down.
    horizon: f64,
    /// How high the eye is.
    eye: f64,
    /// Rows from the horizon to something 1 above the eye at distance 1.
    focal_length: f64,
    /// Columns from the middle to something 1 beside it at distance 1.
    focal_length_across: f64,
}

/// How far above the eye something is: in rows above the horizon, from a distance of 1; negative below.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rise(f64);

/// Where something is in a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    /// How far it is from the camera plane, in cells; not above 0 for what is not before it.
    pub(crate) depth: f64,
    /// Columns of pixels from the left edge.
    pub(crate) column: f64,
}

impl Projection {
    pub(crate) fn new(camera: &Camera, size: FrameSize, pixel_aspect: PixelAspect) -> Self {
        let width = size.width.get();
        let height = f64::from(size.height.get());
        let across = f64::from(width) / 2.0 / camera.field_of_view.half_width();
        let focal_length = across / pixel_aspect.height_over_width();
        Self {
            eye: camera.eye().clamp(-FARTHEST, FARTHEST),
            origin: camera.position(),
            direction: camera.direction(),
            plane: camera.plane(),
            width,
            height,
            horizon: height / 2.0 + rows_of_pitch(camera, focal_length),
            focal_length,
            focal_length_across: across,
        }
    }

    /// Whether a level scene looks the same to an eye at that height either way.
    pub(crate) fn is_between_floor_and_ceiling(eye: f64) -> bool {
        (NEAREST..=1.0 - NEAREST).contains(&eye)
    }

    /// As it is for a level scene: the eye is not in its floor or its ceiling.
    pub(crate) fn between_floor_and_ceiling(self) -> Self {
        Self { eye: self.eye.clamp(NEAREST, 1.0 - NEAREST), ..self }
    }

    /// How high the eye is.
    pub(crate) fn eye(&self) -> f64 {
        self.eye
    }

    /// Where the camera stands.
    pub(crate) fn origin(&self) -> DVec2 {
        self.origin
    }

    /// How many rows of pixels there are.
    pub(crate) fn rows(&self) -> u32 {
        self.height as u32
    }

    /// How many columns of pixels there are.
    pub(crate) fn columns(&self) -> usize {
        self.width as usize
    }

    /// The rays of all columns, from left to right, each through the middle of its pixels.
    ///
    /// A ray's `t` is the distance to the camera plane, so nothing needs correcting afterwards.
    pub(crate) fn rays(&self) -> impl Iterator<Item = Ray> {
        (0..self.width).map(|column| self.ray(column))
    }

    /// The ray of `column`.
    #[inline]
    pub(crate) fn ray(&self, column: u32) -> Ray {
        Ray::new(self.origin, self.direction_of(column))
            .expect("a camera is at a finite place, and its plane is not parallel to its view")
    }

    /// Whether rays side by side differ by far more than rounding.
    pub(crate) fn fans_out(&self) -> bool {
        /// Half of that field of view is between 0.06° and 89.94°.
        const MODERATE: RangeInclusive<f64> = 1e-3..=1e3;
        /// The most rays.
        const WIDEST: u32 = 1 << 16;
        MODERATE.contains(&self.plane.length()) && self.width <= WIDEST
    }

    /// The direction of the ray of `column`.
    pub(crate) fn direction_of(&self, column: u32) -> DVec2 {
        let width = f64::from(self.width);
        // The quotient of two whole numbers: a column and its mirror image get opposite ones.
        let across = (f64::from(column) * 2.0 + 1.0 - width) / width;
        self.direction + self.plane * across
    }

    /// The rows whose centres are between the top and the bottom of a wall, 1 high, at distance `t`.
    pub(crate) fn wall_rows(&self, t: f64) -> Range<u32> {
        let above = (1.0 - self.eye) * self.focal_length / t;
        let below = self.eye * self.focal_length / t;
        self.first_row_below(self.horizon - above)..self.first_row_below(self.horizon + below)
    }

    /// How far above the eye `height` is.
    pub(crate) fn rise_to(&self, height: f64) -> Rise {
        let rise = height - self.eye;
        // What is at eye height is so through an infinitely long lens, too.
        Rise(if rise == 0.0 { 0.0 } else { rise * self.focal_length })
    }

    /// The first row whose centre is not above what rises by `rise` and is at distance `t`.
    #[inline]
    pub(crate) fn row_of(&self, Rise(rise): Rise, t: f64) -> u32 {
        if rise == 0.0 {
            return self.first_row_of_ground();
        }
        self.first_row_below(self.horizon - rise / t)
    }

    /// The same of what is at `height`: where it is asked for once.
    #[inline]
    pub(crate) fn row_of_height(&self, height: f64, t: f64) -> u32 {
        self.row_of(self.rise_to(height), t)
    }

    /// The texels of a wall at distance `t`, `count` from its top to its bottom.
    pub(crate) fn texels_down_the_wall(&self, t: f64, count: usize) -> TextureStepper {
        let height_of_row = t / self.focal_length;
        TextureStepper::of_wall(2.0 * self.horizon, height_of_row, count, 1.0 - self.eye)
    }

    /// The texels of a face at distance `t` from the height `bottom` to `top`: `count` for each cell
    /// of its height, from one whole height to the next.
    pub(crate) fn texels_down_the_face(
        &self,
        t: f64,
        count: usize,
        bottom: f64,
        top: f64,
    ) -> TextureStepper {
        // Where a processor may be old, `f64::ceil` is a call.
        let above = ceil(top) as f64;
        let of_cells = (above - top, above - bottom);
        let texels = FaceTexels { count, of_cells, at_eye: above - self.eye };
        TextureStepper::new(2.0 * self.horizon, t / self.focal_length, texels)
    }

    /// Where something in the middle of `point` is in the picture.
    pub(crate) fn place(&self, point: DVec2) -> Place {
        let from_eye = point - self.origin;
        let depth = from_eye.dot(self.direction);
        let beside = from_eye.dot(self.direction.perp());
        let column = f64::from(self.width) / 2.0 + self.focal_length_across * beside / depth;
        Place { depth, column }
    }

    /// How many columns of pixels something covers that is `width` cells wide, at `depth`.
    pub(crate) fn columns_for(&self, width: f64, depth: f64) -> f64 {
        self.focal_length_across * width / depth
    }

    /// The columns whose centres are between two places, given in columns from the left.
    pub(crate) fn columns_between(&self, left: f64, right: f64) -> Range<u32> {
        let first = |x: f64| (x - 0.5).ceil().clamp(0.0, f64::from(self.width)) as u32;
        first(left)..first(right)
    }

    /// Where something at `height` is at `depth`, in rows from the top.
    pub(crate) fn row_at(&self, height: f64, depth: f64) -> f64 {
        self.horizon + (self.eye - height) * self.focal_length / depth
    }

    /// The rows whose centres are between two places, given in rows from the top.
    pub(crate) fn rows_between(&self, top: f64, bottom: f64) -> Range<u32> {
        self.first_row_below(top)..self.first_row_below(bottom)
    }

    /// How much of a wall's side the pixels of a column cover, in square cells each: where its ray,
    /// at `t`, meets the wall with a `slope` of that much towards it for each unit of `t`.
    pub(crate) fn pixel_area_on_wall(&self, t: f64, slope: f64) -> f64 {
        let down = t / self.focal_length;
        let across = t / (self.focal_length_across * slope.abs());
        down * across
    }

    /// What `row` shows of the floor, or of the ceiling where it is above the horizon.
    pub(crate) fn mapping(&self, row: u32) -> SpanMapping {
        let height = if self.slope(row) > 0.0 { 1.0 - self.eye } else { self.eye };
        self.mapping_of(row, height)
    }

    /// What `row` shows of a floor or a ceiling at that height.
    pub(crate) fn mapping_at(&self, row: u32, height: f64) -> SpanMapping {
        self.mapping_of(row, (height - self.eye).abs())
    }

    /// What `row` shows of a floor or a ceiling `height` cells below or above the eye.
    fn mapping_of(&self, row: u32, height: f64) -> SpanMapping {
        let slope = self.slope(row).abs();
        let distance = height / slope;
        // A row further down, the distance is less by that.
        let along = distance / slope / self.focal_length;
        SpanMapping {
            distance,
            pixel_area: along * distance / self.focal_length_across,
            middle: self.origin + self.direction * distance,
            half_step: self.plane * (distance / f64::from(self.width)),
            width: self.width,
        }
    }

    /// How much higher than the eye something is that shows in the middle of `row`, for each cell
    /// that it is away; negative below the horizon.
    pub(crate) fn slope(&self, row: u32) -> f64 {
        (self.horizon - (f64::from(row) + 0.5)) / self.focal_length
    }

    /// The angles, in radians, that a pixel in the middle of the picture covers, across and down.
    pub(crate) fn pixel_angles(&self) -> DVec2 {
        DVec2::new(1.0 / self.focal_length_across, 1.0 / self.focal_length)
    }

    /// The first row that shows the ground where nothing is in the way: the first one with its
    /// centre at the horizon or below.
    #[inline]
    pub(crate) fn first_row_of_ground(&self) -> u32 {
        self.first_row_below(self.horizon)
    }

    /// The first row with its centre at `y` or below; the number of rows where there is none.
    #[inline]
    fn first_row_below(&self, y: f64) -> u32 {
        // The cast takes what is not a number, as of a wall infinitely far through an infinitely
        // long lens, to 0.
        let y = (y - 0.5).clamp(0.0, self.height);
        // Where a processor may be old, `f64::ceil` is a call.
        let row = y as u32;
        row + u32::from(f64::from(row) < y)
    }
}

/// An eye is at least that far from floor and ceiling, in cells: what is nearer shows nothing but
/// where it touches.
const NEAREST: f64 = 1.0 / 64.0;

/// An eye further up or down sees nothing else than from there: no height is so far.
const FARTHEST: f64 = 4.0 * Heights::MOST;

/// By how many rows the horizon is below the middle of the picture: a whole number, so that what
/// stays in view looks as it did.
fn rows_of_pitch(camera: &Camera, focal_length: f64) -> f64 {
    /// Out of any picture; through an infinitely long lens the way there would be infinite.
    const FAR: f64 = 1e9;
    let slope = camera.pitch.slope();
    if slope == 0.0 { 0.0 } else { (slope * focal_length).round().clamp(-FAR, FAR) }
}
