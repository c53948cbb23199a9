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

    /// The aspect with this ratio; `None` unless it is finite and above 0.
    pub fn new(height_over_width: f64) -> Option<Self> {
        (height_over_width > 0.0 && height_over_width.is_finite())
            .then_some(Self(height_over_width))
    }

    /// The height of a pixel over its width.
    pub fn height_over_width(self) -> f64 {
        self.0
    }
}
