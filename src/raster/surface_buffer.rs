//! The surface buffer: the surfaces of the layers that cover the pixels of the draw list.
//!
//! Only glyph sets that distinguish surfaces need it; for all others nothing is stored.

use std::num::NonZeroU32;

use crate::visibility::Surface;

/// The surfaces of single pixels.
#[derive(Clone, Debug, Default)]
pub(crate) struct SurfaceBuffer {
    are_kept: bool,
    width: usize,
    /// The surfaces in rows, as the pixels of a frame; empty if none are kept.
    surfaces: Vec<Option<Surface>>,
}

impl SurfaceBuffer {
    /// Sets whether surfaces are kept from now on.
    pub(crate) fn keep(&mut self, are_kept: bool) {
        self.are_kept = are_kept;
        self.surfaces.clear();
    }

    /// Whether surfaces are kept.
    pub(crate) fn are_kept(&self) -> bool {
        self.are_kept
    }

    /// Removes all surfaces, and prepares for a frame of this size.
    pub(crate) fn begin(&mut self, width: u32, height: u32) {
        if self.are_kept {
            self.width = width as usize;
            self.surfaces.clear();
            self.surfaces.resize(width as usize * height as usize, None);
        }
    }

    /// The surfaces in bands of `rows` rows each, without end: bands below the frame are empty.
    pub(crate) fn bands(&mut self, rows: NonZeroU32) -> impl Iterator<Item = SurfaceRows<'_>> {
        let (width, rows) = (self.width, rows.get());
        let mut rest = &mut self.surfaces[..];
        (0..).step_by(rows as usize).map(move |first| {
            let count = rest.len().min(width * rows as usize);
            let surfaces = rest.split_off_mut(..count).unwrap_or_default();
            SurfaceRows { width, first, surfaces }
        })
    }

    /// The surface of pixel `(x, y)`, if it was recorded.
    pub(crate) fn surface(&self, x: u32, y: u32) -> Option<Surface> {
        *self.surfaces.get(y as usize * self.width + x as usize)?
    }
}

/// The surfaces of the pixels of some rows.
#[derive(Debug)]
pub(crate) struct SurfaceRows<'a> {
    width: usize,
    /// The first row.
    first: u32,
    /// The surfaces in rows; empty if none are kept.
    surfaces: &'a mut [Option<Surface>],
}

impl SurfaceRows<'_> {
    /// Records `surface` for the pixels of column `x` from `row` on, which is in the band, if their
    /// item in `shown` is true.
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
