//! The window: the part of a level around the player, as a world.
//!
//! A window has [`CHUNKS`] chunks along each side, and moves by whole chunks when the player leaves
//! its middle. In the window, the player is always between columns 64 and 128 and between rows 64
//! and 128. Doubles in this range are evenly spaced, so adding a whole number of cells to a
//! position is exact, and moving the window does not change the picture.
//!
//! The outermost cells are wall. They are at least 72 cells away from the player, which is out of
//! sight, because every generator blocks the view before that distance or hides it in fog.
//!
//! A door closes behind the player, and is closed when it enters the window again. Nothing else
//! changes in a generated level.

use std::num::NonZeroU32;

use glam::DVec2;

use super::chunk::{CHUNK_SIDE, Chunk, ChunkIndex, Site};
use super::level::GeneratedLevel;
use super::tileset::ROCK;
use crate::world::{Cell, Grid, Heading, Start, World};

/// The number of chunks along each side of a window.
const CHUNKS: usize = 6;
/// The number of cells along each side of a window.
const SIDE: usize = CHUNKS * CHUNK_SIDE;
/// The range of player positions, along each side, in which the window does not move.
const MIDDLE: std::ops::Range<u32> = 72..120;
/// The index in the window of the player's chunk, if the player is in the eastern or southern half
/// of that chunk.
const PLAYERS_CHUNK: usize = 2;

/// The part of a level that is around the player now.
#[derive(Clone, Debug, PartialEq)]
pub struct Window {
    level: GeneratedLevel,
    /// The index of the north-west chunk.
    first: ChunkIndex,
    /// The chunks, row by row from the north.
    chunks: Vec<Chunk>,
}

/// The shift caused by a move of the window: the number of cells to the east and to the south by
/// which everything in it is displaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct WindowShift {
    columns: i64,
    rows: i64,
}

impl WindowShift {
    /// The new coordinates of a cell that was at `cell` before the shift; `None` if it is outside
    /// the window now.
    pub(crate) fn cell(self, cell: Cell) -> Option<Cell> {
        let along = |place: u32, by: i64| {
            let place = u32::try_from(i64::from(place) + by).ok()?;
            (place < SIDE as u32).then_some(place)
        };
        Some(Cell { column: along(cell.column, self.columns)?, row: along(cell.row, self.rows)? })
    }

    /// Returns true if `cell` has just entered the window.
    pub(crate) fn is_new(self, cell: Cell) -> bool {
        Self { columns: -self.columns, rows: -self.rows }.cell(cell).is_none()
    }

    /// The new coordinates of the point that was at `position` before the shift.
    pub(crate) fn position(self, position: DVec2) -> DVec2 {
        position + DVec2::new(self.columns as f64, self.rows as f64)
    }
}

impl Window {
    /// A window around `site`, and its world. The player starts at `site`, or near it if there is
    /// no way out of `site`, and faces the direction with the farthest view. `None` if there is no
    /// place to start, which is the case outside the level.
    pub fn open(level: GeneratedLevel, site: Site) -> Option<(Self, World)> {
        let site = level.start_near(site)?;
        let (index, (column, row)) = site.chunk();
        // A player in the western half of their chunk is one chunk further along in the window,
        // which is also in the middle.
        let before = |place: usize| PLAYERS_CHUNK + usize::from(place < CHUNK_SIDE / 2);
        let first = index.offset(-(before(column) as i64), -(before(row) as i64));
        let places = every_chunk(first);
        let chunks = places.map(|(_, index)| level.chunk(index)).collect();
        let window = Self { level, first, chunks };
        let mut world = window.level.tileset().world();
        window.draw(&mut world, |grid| {
            let cell = window.cell(site).unwrap_or(CENTER);
            Start { cell, heading: best_heading(grid, cell) }
        });
        Some((window, world))
    }

    /// The level that the window shows.
    pub fn level(&self) -> &GeneratedLevel {
        &self.level
    }

    /// Converts a cell of the window's world to a cell of the level.
    pub fn site(&self, cell: Cell) -> Site {
        self.first.site(cell.column.into(), cell.row.into())
    }

