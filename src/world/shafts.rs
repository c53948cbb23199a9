//! Shafts: how far rays may go ahead without looking, between what stands to their left and right.
//!
//! A map is cut into strips of columns. All lines that cross the middle of a strip in nearly one place,
//! with nearly one slope, are a shaft; two bytes for each say which columns of its strip what is solid
//! in it begins and ends in. The other columns a ray crosses without a look, however near pillars are
//! that it passes. Rays that are faster along columns than along rows have shafts of their own, in
//! strips of rows.
//!
//! Nothing solid is left out. The slopes of a shaft are between two fractions and columns are between two
//! integers, so that which rows its lines reach in a column is between products of them, and all of that is
//! integers; the rows are then taken to be [wider](SLACK) on both sides by more than a ray's own
//! place and slope can be rounded. All around the map counts as solid, so a ray that leaves is seen to.
//!
//! Shafts come to a byte for each cell, and to as much again for margins where a map has 1024 cells on
//! a side; at 4096 to 1.25 bytes in all. They are made only for maps as large as that on which little
//! is solid: among rooms, rays end before they gain by it.
//!
//! To say of each block of cells how far it is clear in each of many directions was refused: a ray
//! may be anywhere in a wedge, which grows wider as it goes, and the same void is told once for each
//! block in it. By our reckoning, leaps would be half as long for the same memory.

/// The shafts of rays that are fastest along one axis.
///
/// The lines that rays cross are across that axis, and bands are between those of the other.
#[derive(Clone, PartialEq, Eq)]
pub(crate) struct Shafts {
    /// Group by group, slope by slope, place by place, strip by strip.
    ///
    /// A line that is as steep as the slope says is in one place in all strips of a group. So what one ray
    /// asks for lies together in memory.
    solid: Vec<Solid>,
    /// How many places there are for a slope.
    places: i64,
}

/// All shafts of about one slope, for rays of one direction.
#[derive(Clone, Copy)]
pub(crate) struct Bundle<'shafts> {
    shafts: &'shafts Shafts,
    /// Its middle slope, in units.
    slope: i64,
    /// The index of its place 0 in a group.
    start: i64,
    is_backward: bool,
}

/// From which line of a strip on there may be something solid, and from which on there is nothing.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Solid {
    first: u8,
    end: u8,
}

/// How many lines a strip has.
pub(crate) const STRIP: i64 = 128;
/// Places and slopes of rays are in units of 2⁻³² of a cell.
pub(crate) const FRACTION_BITS: u32 = 32;
/// How many strips a group has.
const GROUP: i64 = 1 << GROUP_BITS;
const GROUP_BITS: u32 = 3;
/// How many bands wide a shaft is, in the middle of its strip.
const WIDTH: i64 = 1 << WIDTH_BITS;
const WIDTH_BITS: u32 = 1;
/// How many slopes there are from 0 to 1, and as many to −1.
const STEEPEST: i64 = 1 << SLOPE_BITS;
const SLOPE_BITS: u32 = 5;
const SLOPES: i64 = 2 * STEEPEST;
/// How much wider than it is a shaft is taken to be on both sides, in [`STEEPEST`]ths of a band: a
/// ray's place and slope are rounded by less than a thousandth of that.
const SLACK: i64 = 1;
/// How many places of a slope are on either side of the map. As far can a line be from the map in the
/// middle of a group that is on the map elsewhere in it.
const MARGIN: i64 = GROUP * STRIP / 2 / WIDTH + 1;

impl Shafts {
    /// On maps with less than that from side to side, rays do not gain by it.
    const LEAST_SIDE: i64 = 8 * STRIP;
    /// Nor where more than one cell in so many is solid, besides walls around the map.
    const SPARSE: i64 = 1024;

    /// Whether rays gain by shafts on a map of so many columns and rows where so many cells are or may
    /// become solid, those around the map among them.
    pub(super) fn are_worthwhile([columns, rows]: [i64; 2], solid: i64) -> bool {
        let around = 4 * (columns + rows);
        columns.min(rows) >= Self::LEAST_SIDE && solid <= around + columns * rows / Self::SPARSE
    }

    /// The shafts of a map of so many lines and bands, among the cells that are or may become `solid`,
    /// each behind a line and in a band; those around the map are among them.
    pub(super) fn new([lines, bands]: [i64; 2], solid: impl Iterator<Item = [i64; 2]>) -> Self {
        let lines_in_group = GROUP * STRIP;
        let groups = (lines + lines_in_group - 1) / lines_in_group;
        let places = bands / WIDTH + 1 + 2 * MARGIN;
        let count = groups * SLOPES * places * GROUP;
        let mut shafts = Self { solid: vec![Solid::NOTHING; count as usize], places };
        let has_strip = |line: i64| (0..groups * lines_in_group).contains(&line);
        for [line, band] in solid.filter(|&[line, _]| has_strip(line)) {
            for slope in -STEEPEST..STEEPEST {
                shafts.add(line, band, slope);
            }
        }
        shafts
    }

