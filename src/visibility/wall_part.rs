//! Wall parts: the walls that share a column of pixels, and how much of each pixel they cover.

use std::ops::Range;

use crate::cast::Hit;

/// The part of a wall in a column of pixels.
#[derive(Clone, Debug)]
pub(crate) struct WallPart {
    pub(crate) column: u32,
    /// The hit of the ray through the middle of the part, which may be beside that of the column.
    pub(crate) hit: Hit,
    /// The middle of the part, in columns of pixels from the left edge of the picture.
    pub(crate) middle: f64,
    /// The width of the part, in columns.
    pub(crate) share: f64,
    /// The ends of the wall.
    pub(crate) top: SlopedEdge,
    pub(crate) bottom: SlopedEdge,
    /// The rows in which it is.
    pub(crate) rows: Range<u32>,
    /// The rows in which it has neither end; the start is behind the end if both are in one row.
    pub(crate) whole: Range<u32>,
    /// The rows that the walls of the column cover as a whole: no plane is drawn there.
    pub(crate) covered: Range<u32>,
    /// Whether the column shows no other wall.
    pub(crate) is_alone: bool,
    /// Whether the next part is in another column.
    pub(crate) is_last: bool,
}

/// An edge that is straight in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SlopedEdge {
    /// The row at its left end and at its right end, in rows from the top.
    ends: [f64; 2],
}

impl WallPart {
    /// The share of the pixel in `row` that the part covers.
    #[inline]
    pub(crate) fn coverage(&self, row: u32) -> f64 {
        let Range { start, end } = self.whole;
        let below_top = if row < start { self.top.share_below(row) } else { 1.0 };
        let below_bottom = if row < end { 0.0 } else { self.bottom.share_below(row) };
        (below_top - below_bottom) * self.share
    }
}

impl SlopedEdge {
    #[inline]
    pub(crate) fn new(left: f64, right: f64) -> Self {
        Self { ends: [left, right] }
    }

    /// The rows that it crosses, at most `height`: from the first to the one after the last.
    #[inline]
    pub(crate) fn rows(self, height: u32) -> Range<u32> {
        let [left, right] = self.ends;
        let (upper, lower) = if left < right { (left, right) } else { (right, left) };
        // Conversions saturate.
        let (first, end) = (upper as u32, lower as u32);
        let is_between = f64::from(end) < lower;
        first.min(height)..end.saturating_add(u32::from(is_between)).min(height)
    }

    /// The share of the pixels of `row`, between the edge's ends, that is below the edge.
    #[inline]
    fn share_below(self, row: u32) -> f64 {
        /// With a lower rise the edge is level: the difference is then a rounding error.
        const LEVEL: f64 = 1e-6;
        let bottom = f64::from(row) + 1.0;
        let [left, right] = self.ends.map(|end| bottom - end);
        let middle = 0.5 * (left + right);
        if left >= 0.0 && right >= 0.0 && left <= 1.0 && right <= 1.0 {
            return middle;
        }
        let rise = right - left;
        if rise.abs() < LEVEL {
            return middle.clamp(0.0, 1.0);
        }
        (integral(right) - integral(left)) / rise
    }
}

/// The integral from 0 to `end` of a number that is limited to the range from 0 to 1.
fn integral(end: f64) -> f64 {
    let limited = end.clamp(0.0, 1.0);
    limited * limited / 2.0 + (end - limited).max(0.0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn the_share_below_an_edge_is_that_of_many_samples(
            ends in [-3.0..13.0_f64, -3.0..13.0_f64],
            row in 0_u32..10,
        ) {
            const SAMPLES: u32 = 200;
            let edge = SlopedEdge { ends };
            let mut below = 0.0;
            for across in 0..SAMPLES {
                let along = (f64::from(across) + 0.5) / f64::from(SAMPLES);
                let edge = ends[0] + along * (ends[1] - ends[0]);
                below += (f64::from(row) + 1.0 - edge).clamp(0.0, 1.0);
            }
            let off = edge.share_below(row) - below / f64::from(SAMPLES);
            prop_assert!(off.abs() < 1e-3, "{off}");
        }

        #[test]
        fn an_edge_crosses_its_rows_only(ends in [-3.0..13.0_f64, -3.0..13.0_f64]) {
            let edge = SlopedEdge { ends };
            let rows = edge.rows(10);
            for row in 0..10 {
                let share = edge.share_below(row);
                prop_assert!(rows.contains(&row) || !(1e-9..=1.0 - 1e-9).contains(&share));
                prop_assert!(row >= rows.start || share < 1e-9);
                prop_assert!(row < rows.end || share > 1.0 - 1e-9);
            }
        }
    }
}
