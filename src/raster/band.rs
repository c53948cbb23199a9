//! Bands: ranges of rows of a frame, each drawn by one thread.
//!
//! All passes draw into a band. The pixels do not depend on its first and last row, so a picture is
//! the same in one band and in many. Rejected: bands of columns. Rows are contiguous in memory, so
//! a band of rows is a slice. No other thread can write to it, and it needs no lock.

use std::ops::Range;

use crate::color::Rgb;

/// A range of rows of a frame.
#[derive(Debug)]
pub(crate) struct Band<'a> {
    width: usize,
    /// The indices of the rows in the frame.
    rows: Range<u32>,
    /// The rows from the top, each from the left.
    pixels: &'a mut [Rgb],
}

impl<'a> Band<'a> {
    /// A band with these `pixels`. It begins with row `first` of a frame that is `width` pixels
    /// wide.
    pub(crate) fn new(width: usize, first: u32, pixels: &'a mut [Rgb]) -> Self {
        let end = first + (pixels.len() / width) as u32;
        Self { width, rows: first..end, pixels }
    }

    /// The number of pixels in a row.
    pub(crate) fn width(&self) -> usize {
        self.width
    }

    /// The indices of the rows in the frame.
    pub(crate) fn rows(&self) -> Range<u32> {
        self.rows.clone()
    }

    /// The part of `rows` in the band.
    #[inline]
    pub(crate) fn clip(&self, rows: &Range<u32>) -> Range<u32> {
        let Range { start, end } = self.rows;
        rows.start.clamp(start, end)..rows.end.clamp(start, end)
    }

    /// The pixels of row `y`, which is in the band, from the left.
    pub(crate) fn row_mut(&mut self, y: u32) -> &mut [Rgb] {
        self.rows_mut(y..y + 1)
    }

    /// The pixels of `rows`, which are in the band.
    #[inline]
    pub(crate) fn rows_mut(&mut self, rows: Range<u32>) -> &mut [Rgb] {
        let pixels = self.places(rows);
        &mut self.pixels[pixels]
    }

    /// The pixels of two rows, which are in the band, each from the left. The first row is further
    /// up.
    #[inline]
    pub(crate) fn two_rows_mut(&mut self, [upper, lower]: [u32; 2]) -> [&mut [Rgb]; 2] {
        let width = self.width;
        let (above, below) =
            self.rows_mut(upper..lower + 1).split_at_mut((lower - upper) as usize * width);
        [&mut above[..width], below]
    }

    /// The pixels of column `x` in these rows, which are in the band, from the top.
    #[inline]
    pub(crate) fn column_mut(
        &mut self,
        x: usize,
        rows: Range<u32>,
    ) -> impl Iterator<Item = &mut Rgb> {
        let (count, width) = (rows.len(), self.width);
        let first = (self.places(rows).start + x).min(self.pixels.len());
        self.pixels[first..].iter_mut().step_by(width).take(count)
    }

    /// The pixels from column `x` in the first of `rows` to the pixel before column `x` in the row
    /// after the last. The rows are in the band.
    #[inline]
    pub(crate) fn pixels_from(&mut self, x: usize, rows: Range<u32>) -> &mut [Rgb] {
        let Range { start, end } = self.places(rows);
        let end = (end + x).min(self.pixels.len());
        self.pixels.get_mut(start + x..end).unwrap_or_default()
    }

    /// The range of the pixels of `rows` in the band's pixels.
    #[inline]
    fn places(&self, rows: Range<u32>) -> Range<usize> {
        let place = |row: u32| (row - self.rows.start) as usize * self.width;
        place(rows.start)..place(rows.end)
    }
}
