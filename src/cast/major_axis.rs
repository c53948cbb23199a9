//! Traversal along the major axis: the exact walk's cells, several grid lines at a time.
//!
//! The major axis is the axis along which the ray moves faster. *Lines* are the grid lines across
//! it, and *bands* are the rows or columns between the lines of the other axis. Between two lines,
//! the ray crosses at most one line of the other axis, so its bands at the lines determine its
//! cells: if the band changes, the ray entered the new one just before this line. No step depends
//! on the result of the previous step, so a processor computes several at once. The walk, in
//! contrast, has to know which line it crossed before it can find the next.
//!
//! The traversal need not stop at every line. A ray that crosses n lines changes its band by at
//! most n, so it may leap as far as the [distance field](crate::world::DistanceField) says.
//! Rejected: a table of the clear way ahead for every position and slope. On a plain of 4096×4096
//! cells with a pillar in one cell of 4096, a frame took 33 instead of 181 µs. The table took 350
//! lines and two bytes a cell.
//!
//! Positions are integers in units of 2⁻³² of a cell: the position of the start, plus a slope for
//! each line. Rounding moves them by less than a unit a line. If a position is so close to the edge
//! of a band that the rounding matters, the exact predicate decides.
//!
//! Major-axis stepping is Bresenham's ("Algorithm for computer control of a digital plotter", IBM
//! Systems Journal 4, 1965); leaps by a distance field are Zuiderveld, Koning and Viergever's
//! ("Acceleration of ray-casting using 3D distance transforms", 1992).

use glam::DVec2;

use super::order::decide;
use super::{Crossing, Ray, Side};
use crate::world::{Cell, DistanceField, Grid, TileId};

/// The solid cells that a ray enters, in the exact order.
#[derive(Clone)]
pub(crate) struct MajorAxisTraversal<'grid> {
    grid: &'grid Grid,
    path: IntegerRay,
    at: TraversalProgress,
}

/// The progress of a ray.
#[derive(Clone, Copy)]
struct TraversalProgress {
    /// The number of lines crossed.
    line: i64,
    /// The current band: a row if the major axis is x, a column if it is y.
    band: i64,
    /// The number of positions computed.
    lookups: u64,
}

/// A ray in the integers of the traversal.
#[derive(Clone, Copy)]
struct IntegerRay {
    origin: DVec2,
    direction: DVec2,
    /// The kind of line by which the ray enters a cell at a line.
    side: Side,
    /// The column or row before the first line, and the step to the next one: 1 or −1.
    start: i64,
    step: i64,
    /// The position across the bands, in units, one line before the first, plus [`UNCERTAINTY`].
    position: i64,
    /// The change of that position from one line to the next, in units.
    slope: i64,
    /// In the distance field: the index of the cell before the first line in band 0, the stride to the
    /// cell behind the line, and the stride to the next band.
    corner: i64,
    line_stride: i64,
    band_stride: i64,
    /// The strides of blocks along both axes.
    block_strides: [i64; 2],
}

/// The largest number of lines for which units are fine enough.
const MAX_LINES: u32 = 1 << 16;
/// The number of bits of a position after the cell.
const FRACTION_BITS: u32 = 32;
/// The number of units in a cell.
const UNITS: i64 = 1 << FRACTION_BITS;
/// A bound on the rounding of a position, in units: one for each line, and eight for the start.
const UNCERTAINTY: i64 = MAX_LINES as i64 + 8;
/// If a block is at least this far from anything solid, the cell's own distance is not read.
const FAR: i64 = 6;

