//! The surface buffer: what each pixel shows that is painted over what the draw list says.
//!
//! Only glyphs that tell surfaces apart ask for that; for all others nothing is kept.

use std::num::NonZeroU32;

use crate::visibility::Surface;

/// What single pixels show.
#[derive(Clone, Debug, Default)]
pub(crate) struct SurfaceBuffer {
    are_kept: bool,
    width: usize,
    /// Row by row, as the pixels of a frame; empty where no surfaces are kept.
    surfaces: Vec<Option<Surface>>,
}

impl SurfaceBuffer {
    /// Whether to keep any from now on.
    pub(crate) fn keep(&mut self, are_kept: bool) {
        self.are_kept = are_kept;
        self.surfaces.clear();
    }

    /// Whether any are kept.
    pub(crate) fn are_kept(&self) -> bool {
        self.are_kept
    }

    /// Forgets all, for a frame of that size.
    pub(crate) fn begin(&mut self, width: u32, height: u32) {
        if self.are_kept {
            self.width = width as usize;
            self.surfaces.clear();
            self.surfaces.resize(width as usize * height as usize, None);
        }
    }

    /// Those of bands of `rows` rows each, as long as one asks for more.
    pub(crate) fn bands(&mut self, rows: NonZeroU32) -> impl Iterator<Item = SurfaceRows<'_>> {
        let (width, rows) = (self.width, rows.get());
        let mut rest = &mut self.surfaces[..];
        (0..).step_by(rows as usize).map(move |first| {
            let count = rest.len().min(width * rows as usize);
            let surfaces = rest.split_off_mut(..count).unwrap_or_default();
            SurfaceRows { width, first, surfaces }
        })
    }

    /// What the pixel `(x, y)` shows, where that was noted.
    pub(crate) fn surface(&self, x: u32, y: u32) -> Option<Surface> {
        *self.surfaces.get(y as usize * self.width + x as usize)?
    }
}

/// What the pixels of some rows show.
#[derive(Debug)]
pub(crate) struct SurfaceRows<'a> {
    width: usize,
    /// The first of the rows.
    first: u32,
    /// Empty where no surfaces are kept.
    surfaces: &'a mut [Option<Surface>],
}

impl SurfaceRows<'_> {
    /// Marks those pixels of column `x` from `row` on, which is in the band, as showing `surface` of which
    /// `shown` says so.
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
