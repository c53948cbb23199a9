//! The sweep: along the axis that a ray moves fastest on, from line to line, several at a time.
//!
//! Between two lines of that axis, the driving one, the ray crosses at most one line of the other. So
//! at each line it is enough to know in which band between two lines of the other axis the ray is: if
//! it is not the one of the line before, it has crossed over just before this line. Nothing depends on
//! what was found at the line before, so a processor looks at several lines at once, where the walk
//! has to know which line it crossed to know the next.
//!
//! Nor must a sweep look at every line. A ray that moves by so many lines of the driving axis moves by
//! at most as many of the other, so it goes on behind all that is [clear](crate::world::Clearance).
//!
//! Places are in 2⁻³² of a cell, in integers: that of the start, and a slope for each line in between.
//! What rounding can have done to that is less than a unit a line; where a place is so near to the edge
//! of a band that it might be beyond, the cross product tells that is right.

mod along;
mod flight;

use glam::DVec2;

use super::exact::decide;
use super::{Crossing, Ray, Side};
use crate::world::{Cell, Clearance, FRACTION_BITS, Grid, TileId};
use along::{Along, MOST_LINES, UNITS, units};

/// The solid cells that a ray enters, in the exact order.
#[derive(Clone)]
pub(crate) struct Sweep<'grid> {
    grid: &'grid Grid,
    course: Course,
    at: Progress,
}

/// How far a ray has come.
#[derive(Clone, Copy)]
struct Progress {
    /// How many lines it has crossed.
    line: i64,
    /// The band that it is in: a row where columns are crossed, and the other way round.
    band: i64,
    /// How often it was looked where it is.
    looks: u64,
}

/// The way that a ray takes through a map.
#[derive(Clone, Copy)]
struct Course {
    origin: DVec2,
    direction: DVec2,
    /// Lines of this kind are crossed along the driving axis.
    side: Side,
    /// The column or row before the first of them, and 1 or −1 from there to the next.
    start: i64,
    step: i64,
    /// Where the ray is a line before the first, and a [`DOUBT`] further, in units across the bands.
    place: i64,
    /// How far it moves on from one line to the next, in units.
    slope: i64,
    /// In the list of all cells: the one before the first line in band 0, and from there to the one
    /// behind the line, and to the one in the next band.
    corner: i64,
    line_stride: i64,
    band_stride: i64,
    /// Likewise in the list of all blocks, from one to the next.
    block_strides: [i64; 2],
}

/// Within so many units of its true place a ray is taken to be: for every slope one unit, which is
/// more than rounding does, and eight for where it starts.
const DOUBT: i64 = MOST_LINES as i64 + 8;
/// Where all cells of a block are so far from anything solid, it is not worth a look at the cell.
const FAR: i64 = 6;

impl<'grid> Sweep<'grid> {
    /// The sweep of `ray` through `grid`. `None` where the ray does not start inside the map.
    #[expect(clippy::inline_always, reason = "elsewhere it would be made in memory")]
    #[inline(always)]
    pub(crate) fn new(grid: &'grid Grid, ray: &Ray) -> Option<Self> {
        let (origin, direction) = (ray.origin(), ray.direction());
        let clearance = grid.clearance();
        let [to_east, to_south] = clearance.strides();
        let [east_block, south_block] = clearance.strides_of_blocks();
        let x = Along::new(origin.x, direction.x, grid.width(), [to_east, east_block])?;
        let y = Along::new(origin.y, direction.y, grid.height(), [to_south, south_block])?;
        let is_steep = direction.x.abs() < direction.y.abs();
        let (driving, passive) = if is_steep { (y, x) } else { (x, y) };
        let slope = units(passive.direction / driving.direction.abs());
        let (step, first_line) = if driving.direction > 0.0 {
            (1, (driving.start + 1) * UNITS)
        } else {
            (-1, driving.start * UNITS)
        };
        let to_first = (first_line - driving.place) * step;
        // Both are halved, as a product of two whole cells is one more bit than there is.
        let moved = (to_first / 2) * (slope / 2) / (UNITS / 4);
        let start = driving.start;
        let course = Course {
            origin,
            direction,
            side: if is_steep { Side::Y } else { Side::X },
            start,
            step,
            place: passive.place + moved - slope + DOUBT,
            slope,
            corner: clearance.first() + start * driving.stride,
            line_stride: step * driving.stride,
            band_stride: passive.stride,
            block_strides: [driving.block_stride, passive.block_stride],
        };
        Some(Self { grid, course, at: Progress { line: 0, band: passive.start, looks: 0 } })
    }

    /// The cell that the ray is in.
    pub(super) fn cell(&self) -> Option<(Cell, TileId)> {
        self.course.cell_in(self.grid, self.at.line, self.at.band)
    }

