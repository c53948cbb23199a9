//! Notes: what the rays leave for the passes that draw.
//!
//! Of each column, the stretches of rows that show the same, from the top; its faces; and what is seen
//! through. A note for each pixel was refused: to write them, and to compare each with its neighbour
//! when spans are looked for, took a fifth of a frame.

use std::ops::Range;

use glam::DVec2;

use super::faces::Face;
use super::veils::{Pane, Veil};
use super::{IMAGES_AT_ONCE, Piece, Reflection, WindowCounts};
use crate::cast::{Side, Unfolding};

/// What all columns show; kept so that it is allocated once.
#[derive(Clone, Debug, Default)]
pub(super) struct Notes {
    /// Those of each column together, from the top, without a hole between them.
    runs: Vec<Run>,
    /// Where those of each column begin; at last, where those of the last one end.
    bounds: Vec<usize>,
    /// Those of the column that is being looked at, in no order.
    unsorted: Vec<Run>,
    /// Those of each column together.
    pub(super) faces: Vec<Face>,
    /// What is seen through: in each column, what is further comes later.
    pub(super) veils: Vec<Veil>,
    pub(super) panes: Vec<Pane>,
    /// Where things may be in view.
    pub(super) legs: Vec<Leg>,
    /// Where what is seen is on the map: first as it is, and then in mirrors.
    pub(super) images: Vec<Unfolding>,
    pub(super) counts: WindowCounts,
}

/// Rows of a column that show the same.
#[derive(Clone, Debug)]
pub(super) struct Run {
    pub(super) rows: Range<u32>,
    pub(super) shown: Shown,
}

/// The part of a ray that is seen in one image: where it begins and ends on the map.
#[derive(Clone, Debug)]
pub(super) struct Leg {
    pub(super) ends: [DVec2; 2],
    pub(super) reflection: Reflection,
}

/// What a pixel shows behind all that is seen through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shown {
    Sky { reflection: Reflection },
    Face(Side),
    Plane(Piece),
}

impl Notes {
    /// Forgets the last frame. There is room for all but the strangest maps, so that a camera that
    /// turns towards more of it needs no more memory.
    pub(super) fn begin(&mut self, width: usize) {
        const OF_A_RAY: usize = 16;
        self.runs.clear();
        self.runs.reserve(width * OF_A_RAY);
        self.bounds.clear();
        self.bounds.reserve(width + 1);
        self.bounds.push(0);
        self.unsorted.reserve(OF_A_RAY);
        self.faces.clear();
        self.faces.reserve(width * OF_A_RAY);
        self.veils.clear();
        self.veils.reserve(width * OF_A_RAY);
        self.panes.clear();
        self.panes.reserve(width * OF_A_RAY);
        self.legs.clear();
        self.legs.reserve(width * OF_A_RAY);
        self.images.clear();
        self.images.reserve(IMAGES_AT_ONCE);
        self.images.push(Unfolding::default());
        self.counts = WindowCounts::default();
    }

    /// Notes what `rows` of the column that is being looked at show.
    #[inline]
    pub(super) fn show(&mut self, rows: Range<u32>, shown: Shown) {
        if !rows.is_empty() {
            self.unsorted.push(Run { rows, shown });
        }
    }

    /// Ends the column that is being looked at, which has so many rows.
    pub(super) fn end_column(&mut self, height: u32) {
        let Self { runs, bounds, unsorted, .. } = self;
        // Most floors come from the bottom up, so that it is mostly sorted from behind.
        unsorted.reverse();
        unsorted.sort_unstable_by_key(|run| run.rows.start);
        // Where what stands in a cell is met before the cell itself, by rounding, a row is left out.
        let hole = |rows: Range<u32>| {
            (!rows.is_empty())
                .then_some(Run { rows, shown: Shown::Sky { reflection: Reflection::NONE } })
        };
        let mut above = 0;
        for run in unsorted.drain(..) {
            runs.extend(hole(above..run.rows.start));
            above = run.rows.end;
            runs.push(run);
        }
        runs.extend(hole(above..height));
        bounds.push(runs.len());
    }

    /// What each column shows, from left to right.
    pub(super) fn columns(&self) -> impl Iterator<Item = &[Run]> {
        self.bounds.windows(2).map(|bounds| &self.runs[bounds[0]..bounds[1]])
    }

    /// What pixel `(x, y)` shows; `None` where there is no such pixel.
    pub(super) fn shown(&self, x: u32, y: u32) -> Option<Shown> {
        let &[start, end] = self.bounds.get(x as usize..)?.first_chunk()?;
        let column = &self.runs[start..end];
        let run = column.get(column.partition_point(|run| run.rows.end <= y))?;
        Some(run.shown)
    }

    /// The index of `unfolding`. Of a map with more mirrors in view than there are indices, the last
    /// ones show the places of another.
    pub(super) fn reflection(&mut self, unfolding: Unfolding) -> Reflection {
        let known = self.images.iter().rposition(|&known| known == unfolding);
        let index = known.unwrap_or_else(|| {
            if u16::try_from(self.images.len()).is_ok() {
                self.images.push(unfolding);
            }
            self.images.len() - 1
        });
        Reflection(index as u16)
    }

    /// Where what is seen by `reflection` is on the map.
    pub(super) fn unfolding(&self, Reflection(index): Reflection) -> Unfolding {
        self.images[usize::from(index)]
    }
}
