//! The target: the pixels that items are drawn to, and the surface that each pixel shows.
//!
//! Only glyph sets that distinguish surfaces need the surfaces. For other glyph sets, nothing is
//! stored.

use std::num::NonZeroU32;
use std::ops::Range;

use super::band::Band;
use crate::color::Rgb;
use crate::visibility::{FrameSize, Pass, StatsCounter, Surface};
use crate::world::Paint;

/// A band of a frame with its part of the surface buffer, and the cost of drawing it.
///
/// Callers must [clip](Target::clip) the rows of an item to the band before they draw it.
pub(crate) struct Target<'a> {
    band: Band<'a>,
    surfaces: SurfaceRows<'a>,
    stats: StatsCounter,
}

impl<'a> Target<'a> {
    /// A target that counts in `stats`.
    pub(crate) fn new(band: Band<'a>, surfaces: SurfaceRows<'a>, stats: StatsCounter) -> Self {
        Self { band, surfaces, stats }
    }

    /// The cost of the drawing.
    pub(crate) fn into_stats(self) -> StatsCounter {
        self.stats
    }

    /// Whether the target counts pixels and texels.
    pub(crate) fn counts(&self) -> bool {
        self.stats.are_kept()
    }

    /// Whether the target records the surface of each pixel.
    pub(crate) fn keeps_surfaces(&self) -> bool {
        !self.surfaces.surfaces.is_empty()
    }

    /// The indices of the band's rows in the frame.
    pub(crate) fn rows(&self) -> Range<u32> {
        self.band.rows()
    }

    /// The part of `rows` in the band.
    #[inline]
    pub(crate) fn clip(&self, rows: &Range<u32>) -> Range<u32> {
        self.band.clip(rows)
    }

    /// All pixels of `rows`, to be written for `pass`.
    pub(crate) fn whole_rows_mut(&mut self, pass: Pass, rows: Range<u32>) -> &mut [Rgb] {
        if self.keeps_surfaces() {
            let width = self.band.width();
            rows.clone().for_each(|row| self.surfaces.fill(row, 0..width, pass));
        }
        let pixels = self.band.rows_mut(rows);
        self.stats.change(|stats| stats.of_mut(pass).pixels += pixels.len() as u64);
        pixels
    }

    /// The pixels of `columns` in `row`, to be written for `pass`.
    #[inline]
    pub(crate) fn span_mut(&mut self, pass: Pass, row: u32, columns: Range<usize>) -> &mut [Rgb] {
        self.stats.change(|stats| {
            stats.spans += 1;
            stats.of_mut(pass).pixels += columns.len() as u64;
        });
        if self.keeps_surfaces() {
            self.surfaces.fill(row, columns.clone(), pass);
        }
        &mut self.band.row_mut(row)[columns]
    }

    /// The pixels of `columns` in a row of the ceiling and in a row of the floor below it. Counts a texel for each
    /// pixel.
    #[inline]
    pub(crate) fn two_spans_mut(
        &mut self,
        rows: [u32; 2],
        columns: &Range<usize>,
    ) -> [&mut [Rgb]; 2] {
        let passes = [Pass::Ceiling, Pass::Floor];
        self.stats.change(|stats| {
            for pass in passes {
                stats.spans += 1;
                let stats = stats.of_mut(pass);
                stats.pixels += columns.len() as u64;
                stats.texels += columns.len() as u64;
            }
        });
        if self.keeps_surfaces() {
            for (row, pass) in rows.into_iter().zip(passes) {
                self.surfaces.fill(row, columns.clone(), pass);
            }
        }
        self.band.two_rows_mut(rows).map(|row| &mut row[columns.clone()])
    }

    /// The pixels of `rows` in column `x`, from the top.
    #[inline]
    pub(crate) fn column_mut(
        &mut self,
        x: usize,
        rows: Range<u32>,
    ) -> impl Iterator<Item = &mut Rgb> {
        self.band.column_mut(x, rows)
    }