    /// How often it was looked where the ray is to get where it is.
    pub(crate) fn looks(&self) -> u64 {
        self.at.looks
    }
}

impl Iterator for Sweep<'_> {
    type Item = Crossing;

    #[expect(clippy::inline_always, reason = "elsewhere it would be kept in memory")]
    #[inline(always)]
    fn next(&mut self) -> Option<Crossing> {
        let clearance = self.grid.clearance();
        if clearance.shafts().is_some() {
            let (sweep, met) = self.clone().fly();
            *self = sweep;
            return met;
        }
        self.advance(|course, at| {
            if clearance.is_measured() {
                course.leap(clearance, at)
            } else {
                course.go(clearance, at)
            }
        })
    }
}

impl Sweep<'_> {
    /// The next solid cell, where `to_something` goes on to what is not clear, and tells the band at the line
    /// before, too.
    #[expect(clippy::inline_always, reason = "elsewhere it would be kept in memory")]
    #[inline(always)]
    fn advance(
        &mut self,
        to_something: impl Fn(Course, Progress) -> (i64, Progress),
    ) -> Option<Crossing> {
        let Self { grid, course, .. } = *self;
        loop {
            let (before, at) = to_something(course, self.at);
            let Progress { line, band, looks } = at;
            if band != before {
                let (cell, tile) = course.cell_in(grid, line - 1, band)?;
                if grid.is_solid_tile(tile) {
                    self.at = Progress { line: line - 1, band, looks };
                    return Some(Crossing { cell, tile, side: course.side.other() });
                }
            }
            self.at = at;
            let (cell, tile) = course.cell_in(grid, line, band)?;
            if grid.is_solid_tile(tile) {
                return Some(Crossing { cell, tile, side: course.side });
            }
        }
    }

    /// As [`Sweep::next`], on a map with shafts.
    ///
    /// It takes a copy and is a function of its own, so that rays among rooms have the registers for
    /// themselves.
    #[inline(never)]
    fn fly(mut self) -> (Self, Option<Crossing>) {
        let clearance = self.grid.clearance();
        let shafts = clearance.shafts();
        let met =
            shafts.and_then(|shafts| self.advance(|course, at| course.fly(clearance, shafts, at)));
        (self, met)
    }
}

impl Course {
    /// Goes on line by line, at least one, until the cell behind a line or the one beside the cell
    /// before it is not clear; and tells the band at the line before, too.
    #[inline]
    fn go(self, clearance: &Clearance, from: Progress) -> (i64, Progress) {
        let Progress { mut line, mut band, mut looks } = from;
        let mut place = self.place + self.slope * line;
        let mut before_line = self.corner + self.line_stride * line;
        loop {
            looks += 1;
            line += 1;
            place += self.slope;
            let band_before = band;
            band = self.band_at(place, line);
            let beside = before_line + self.band_stride * band;
            let ahead = beside + self.line_stride;
            if !clearance.is_clear(ahead) || !clearance.is_clear(beside) {
                return (band_before, Progress { line, band, looks });
            }
            before_line += self.line_stride;
        }
    }

    /// As [`Course::go`], across as many lines at once as are clear.
    #[inline]
    fn leap(self, clearance: &Clearance, from: Progress) -> (i64, Progress) {
        let Progress { mut line, mut band, mut looks } = from;
        let mut clear = 1;
        loop {
            looks += 1;
            line += clear;
            let band_before = band;
            band = self.band_at(self.place + self.slope * line, line);
            let along = self.start + self.step * line;
            clear = clearance.lines_of_block([along, band], self.block_strides);
            if clear >= FAR {
                continue;
            }
            let ahead = self.corner + self.line_stride * line + self.band_stride * band;
            clear = clearance.lines_at(ahead);
            // What is two cells from all that is solid has nothing solid beside it.
            if clear < 2 && (clear == 0 || !clearance.is_clear(ahead - self.line_stride)) {
                return (band_before, Progress { line, band, looks });
            }
        }
    }

    /// The band that the ray is in where it crosses that line at that place.
    #[inline]
    fn band_at(self, place: i64, line: i64) -> i64 {
        let band = place >> FRACTION_BITS;
        if (place as u32) < 2 * DOUBT as u32 {
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
        let tile = grid.tile(column, row)?;
        Some((Cell { column: column as u32, row: row as u32 }, tile))
    }
}

/// The band that a ray is in where it crosses the `line` of kind `side`, which is the one that begins at
/// the line `edge`, or the one that ends there.
///
/// It is no method, because a reference would keep the course in memory.
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

#[cfg(test)]
mod tests;
