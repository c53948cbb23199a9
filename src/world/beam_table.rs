//! Beam tables: the distance for which the way ahead of a ray is clear.
//!
//! A map is divided into strips of columns. A beam is the set of all lines that cross the middle of
//! a strip at about one position with about one slope. For each beam, two bytes say in which
//! columns of the strip solid cells begin and end. A ray crosses the other columns without a test,
//! however near the pillars that it passes. Rays that are faster along columns have a table of
//! their own, with strips of rows.
//!
//! No solid cell is missed. A beam's slopes lie between two fractions and columns lie between two
//! integers, so products of integers bound the rows that its lines reach in a column. These rows
//! are [widened](SLACK) on both sides by more than the rounding of a ray's position and slope. All
//! cells around the map count as solid, so a ray that leaves the map is noticed.
//!
//! The tables take one byte for each cell, and as much again for margins on maps of 1024 cells on a
//! side; at 4096 they take 1.25 bytes. Only maps of at least 1024 cells on a side with few solid
//! cells have tables: among rooms, rays end before a table pays off.
//!
//! Rejected: storing, for each block of cells, how far it is clear in many directions. A ray may be
//! anywhere in a wedge that widens with distance, and the same void is stored once for each block
//! in it. By estimate, leaps would be half as long for the same memory.

/// The beams of rays that are fastest along one axis.
///
/// Rays cross *lines*, which are perpendicular to that axis; *bands* are the rows or columns
/// between the lines of the other axis.
#[derive(Clone, PartialEq, Eq)]
pub(crate) struct BeamTable {
    /// Ordered by group, slope, position and strip.
    ///
    /// A line with exactly the slope of a beam has the same position in all strips of a group, so
    /// the entries that one ray reads are contiguous.
    solid: Vec<Solid>,
    /// The number of positions for each slope.
    positions: i64,
}

/// All beams of about one slope, for rays of one direction.
#[derive(Clone, Copy)]
pub(crate) struct Beams<'table> {
    table: &'table BeamTable,
    /// The middle slope, in units.
    slope: i64,
    /// The index of position 0 in a group.
    start: i64,
    is_backward: bool,
}

/// The first line of a strip at which there may be something solid, and the first after which there
/// is nothing.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Solid {
    first: u8,
    end: u8,
}

/// The number of lines of a strip.
pub(crate) const STRIP: i64 = 128;
/// Positions and slopes of rays are in units of 2⁻³² of a cell.
pub(crate) const FRACTION_BITS: u32 = 32;
/// The number of strips of a group.
const GROUP: i64 = 1 << GROUP_BITS;
const GROUP_BITS: u32 = 3;
/// The width of a beam in the middle of its strip, in bands.
const WIDTH: i64 = 1 << WIDTH_BITS;
const WIDTH_BITS: u32 = 1;
/// The number of slopes from 0 to 1, and from 0 to −1.
const STEEPEST: i64 = 1 << SLOPE_BITS;
const SLOPE_BITS: u32 = 5;
const SLOPES: i64 = 2 * STEEPEST;
/// The width by which a beam is widened on each side, in [`STEEPEST`]ths of a band. A ray's
/// position and slope are rounded by less than a thousandth of that.
const SLACK: i64 = 1;
/// The number of positions of a slope on either side of the map: a line that is on the map
/// elsewhere in a group may be that far from it in the group's middle.
const MARGIN: i64 = GROUP * STRIP / 2 / WIDTH + 1;

impl BeamTable {
    /// The least side of a map on which a beam table pays off.
    const MIN_SIDE: i64 = 8 * STRIP;
    /// The density of solid cells up to which a beam table pays off: one in this many cells, apart
    /// from walls around the map.
    const SPARSE: i64 = 1024;

    /// Returns whether a beam table pays off on a map of this size. `solid` is the number of cells
    /// that may be solid, the border included.
    pub(crate) fn are_worthwhile([columns, rows]: [i64; 2], solid: i64) -> bool {
        let around = 4 * (columns + rows);
        columns.min(rows) >= Self::MIN_SIDE && solid <= around + columns * rows / Self::SPARSE
    }

    /// The beams of a map with these lines and bands. `solid` are the lines and bands of the cells
    /// that may be solid, the border included.
    pub(crate) fn new([lines, bands]: [i64; 2], solid: impl Iterator<Item = [i64; 2]>) -> Self {
        let lines_in_group = GROUP * STRIP;
        let groups = (lines + lines_in_group - 1) / lines_in_group;
        let positions = bands / WIDTH + 1 + 2 * MARGIN;
        let count = groups * SLOPES * positions * GROUP;
        let mut table = Self { solid: vec![Solid::NOTHING; count as usize], positions };
        let has_strip = |line: i64| (0..groups * lines_in_group).contains(&line);
        for [line, band] in solid.filter(|&[line, _]| has_strip(line)) {
            for slope in -STEEPEST..STEEPEST {
                table.add(line, band, slope);
            }
        }
        table
    }

