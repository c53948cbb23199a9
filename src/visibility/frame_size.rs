//! The size of a frame and the aspect of its pixels.

use std::num::NonZeroU32;

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
    pub const MOST: f64 = 1e6;

    /// The aspect with this ratio; `None` unless it is between 1 / [`PixelAspect::MOST`] and
    /// [`PixelAspect::MOST`].
    pub fn new(height_over_width: f64) -> Option<Self> {
        let is_possible = (1.0 / Self::MOST..=Self::MOST).contains(&height_over_width);
        is_possible.then_some(Self(height_over_width))
    }

    /// The height of a pixel over its width, from 1 / [`PixelAspect::MOST`] to
    /// [`PixelAspect::MOST`].
    pub fn height_over_width(self) -> f64 {
        self.0
    }
}
