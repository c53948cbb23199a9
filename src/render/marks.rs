//! Marks: what pixels show that the columns can't tell, because it stands before what they hit.
//!
//! Only glyphs that tell surfaces apart ask for that; for all others no mark is kept, and none is
//! paid for.

use std::num::NonZeroU32;

use super::Surface;

/// What single pixels show.
#[derive(Clone, Debug, Default)]
pub(super) struct Marks {
    are_kept: bool,
    width: usize,
    /// Row by row, as the pixels of a frame; empty where no marks are kept.
    surfaces: Vec<Option<Surface>>,
}

impl Marks {
    /// Whether to keep any from now on.
    pub(super) fn keep(&mut self, are_kept: bool) {
        self.are_kept = are_kept;
        self.surfaces.clear();
    }

    /// Forgets all, for a frame of that size.
    pub(super) fn begin(&mut self, width: u32, height: u32) {
        if self.are_kept {
            self.width = width as usize;
            self.surfaces.clear();
            self.surfaces.resize(width as usize * height as usize, None);
        }
    }

    /// Those of bands of `rows` rows each, as long as one asks for more.
    pub(super) fn bands(&mut self, rows: NonZeroU32) -> impl Iterator<Item = MarksOfBand<'_>> {
        let (width, rows) = (self.width, rows.get());
        let mut rest = &mut self.surfaces[..];
        (0..).step_by(rows as usize).map(move |first| {
            let count = rest.len().min(width * rows as usize);
            let surfaces = rest.split_off_mut(..count).unwrap_or_default();
            MarksOfBand { width, first, surfaces }
        })
    }

    /// What the pixel `(x, y)` shows, where that was noted.
    pub(super) fn surface(&self, x: u32, y: u32) -> Option<Surface> {
        *self.surfaces.get(y as usize * self.width + x as usize)?
    }
}

/// What the pixels of some rows show.
#[derive(Debug)]
pub(super) struct MarksOfBand<'a> {
    width: usize,
    /// The first of the rows.
    first: u32,
    /// Empty where no marks are kept.
    surfaces: &'a mut [Option<Surface>],
}

impl MarksOfBand<'_> {
    /// Notes that of the pixels of column `x` from `row` on, which is in the band, those show `surface`
    /// of which `shown` says so.
    pub(super) fn note(
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