    /// The size in memory, in bytes.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self) + size_of_val(self.solid.as_slice())
    }

    /// Records a solid cell in all beams with slopes from `slope` to `slope + 1` that contain it.
    fn add(&mut self, line: i64, band: i64, slope: i64) {
        let (strip, within) = (line / STRIP, line % STRIP);
        // The distances that a line through the cell can have moved since the middle of the strip,
        // in parts of a band.
        let from_middle = within - STRIP / 2;
        let moves =
            [from_middle, from_middle + 1].map(|lines| [lines * slope, lines * (slope + 1)]);
        let moves = moves.as_flattened().iter();
        let (least, most) = moves.fold((i64::MAX, i64::MIN), |(least, most), &moved| {
            (least.min(moved), most.max(moved))
        });
        let sheared = (2 * slope + 1) * from_middle_of_group(strip) / 2;
        let position = |parts: i64| (parts - sheared).div_euclid(STEEPEST * WIDTH);
        let first = position(band * STEEPEST - most - SLACK).max(-MARGIN);
        let last = position((band + 1) * STEEPEST - least + SLACK).min(self.positions - MARGIN - 1);
        let start = self.start(slope);
        for position in first..=last {
            let index = self.index(start, strip, position);
            self.solid[index as usize].add(within as u8);
        }
    }

    /// The beams of a slope, in units, for rays that cross the lines in ascending or descending
    /// order.
    #[inline]
    pub(crate) fn beams(&self, slope: i64, is_backward: bool) -> Beams<'_> {
        let least = (slope >> (FRACTION_BITS - SLOPE_BITS)).min(STEEPEST - 1);
        let slope = (2 * least + 1) << (FRACTION_BITS - SLOPE_BITS - 1);
        Beams { table: self, slope, start: self.start(least), is_backward }
    }

    /// The index of position 0 of a slope, in [`STEEPEST`]ths, among the positions of a group.
    #[inline]
    fn start(&self, slope: i64) -> i64 {
        (slope + STEEPEST) * self.positions + MARGIN
    }

    /// The index of a position in a strip, given the index `start` of position 0.
    #[inline]
    fn index(&self, start: i64, strip: i64, position: i64) -> i64 {
        let group = (strip >> GROUP_BITS) * SLOPES * self.positions;
        ((group + start + position) << GROUP_BITS) + (strip & (GROUP - 1))
    }
}

/// The number of lines from the middle of a strip's group to the middle of the strip.
#[inline]
fn from_middle_of_group(strip: i64) -> i64 {
    ((strip & (GROUP - 1)) * 2 + 1 - GROUP) * (STRIP / 2)
}

impl Beams<'_> {
    /// The number of lines of a strip that a ray can cross at once after it has crossed `within` of
    /// them; all that are left if the way to the next strip is clear. Lines are counted in the
    /// order in which the ray crosses them. `position` is the ray's position in the middle of the
    /// strip, in units.
    ///
    /// The ray must be on the map, or at its edge, somewhere in the strip.
    #[inline]
    pub(crate) fn lines_ahead(self, strip: i64, within: i64, position: i64) -> i64 {
        let position = position - self.slope * from_middle_of_group(strip);
        let index = self.table.index(self.start, strip, position >> (FRACTION_BITS + WIDTH_BITS));
        let solid = self.table.solid.get(index as usize).copied().unwrap_or(Solid::EVERYWHERE);
        let (first, end) = (i64::from(solid.first), i64::from(solid.end));
        let (first, end) =
            if self.is_backward { (STRIP - end, STRIP - first) } else { (first, end) };
        if within >= end { STRIP - within } else { (first - within).max(0) }
    }
}

impl Solid {
    const NOTHING: Self = Self { first: STRIP as u8, end: 0 };
    const EVERYWHERE: Self = Self { first: 0, end: STRIP as u8 };

    fn add(&mut self, line: u8) {
        self.first = self.first.min(line);
        self.end = self.end.max(line + 1);
    }
}

#[cfg(test)]
mod tests {
    use std::iter;

    use super::*;

    /// Casts a ray straight ahead through the middle of a band, on a map that is empty except for a
    /// pillar behind line 200.
    fn lines_ahead(band: i64, is_backward: bool, within: i64) -> i64 {
        let table = BeamTable::new([256, 64], iter::once([200, 30]));
        let position = (2 * band + 1) << (FRACTION_BITS - 1);
        table.beams(0, is_backward).lines_ahead(1, within, position)
    }

    #[test]
    fn a_beam_is_clear_before_and_behind_a_pillar() {
        let pillar = 200 - STRIP;
        for (within, lines) in [(0, pillar), (pillar - 1, 1), (pillar, 0), (pillar + 1, 55)] {
            assert_eq!(lines_ahead(30, false, within), lines);
        }
        for (within, lines) in [(0, 55), (54, 1), (55, 0), (56, pillar)] {
            assert_eq!(lines_ahead(30, true, within), lines);
        }
    }

    #[test]
    fn a_pillar_beside_a_beam_does_not_block_it() {
        for band in [20, 40] {
            assert_eq!(lines_ahead(band, false, 0), STRIP);
            assert_eq!(lines_ahead(band, true, 9), STRIP - 9);
        }
    }

    #[test]
    fn nothing_is_known_beyond_the_map() {
        let table = BeamTable::new([1024, 64], iter::empty());
        assert_eq!(table.beams(0, false).lines_ahead(7, 0, 0), STRIP);
        assert_eq!(table.beams(0, false).lines_ahead(8, 0, 0), 0);
        assert_eq!(table.beams(0, true).lines_ahead(-1, 0, 0), 0);
    }

    #[test]
    fn beams_pay_off_on_large_maps_with_few_solid_cells() {
        let around = 8 * 1024;
        assert!(BeamTable::are_worthwhile([1024, 1024], around + 1024));
        assert!(!BeamTable::are_worthwhile([1024, 1024], around + 1025));
        assert!(!BeamTable::are_worthwhile([4096, 1023], 0));
    }
}