    /// How many bytes they take in memory.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(self) + size_of_val(self.solid.as_slice())
    }

    /// Notes a solid cell in all shafts from one slope to the next that it is in.
    fn add(&mut self, line: i64, band: i64, slope: i64) {
        let (strip, within) = (line / STRIP, line % STRIP);
        // How far a line that goes through the cell may have moved since the middle of the strip, in
        // parts of a band.
        let from_middle = within - STRIP / 2;
        let moves =
            [from_middle, from_middle + 1].map(|lines| [lines * slope, lines * (slope + 1)]);
        let moves = moves.as_flattened().iter();
        let (least, most) = moves.fold((i64::MAX, i64::MIN), |(least, most), &moved| {
            (least.min(moved), most.max(moved))
        });
        let sheared = (2 * slope + 1) * from_middle_of_group(strip) / 2;
        let place = |parts: i64| (parts - sheared).div_euclid(STEEPEST * WIDTH);
        let first = place(band * STEEPEST - most - SLACK).max(-MARGIN);
        let last = place((band + 1) * STEEPEST - least + SLACK).min(self.places - MARGIN - 1);
        let start = self.start(slope);
        for place in first..=last {
            let index = self.index(start, strip, place);
            self.solid[index as usize].add(within as u8);
        }
    }

    /// The shafts of that slope, in units, for rays that cross the lines in this order or the other.
    #[inline]
    pub(crate) fn bundle(&self, slope: i64, is_backward: bool) -> Bundle<'_> {
        let least = (slope >> (FRACTION_BITS - SLOPE_BITS)).min(STEEPEST - 1);
        let slope = (2 * least + 1) << (FRACTION_BITS - SLOPE_BITS - 1);
        Bundle { shafts: self, slope, start: self.start(least), is_backward }
    }

    /// The index of place 0 of that slope, in [`STEEPEST`]ths, among the places of a group.
    #[inline]
    fn start(&self, slope: i64) -> i64 {
        (slope + STEEPEST) * self.places + MARGIN
    }

    /// The index of a place in a strip, where place 0 is at `start`.
    #[inline]
    fn index(&self, start: i64, strip: i64, place: i64) -> i64 {
        let group = (strip >> GROUP_BITS) * SLOPES * self.places;
        ((group + start + place) << GROUP_BITS) + (strip & (GROUP - 1))
    }
}

/// How many lines it is from the middle of a strip's group to the middle of the strip.
#[inline]
fn from_middle_of_group(strip: i64) -> i64 {
    ((strip & (GROUP - 1)) * 2 + 1 - GROUP) * (STRIP / 2)
}

impl Bundle<'_> {
    /// How many lines of a strip a ray can cross at once that has crossed those `within` it; all that are
    /// left, where it is clear up to the next strip. Lines are counted as the ray crosses them, and its
    /// `place`, in units, is the one in the middle of the strip.
    ///
    /// Somewhere in the strip the ray is on the map, or at its edge.
    #[inline]
    pub(crate) fn lines_ahead(self, strip: i64, within: i64, place: i64) -> i64 {
        let place = place - self.slope * from_middle_of_group(strip);
        let index = self.shafts.index(self.start, strip, place >> (FRACTION_BITS + WIDTH_BITS));
        let solid = self.shafts.solid.get(index as usize).copied().unwrap_or(Solid::EVERYWHERE);
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

    /// A ray straight ahead through the middle of a band, among nothing but a pillar behind line 200.
    fn lines_ahead(band: i64, is_backward: bool, within: i64) -> i64 {
        let shafts = Shafts::new([256, 64], iter::once([200, 30]));
        let place = (2 * band + 1) << (FRACTION_BITS - 1);
        shafts.bundle(0, is_backward).lines_ahead(1, within, place)
    }

    #[test]
    fn it_is_clear_up_to_a_pillar_and_from_there_on() {
        let pillar = 200 - STRIP;
        for (within, lines) in [(0, pillar), (pillar - 1, 1), (pillar, 0), (pillar + 1, 55)] {
            assert_eq!(lines_ahead(30, false, within), lines);
        }
        for (within, lines) in [(0, 55), (54, 1), (55, 0), (56, pillar)] {
            assert_eq!(lines_ahead(30, true, within), lines);
        }
    }

    #[test]
    fn what_stands_beside_a_shaft_is_not_in_it() {
        for band in [20, 40] {
            assert_eq!(lines_ahead(band, false, 0), STRIP);
            assert_eq!(lines_ahead(band, true, 9), STRIP - 9);
        }
    }

    #[test]
    fn beyond_the_map_nothing_is_known() {
        let shafts = Shafts::new([1024, 64], iter::empty());
        assert_eq!(shafts.bundle(0, false).lines_ahead(7, 0, 0), STRIP);
        assert_eq!(shafts.bundle(0, false).lines_ahead(8, 0, 0), 0);
        assert_eq!(shafts.bundle(0, true).lines_ahead(-1, 0, 0), 0);
    }

    #[test]
    fn large_maps_are_worth_it_where_little_is_solid() {
        let around = 8 * 1024;
        assert!(Shafts::are_worthwhile([1024, 1024], around + 1024));
        assert!(!Shafts::are_worthwhile([1024, 1024], around + 1025));
        assert!(!Shafts::are_worthwhile([4096, 1023], 0));
    }
}