impl<'grid> MajorAxisTraversal<'grid> {
    /// The traversal of `grid` by `ray`. `None` if the ray does not start inside the map.
    #[expect(clippy::inline_always, reason = "out of line, it would be built in memory")]
    #[inline(always)]
    pub(crate) fn new(grid: &'grid Grid, ray: &Ray) -> Option<Self> {
        let (origin, direction) = (ray.origin(), ray.direction());
        let distance_field = grid.distance_field();
        let [to_east, to_south] = distance_field.strides();
        let [east_block, south_block] = distance_field.strides_of_blocks();
        let x = AxisSetup::new(origin.x, direction.x, grid.width(), [to_east, east_block])?;
        let y = AxisSetup::new(origin.y, direction.y, grid.height(), [to_south, south_block])?;
        let is_steep = direction.x.abs() < direction.y.abs();
        let (major, minor) = if is_steep { (y, x) } else { (x, y) };
        let slope = units(minor.direction / major.direction.abs());
        let (step, first_line) = if major.direction > 0.0 {
            (1, (major.start + 1) * UNITS)
        } else {
            (-1, major.start * UNITS)
        };
        let to_first = (first_line - major.position) * step;
        // Both are halved: the product of two whole cells has one bit too many.
        let moved = (to_first / 2) * (slope / 2) / (UNITS / 4);
        let start = major.start;
        let path = IntegerRay {
            origin,
            direction,
            side: if is_steep { Side::Y } else { Side::X },
            start,
            step,
            position: minor.position + moved - slope + UNCERTAINTY,
            slope,
            corner: distance_field.first() + start * major.stride,
            line_stride: step * major.stride,
            band_stride: minor.stride,
            block_strides: [major.block_stride, minor.block_stride],
        };
        Some(Self { grid, path, at: TraversalProgress { line: 0, band: minor.start, lookups: 0 } })
    }

    /// The cell that the ray is in.
    pub(crate) fn cell(&self) -> Option<(Cell, TileId)> {
        self.path.cell_in(self.grid, self.at.line, self.at.band)
    }

    /// The number of positions that have been computed.
    pub(crate) fn lookups(&self) -> u64 {
        self.at.lookups
    }
}

impl Iterator for MajorAxisTraversal<'_> {
    type Item = Crossing;

    #[expect(clippy::inline_always, reason = "out of line, it would be kept in memory")]
    #[inline(always)]
    fn next(&mut self) -> Option<Crossing> {
        let distance_field = self.grid.distance_field();
        if distance_field.is_measured() {
            let (traversal, met) = self.clone().leap();
            *self = traversal;
            return met;
        }
        self.advance(|path, at| path.step(distance_field, at))
    }
}

impl MajorAxisTraversal<'_> {
    /// The next solid cell. `to_something` advances to a cell that may be solid, or to its
    /// neighbour. It also returns the band at the line before.
    #[expect(clippy::inline_always, reason = "out of line, it would be kept in memory")]
    #[inline(always)]
    fn advance(
        &mut self,
        to_something: impl Fn(IntegerRay, TraversalProgress) -> (i64, TraversalProgress),
    ) -> Option<Crossing> {
        let Self { grid, path, .. } = *self;
        loop {
            let (before, at) = to_something(path, self.at);
            let TraversalProgress { line, band, lookups } = at;
            if band != before {
                let (cell, tile) = path.cell_in(grid, line - 1, band)?;
                if grid.is_solid_tile(tile) {
                    self.at = TraversalProgress { line: line - 1, band, lookups };
                    return Some(Crossing { cell, tile, side: path.side.other() });
                }
            }
            self.at = at;
            let (cell, tile) = path.cell_in(grid, line, band)?;
            if grid.is_solid_tile(tile) {
                return Some(Crossing { cell, tile, side: path.side });
            }
        }
    }

    /// The same as [`MajorAxisTraversal::next`], on a map with distances.
    ///
    /// It is a separate function on a copy, so that the loop for other maps keeps its state in registers.
    #[inline(never)]
    fn leap(mut self) -> (Self, Option<Crossing>) {
        let distance_field = self.grid.distance_field();
        let met = self.advance(|path, at| path.leap(distance_field, at));
        (self, met)
    }
}

impl IntegerRay {
    /// Advances by one line or more, one at a time, until the cell behind a line, or the cell
    /// before the line in the new band, is not clear. Also returns the band at the line before.
    #[inline]
    fn step(
        self,
        distance_field: &DistanceField,
        from: TraversalProgress,
    ) -> (i64, TraversalProgress) {
        let TraversalProgress { mut line, mut band, mut lookups } = from;
        let mut position = self.position + self.slope * line;
        let mut before_line = self.corner + self.line_stride * line;
        let first = line;
        loop {
            line += 1;
            position += self.slope;
            let band_before = band;
            band = self.band_at(position, line);
            let beside = before_line + self.band_stride * band;
            before_line += self.line_stride;
            if !(distance_field.is_clear(beside)
                && distance_field.is_clear(beside + self.line_stride))
            {
                lookups += (line - first) as u64;
                return (band_before, TraversalProgress { line, band, lookups });
            }
        }
    }

