//! The cells in view: an interval of columns for each row of the map.
//!
//! The visible area consists of the parts of rays in each sector. The outline of each part is followed once,
//! and extends the interval of each row that it crosses. The time depends on the size of the area, not on the
//! size of the map.
//!
//! Rejected: the bounding rectangle. It contains everything on both sides of a diagonal corridor.
//!
//! Rejected: a list of the cells that rays enter. It needs a mark for every cell of the map to list each cell
//! once.

use std::ops::Range;

use glam::DVec2;

use crate::world::{Thing, World};

/// The margin around the visible area, in cells: more than the rounding error.
const EPSILON: f64 = 1e-6;

/// The things that may be in view, in memory that is reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct VisibleCells {
    /// The greatest distance from the visible area to the middle of a thing that extends into it.
    margin: f64,
    /// The number of rows of the map.
    row_count: u32,
    first_row: u32,
    intervals: Vec<ColumnInterval>,
    /// `true` if all things count as visible, because they are so few that a lookup by cell takes longer.
    shows_all: bool,
}

/// The visible columns of a row of the map, within the margin north and south of the row's middle.
#[derive(Clone, Copy, Debug)]
struct ColumnInterval {
    low: f64,
    high: f64,
}

impl ColumnInterval {
    const NONE: Self = Self { low: f64::INFINITY, high: f64::NEG_INFINITY };

    fn include(&mut self, x: f64) {
        *self = Self { low: self.low.min(x), high: self.high.max(x) };
    }
}

impl VisibleCells {
    /// Makes all things of `world` count as visible if they are few. `images` is the number of images in which
    /// each is looked for. Returns whether they are few.
    pub(crate) fn shows_all_of(&mut self, world: &World, images: usize) -> bool {
        const FEW: usize = 64;
        self.shows_all = world.things().len() * images <= FEW;
        self.shows_all
    }

    /// Removes all intervals, and prepares for lines between `north` and `south`.
    pub(crate) fn begin(&mut self, world: &World, north: f64, south: f64) {
        self.margin = world.widest_sprite() / 2.0 + EPSILON;
        self.row_count = world.grid().height();
        let rows = self.reached(north, south, self.row_count);
        self.first_row = rows.start;
        self.intervals.clear();
        self.make_room(world);
        self.intervals.resize(rows.len(), ColumnInterval::NONE);
    }

    /// Reserves memory for any view of `world`.
    pub(crate) fn make_room(&mut self, world: &World) {
        let missing = (world.grid().height() as usize).saturating_sub(self.intervals.len());
        self.intervals.reserve(missing);
    }

    /// The things that may be at least partly in view, row by row.
    pub(crate) fn things<'a>(&self, world: &'a World) -> impl Iterator<Item = &'a Thing> {
        let all: &[Thing] = if self.shows_all { world.things() } else { &[] };
        let intervals: &[ColumnInterval] = if self.shows_all { &[] } else { &self.intervals };
        let width = world.grid().width();
        let rows = (self.first_row..).zip(intervals);
        let reached = rows
            .map(move |(row, interval)| (row, self.reached(interval.low, interval.high, width)));
        let reached = reached.filter(|(_, columns)| !columns.is_empty());
        let reached = reached
            .flat_map(|(row, columns)| world.things_between(row, columns.start, columns.end - 1));
        all.iter().chain(reached)
    }

    /// Extends the intervals to include the straight line between two points. The points are corners of the
    /// outline, or the ends of the visible part of a ray.
    pub(crate) fn follow(&mut self, one: DVec2, other: DVec2) {
        let (top, bottom) = if one.y <= other.y { (one, other) } else { (other, one) };
        let slope = (bottom.x - top.x) / (bottom.y - top.y);
        let x_at = |y: f64| top.x + (y - top.y) * slope;
        for row in self.reached(top.y, bottom.y, self.row_count) {
            let middle = f64::from(row) + 0.5;
            let (from, to) = (middle - self.margin, middle + self.margin);
            let interval = &mut self.intervals[(row - self.first_row) as usize];
            interval.include(if from <= top.y { top.x } else { x_at(from) });
            interval.include(if to >= bottom.y { bottom.x } else { x_at(to) });
        }
    }

    /// The indices, among `count` cells, whose middle is between `low` and `high` or within the margin.
    fn reached(&self, low: f64, high: f64, count: u32) -> Range<u32> {
        // On old processors `f64::ceil` is a call.
        let first_from = |place: f64| {
            let place = (place - 0.5).clamp(0.0, f64::from(count));
            let below = place as u32;
            below + u32::from(f64::from(below) < place)
        };
        first_from(low - self.margin)..first_from(high + self.margin)
    }
}
