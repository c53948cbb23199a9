//! Bundles: neighbouring columns whose rays have crossed the same lines.

use std::ops::Range;

use super::surroundings::Place;
use super::tile_gaps::GapId;
use crate::cast::Course;
use crate::visibility::runs::ImageId;

/// Rays that are followed in one gap, one for each of some neighbouring columns.
#[derive(Clone, Debug)]
pub(super) struct Bundle {
    pub(super) course: Course,
    pub(super) place: Place,
    pub(super) gap: GapId,
    pub(super) image: ImageId,
    pub(super) columns: Range<u32>,
    /// The index of the clip of the first column. Those of the others follow.
    pub(super) first_clip: usize,
    /// The number of clips in use when the bundle was stored.
    pub(super) clips_in_use: usize,
    /// Whether the rays have met what stands in the cell.
    pub(super) has_met_standing: bool,
}

/// The ray of a column, as far as it differs from the others of its bundle.
#[derive(Clone, Debug)]
pub(super) struct Clip {
    /// The clip range: the rows that no nearer surface covers. It is empty where the ray has ended.
    pub(super) rows: Range<u32>,
    /// The distance at which this part of the ray begins.
    pub(super) from: f64,
    /// The distance at which the ray begins; infinite once it has ended.
    pub(super) start: f64,
}

impl Bundle {
    /// The index of the clip of `column`.
    #[inline]
    pub(super) fn clip(&self, column: u32) -> usize {
        self.first_clip + (column - self.columns.start) as usize
    }

    /// The indices of the clips of all columns.
    pub(super) fn clips(&self) -> Range<usize> {
        self.first_clip..self.first_clip + self.columns.len()
    }

    /// The columns, as indices.
    #[inline]
    pub(super) fn indices(&self) -> Range<usize> {
        self.columns.start as usize..self.columns.end as usize
    }

    /// The bundle of these of its `columns`.
    pub(super) fn part(&self, columns: Range<u32>) -> Self {
        Self { first_clip: self.clip(columns.start), columns, ..self.clone() }
    }
}

#[cfg(test)]
mod tests;
