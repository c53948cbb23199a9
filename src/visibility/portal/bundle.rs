//! Bundles: neighbouring columns whose rays have crossed the same lines.

use std::ops::Range;

use super::surroundings::Place;
use super::tile_gaps::GapId;
use crate::cast::Course;
use crate::visibility::runs::ImageId;

/// Rays that are followed in one gap, one for each of some neighbouring columns.
#[derive(Clone, Debug)]
pub(crate) struct Bundle {
    pub(crate) course: Course,
    pub(crate) place: Place,
    pub(crate) gap: GapId,
    pub(crate) image: ImageId,
    pub(crate) columns: Range<u32>,
    /// The index of the clip of the first column. Those of the others follow.
    pub(crate) first_clip: usize,
    /// The number of clips in use when the bundle was stored.
    pub(crate) clips_in_use: usize,
    /// Whether the rays have met what stands in the cell.
    pub(crate) has_met_standing: bool,
}

/// The ray of a column, as far as it differs from the others of its bundle.
#[derive(Clone, Debug)]
pub(crate) struct Clip {
    /// The clip range: the rows that no nearer surface covers. It is empty where the ray has ended.
    pub(crate) rows: Range<u32>,
    /// The distance at which this part of the ray begins.
    pub(crate) from: f64,
    /// The distance at which the ray begins; infinite once it has ended.
    pub(crate) start: f64,
}

impl Bundle {
    /// The index of the clip of `column`.
    #[inline]
    pub(crate) fn clip(&self, column: u32) -> usize {
        self.first_clip + (column - self.columns.start) as usize
    }

    /// The indices of the clips of all columns.
    pub(crate) fn clips(&self) -> Range<usize> {
        self.first_clip..self.first_clip + self.columns.len()
    }

    /// The columns, as indices.
    #[inline]
    pub(crate) fn indices(&self) -> Range<usize> {
        self.columns.start as usize..self.columns.end as usize
    }

    /// The bundle of these of its `columns`.
    pub(crate) fn part(&self, columns: Range<u32>) -> Self {
        Self { first_clip: self.clip(columns.start), columns, ..self.clone() }
    }
}

#[cfg(test)]
mod tests;
