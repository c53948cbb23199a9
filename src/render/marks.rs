//! Marks: what pixels show that the columns can't tell, because it stands before what they hit.
//!
//! Only glyphs that tell surfaces apart ask for that; for all others no mark is kept, and none is
//! paid for.

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

    /// Notes that of the pixels of column `x` from row `first` on those show `surface` of which
    /// `shown` says so.
    pub(super) fn note(
        &mut self,
        x: usize,
        first: u32,
        surface: Surface,
        shown: impl Iterator<Item = bool>,
    ) {
        if !self.are_kept {
            return;
        }
        let start = first as usize * self.width + x;
        let column = self.surfaces.iter_mut().skip(start).step_by(self.width.max(1));
        for (mark, shown) in column.zip(shown) {
            *mark = if shown { Some(surface) } else { *mark };
        }
    }

    /// What the pixel `(x, y)` shows, where that was noted.
    pub(super) fn surface(&self, x: u32, y: u32) -> Option<Surface> {
        *self.surfaces.get(y as usize * self.width + x as usize)?
    }
}