    /// The band, for callers that count its pixels themselves.
    #[inline]
    pub(crate) fn band_mut(&mut self) -> &mut Band<'a> {
        &mut self.band
    }

    /// Counts `count` pixels that are written for `pass`.
    #[inline]
    pub(crate) fn count_pixels(&mut self, pass: Pass, count: usize) {
        self.stats.change(|stats| stats.of_mut(pass).pixels += count as u64);
    }

    /// Counts `count` pixels in `paint` that are written for `pass`.
    #[inline]
    pub(crate) fn count_painted(&mut self, pass: Pass, count: usize, paint: Paint) {
        self.stats.change(|stats| {
            let stats = stats.of_mut(pass);
            stats.pixels += count as u64;
            if let Paint::Texture(_) = paint {
                stats.texels += count as u64;
            }
        });
    }

    /// Counts `count` texels that are read for `pass`.
    #[inline]
    pub(crate) fn count_texels(&mut self, pass: Pass, count: usize) {
        self.stats.change(|stats| stats.of_mut(pass).texels += count as u64);
    }

    /// Records `surface` for the pixels of column `x` from `row` downwards whose item in `shown` is
    /// true.
    pub(crate) fn mark(
        &mut self,
        x: usize,
        row: u32,
        surface: Surface,
        shown: impl Iterator<Item = bool>,
    ) {
        self.surfaces.mark(x, row, surface, shown);
    }
}

/// The surface that each pixel of a frame shows.
#[derive(Clone, Debug, Default)]
pub(crate) struct SurfaceBuffer {
    are_kept: bool,
    /// The number of samples along both sides of each pixel.
    samples: usize,
    /// The number of samples in a row.
    width: usize,
    /// The surfaces, in the order of a frame's samples. Empty if surfaces are not recorded.
    surfaces: Vec<Option<Surface>>,
}

impl SurfaceBuffer {
    /// Sets whether surfaces are recorded from now on.
    pub(crate) fn keep(&mut self, are_kept: bool) {
        self.are_kept = are_kept;
        self.surfaces.clear();
    }

    /// Removes all surfaces, and prepares for a frame of this size with `samples` along both sides
    /// of each pixel.
    pub(crate) fn begin(&mut self, size: FrameSize, samples: u32) {
        if self.are_kept {
            self.samples = samples as usize;
            self.width = size.width.get() as usize * self.samples;
            self.surfaces.clear();
            self.surfaces.resize(size.area() * self.samples * self.samples, None);
        }
    }

    /// The surfaces in bands of `rows` rows of samples each. The iterator never ends: bands below the frame
    /// are empty.
    pub(crate) fn bands(&mut self, rows: NonZeroU32) -> impl Iterator<Item = SurfaceRows<'_>> {
        let (width, rows) = (self.width, rows.get() as usize);
        let mut rest = &mut self.surfaces[..];
        (0..).step_by(rows).map(move |first| {
            let count = rest.len().min(width * rows);
            let surfaces = rest.split_off_mut(..count).unwrap_or_default();
            SurfaceRows { width, first, surfaces }
        })
    }

    /// The surface in the middle of pixel `(x, y)`, if it was recorded.
    pub(crate) fn surface(&self, x: u32, y: u32) -> Option<Surface> {
        let middle = |pixel: u32| pixel as usize * self.samples + self.samples / 2;
        let row = self.surfaces.chunks(self.width.max(1)).nth(middle(y))?;
        *row.get(middle(x))?
    }
}

/// The surfaces of the pixels of some rows.
#[derive(Debug)]
pub(crate) struct SurfaceRows<'a> {
    width: usize,
    /// The first row.
    first: u32,
    /// The surfaces, row by row. Empty if surfaces are not recorded.
    surfaces: &'a mut [Option<Surface>],
}

impl SurfaceRows<'_> {
    /// Records the surface that `pass` draws in `columns` of `row`.
    #[cold]
    #[inline(never)]
    fn fill(&mut self, row: u32, columns: Range<usize>, pass: Pass) {
        let surface = match pass {
            Pass::Ceiling => Surface::Ceiling,
            Pass::Sky => Surface::Sky,
            _ => Surface::Floor,
        };
        let start = (row - self.first) as usize * self.width;
        self.surfaces[start..][columns].fill(Some(surface));
    }

    /// Records `surface` for the pixels of column `x` from `row` downwards whose item in `shown` is
    /// true. The row is in the band.
    pub(crate) fn mark(
        &mut self,
        x: usize,
        row: u32,
        surface: Surface,
        shown: impl Iterator<Item = bool>,
    ) {
        if self.surfaces.is_empty() {
            return;
        }
        let start = (row - self.first) as usize * self.width + x;
        let column = self.surfaces.iter_mut().skip(start).step_by(self.width);
        for (mark, shown) in column.zip(shown) {
            *mark = if shown { Some(surface) } else { *mark };
        }
    }
}
