//! The size of a frame and the shape of its pixels.

use std::num::NonZeroU32;

/// How many pixels a frame has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameSize {
    /// Pixels from left to right.
    pub width: NonZeroU32,
    /// Pixels from top to bottom.
    pub height: NonZeroU32,
}

impl FrameSize {
    /// A size of `width` × `height` pixels. `None` where one of them is zero.
    pub fn new(width: u32, height: u32) -> Option<Self> {
        Some(Self { width: NonZeroU32::new(width)?, height: NonZeroU32::new(height)? })
    }

    /// How many pixels it is.
    pub(crate) fn area(self) -> usize {
        self.width.get() as usize * self.height.get() as usize
    }
}

/// The height of a pixel over its width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelAspect(f64);

impl PixelAspect {
    /// Pixels as wide as they are high.
    pub const SQUARE: Self = Self(1.0);

    /// A ratio above 0 and finite. `None` for anything else.
    pub fn new(height_over_width: f64) -> Option<Self> {
        (height_over_width > 0.0 && height_over_width.is_finite())
            .then_some(Self(height_over_width))
    }

    /// The height of a pixel over its width.
    pub fn height_over_width(self) -> f64 {
        self.0
    }
}
