//! The frame: pixels off screen, row by row from the top.

use std::num::NonZeroU32;

use crate::color::Rgb;
use crate::raster::Band;
use crate::visibility::{FrameSize, PixelAspect};

/// A picture in memory, owned by the caller and drawn over from frame to frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    size: FrameSize,
    pixel_aspect: PixelAspect,
    /// Row by row from the top, each from the left.
    pixels: Vec<Rgb>,
}

impl Frame {
    /// A black frame.
    pub fn new(size: FrameSize, pixel_aspect: PixelAspect) -> Self {
        Self { size, pixel_aspect, pixels: vec![Rgb::BLACK; size.area()] }
    }

    /// Changes the size and the shape of pixels; what the pixels show is unspecified until the next
    /// drawing. Memory is kept, and allocated only where the frame was never as large.
    pub fn resize(&mut self, size: FrameSize, pixel_aspect: PixelAspect) {
        self.size = size;
        self.pixel_aspect = pixel_aspect;
        self.pixels.resize(size.area(), Rgb::BLACK);
    }

    /// How many pixels it has.
    pub fn size(&self) -> FrameSize {
        self.size
    }

    /// Pixels from left to right.
    pub fn width(&self) -> u32 {
        self.size.width.get()
    }

    /// Pixels from top to bottom.
    pub fn height(&self) -> u32 {
        self.size.height.get()
    }

    /// The shape of its pixels.
    pub fn pixel_aspect(&self) -> PixelAspect {
        self.pixel_aspect
    }

    /// The pixels row by row from the top, each row from the left.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[Rgb]> {
        self.pixels.chunks_exact(self.width() as usize)
    }

    /// The pixel in column `x` from the left and row `y` from the top.
    ///
    /// # Panics
    /// Where the frame has no such pixel.
    pub fn pixel(&self, x: u32, y: u32) -> Rgb {
        assert!(x < self.width(), "no pixel at ({x}, {y})");
        self.pixels[y as usize * self.width() as usize + x as usize]
    }

    /// The pixels of row `y` from the top, from the left.
    ///
    /// # Panics
    /// Where the frame has no such row.
    pub fn row(&self, y: u32) -> impl ExactSizeIterator<Item = Rgb> {
        self.row_slice(y).iter().copied()
    }

    /// As [`Frame::row`].
    pub(crate) fn row_slice(&self, y: u32) -> &[Rgb] {
        let start = y as usize * self.width() as usize;
        &self.pixels[start..][..self.width() as usize]
    }

    /// All of it.
    pub(crate) fn whole(&mut self) -> Band<'_> {
        Band::new(self.width() as usize, 0, &mut self.pixels)
    }

    /// All of it, in bands of `rows` rows, the last one of as many as are left.
    pub(crate) fn bands(&mut self, rows: NonZeroU32) -> impl Iterator<Item = Band<'_>> {
        let (width, rows) = (self.width() as usize, rows.get());
        let bands = self.pixels.chunks_mut(width * rows as usize);
        (0..)
            .step_by(rows as usize)
            .zip(bands)
            .map(move |(first, pixels)| Band::new(width, first, pixels))
    }
}
