//! The frame: pixels in memory, in rows from the top.

use std::num::NonZeroU32;

use crate::color::Rgb;
use crate::raster::Band;
use crate::visibility::{FrameSize, PixelAspect};

/// A picture in memory. The caller owns it, and each drawing overwrites it.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    size: FrameSize,
    pixel_aspect: PixelAspect,
    /// The rows from the top, each from the left.
    pixels: Vec<Rgb>,
}

impl Frame {
    /// A black frame.
    pub fn new(size: FrameSize, pixel_aspect: PixelAspect) -> Self {
        Self { size, pixel_aspect, pixels: vec![Rgb::BLACK; size.area()] }
    }

    /// Changes the size and the pixel aspect. The colours of the pixels are unspecified until the
    /// next drawing. Allocates only if the frame has never been this large.
    pub fn resize(&mut self, size: FrameSize, pixel_aspect: PixelAspect) {
        self.size = size;
        self.pixel_aspect = pixel_aspect;
        self.pixels.resize(size.area(), Rgb::BLACK);
    }

    /// The size in pixels.
    pub fn size(&self) -> FrameSize {
        self.size
    }

    /// The number of columns of pixels.
    pub fn width(&self) -> u32 {
        self.size.width.get()
    }

    /// The number of rows of pixels.
    pub fn height(&self) -> u32 {
        self.size.height.get()
    }

    /// The ratio of a pixel's height to its width.
    pub fn pixel_aspect(&self) -> PixelAspect {
        self.pixel_aspect
    }

    /// The rows from the top, each with its pixels from the left.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[Rgb]> {
        self.pixels.chunks_exact(self.width() as usize)
    }

    /// The rows from the top, with mutable pixels.
    #[cfg(feature = "tui")]
    pub(crate) fn rows_mut(&mut self) -> impl ExactSizeIterator<Item = &mut [Rgb]> {
        let width = self.width() as usize;
        self.pixels.chunks_exact_mut(width)
    }

    /// The pixel in column `x` from the left and row `y` from the top.
    ///
    /// # Panics
    /// If the frame has no such pixel.
    pub fn pixel(&self, x: u32, y: u32) -> Rgb {
        assert!(x < self.width(), "no pixel at ({x}, {y})");
        self.pixels[y as usize * self.width() as usize + x as usize]
    }

    /// The pixels of row `y` from the top, from left to right.
    ///
    /// # Panics
    /// If the frame has no such row.
    pub fn row(&self, y: u32) -> impl ExactSizeIterator<Item = Rgb> {
        self.row_slice(y).iter().copied()
    }

    /// The pixels that [`Frame::row`] returns, as a slice.
    pub(crate) fn row_slice(&self, y: u32) -> &[Rgb] {
        let start = y as usize * self.width() as usize;
        &self.pixels[start..][..self.width() as usize]
    }

    /// All rows as one band.
    pub(crate) fn whole(&mut self) -> Band<'_> {
        Band::new(self.width() as usize, 0, &mut self.pixels)
    }

    /// All rows in bands of `rows` rows; the last band has the remaining rows.
    pub(crate) fn bands(&mut self, rows: NonZeroU32) -> impl Iterator<Item = Band<'_>> {
        let (width, rows) = (self.width() as usize, rows.get());
        let bands = self.pixels.chunks_mut(width * rows as usize);
        (0..)
            .step_by(rows as usize)
            .zip(bands)
            .map(move |(first, pixels)| Band::new(width, first, pixels))
    }
}