    /// The same as [`IntegerRay::step`], but crosses as many lines at once as are clear.
    #[inline]
    fn leap(
        self,
        distance_field: &DistanceField,
        from: TraversalProgress,
    ) -> (i64, TraversalProgress) {
        let TraversalProgress { mut line, mut band, mut lookups } = from;
        let mut clear = 1;
        loop {
            lookups += 1;
            line += clear;
            let band_before = band;
            band = self.band_at(self.position + self.slope * line, line);
            let along = self.start + self.step * line;
            clear = distance_field.lines_of_block([along, band], self.block_strides);
            if clear >= FAR {
                continue;
            }
            let ahead = self.corner + self.line_stride * line + self.band_stride * band;
            clear = distance_field.lines_at(ahead);
            // A cell at distance 2 or more has no solid neighbour.
            if clear < 2 && (clear == 0 || !distance_field.is_clear(ahead - self.line_stride)) {
                return (band_before, TraversalProgress { line, band, lookups });
            }
        }
    }

    /// The band at the crossing with `line`, where the ray is at `position`.
    #[inline]
    fn band_at(self, position: i64, line: i64) -> i64 {
        let band = position >> FRACTION_BITS;
        if (position as u32) < 2 * UNCERTAINTY as u32 {
            let line = self.start + self.step * line + i64::from(self.step < 0);
            decide_band(self.origin, self.direction, self.side, line, band)
        } else {
            band
        }
    }

    #[inline]
    fn cell_in(self, grid: &Grid, line: i64, band: i64) -> Option<(Cell, TileId)> {
        let along = self.start + self.step * line;
        let (column, row) = match self.side {
            Side::X => (along, band),
            Side::Y => (band, along),
        };
        grid.cell(column, row)
    }
}

/// The band in which a ray crosses `line`: either the band that begins at the line `edge`, or the
/// band that ends there.
///
/// Not a method, because a reference would force the path into memory.
#[cold]
#[inline(never)]
fn decide_band(origin: DVec2, direction: DVec2, side: Side, line: i64, edge: i64) -> i64 {
    let (line_at, edge_at) = (line as f64, edge as f64);
    let (x, y, origin_across, direction_across) = match side {
        Side::X => (line_at, edge_at, origin.y, direction.y),
        Side::Y => (edge_at, line_at, origin.x, direction.x),
    };
    let is_beyond = if direction_across == 0.0 {
        origin_across >= edge_at
    } else {
        let is_across = decide(origin, direction, x, y) != side;
        is_across == (direction_across > 0.0)
    };
    if is_beyond { edge } else { edge - 1 }
}

/// A ray and a map along one axis.
#[derive(Clone, Copy)]
struct AxisSetup {
    /// The column or row in which the ray starts; the previous one if it starts on a line that it
    /// crosses.
    start: i64,
    /// The position of the start, in units.
    position: i64,
    direction: f64,
    /// The strides of cells and of blocks in the distance field.
    stride: i64,
    block_stride: i64,
}

impl AxisSetup {
    /// `None` if the ray does not start on the map.
    #[inline]
    fn new(origin: f64, direction: f64, count: u32, strides: [i64; 2]) -> Option<Self> {
        /// More than the rounding of a position.
        const NEAR: u32 = 2;
        let position = units(origin);
        let is_near_line = (position as u32).wrapping_add(NEAR) < 2 * NEAR;
        let start = if is_near_line {
            start_near_line(origin, direction)
        } else {
            position >> FRACTION_BITS
        };
        let is_on_map = (start as u64) < u64::from(count) && count <= MAX_LINES;
        let [stride, block_stride] = strides;
        is_on_map.then_some(Self { start, position, direction, stride, block_stride })
    }
}

/// The column or row in which a ray starts, if it starts on a line or close to a line.
#[cold]
#[inline(never)]
fn start_near_line(origin: f64, direction: f64) -> i64 {
    let start = origin.floor();
    let is_before = start == origin && direction > 0.0;
    // A start far off the map may exceed an integer.
    (start as i64).saturating_sub(i64::from(is_before))
}

/// A position in units, rounded. A position far off every map is far off in units.
#[inline]
fn units(position: f64) -> i64 {
    // Doubles of this size have a spacing of one unit, so the addition rounds to units.
    const SIZE: f64 = 1.5 * (1_u64 << (f64::MANTISSA_DIGITS - 1 - FRACTION_BITS)) as f64;
    (position + SIZE).to_bits().wrapping_sub(SIZE.to_bits()) as i64
}

#[cfg(test)]
mod tests;