    /// Converts a cell of the level to a cell of the window's world; `None` if it is outside the
    /// window.
    pub fn cell(&self, site: Site) -> Option<Cell> {
        let first = self.first.site(0, 0);
        let along = |place: i64, first: i64| {
            u32::try_from(place.wrapping_sub(first)).ok().filter(|&place| place < SIDE as u32)
        };
        Some(Cell { column: along(site.column, first.column)?, row: along(site.row, first.row)? })
    }

    /// Moves the window so that `cell`, the player's cell, is in the middle, and draws that part of
    /// the level in `world` with all doors closed. Returns `None` if no move is needed.
    pub(crate) fn follow(&mut self, world: &mut World, cell: Cell) -> Option<WindowShift> {
        let (columns, rows) = (chunks_off(cell.column), chunks_off(cell.row));
        if (columns, rows) == (0, 0) {
            return None;
        }
        let first = self.first.offset(columns, rows);
        let chunks = every_chunk(first).map(|((column, row), index)| {
            let known = |place: usize, by: i64| {
                usize::try_from(place as i64 + by).ok().filter(|&place| place < CHUNKS)
            };
            match (known(column, columns), known(row, rows)) {
                (Some(column), Some(row)) => self.chunks[row * CHUNKS + column].clone(),
                _ => self.level.chunk(index),
            }
        });
        self.chunks = chunks.collect();
        self.first = first;
        let shift =
            WindowShift { columns: -columns * CHUNK_SIDE as i64, rows: -rows * CHUNK_SIDE as i64 };
        let heading = world.start().heading;
        let cell = shift.cell(cell).unwrap_or(CENTER);
        self.draw(world, |_| Start { cell, heading });
        Some(shift)
    }

    fn draw(&self, world: &mut World, start: impl FnOnce(&Grid) -> Start) {
        const WIDTH: NonZeroU32 = NonZeroU32::new(SIDE as u32).expect("there are chunks");
        let rows = (0..SIDE).map(|row| self.row(row));
        self.level.tileset().draw(world, WIDTH, rows, &[], start);
    }

    /// The characters of a row, with wall at the edges.
    fn row(&self, row: usize) -> Vec<u8> {
        if row == 0 || row == SIDE - 1 {
            return vec![ROCK; SIDE];
        }
        let chunks = &self.chunks[row / CHUNK_SIDE * CHUNKS..][..CHUNKS];
        let mut characters: Vec<u8> =
            chunks.iter().flat_map(|chunk| chunk.row(row % CHUNK_SIDE)).copied().collect();
        (characters[0], characters[SIDE - 1]) = (ROCK, ROCK);
        characters
    }
}

const CENTER: Cell = Cell { column: SIDE as u32 / 2, row: SIDE as u32 / 2 };

/// The chunks of a window, row by row from the north. `first` is the north-west chunk.
fn every_chunk(first: ChunkIndex) -> impl Iterator<Item = ((usize, usize), ChunkIndex)> {
    let places = (0..CHUNKS).flat_map(|row| (0..CHUNKS).map(move |column| (column, row)));
    places.map(move |(column, row)| ((column, row), first.offset(column as i64, row as i64)))
}

/// The number of chunks by which a window must move, along one axis, so that `place` is in its
/// middle.
fn chunks_off(place: u32) -> i64 {
    if MIDDLE.contains(&place) {
        0
    } else if place < MIDDLE.start {
        -1
    } else {
        1
    }
}

/// The direction along the grid with the farthest view from `cell`.
pub(crate) fn best_heading(grid: &Grid, cell: Cell) -> Heading {
    let ways = [(0.0, (1, 0)), (90.0, (0, 1)), (180.0, (-1, 0)), (270.0, (0, -1))];
    let is_open =
        |column, row| grid.tile(column, row).is_some_and(|tile| !grid.is_solid_tile(tile));
    let open_cells = |(across, down): (i64, i64)| {
        let places = (1..)
            .map(move |by| (i64::from(cell.column) + across * by, i64::from(cell.row) + down * by));
        places.take_while(|&(column, row)| is_open(column, row))
    };
    let most = ways.iter().rev().max_by_key(|(_, way)| open_cells(*way).count());
    let degrees = most.map_or(0.0, |&(degrees, _)| degrees);
    Heading::from_degrees(degrees).unwrap_or_default()
}

#[cfg(test)]
mod tests;
