//! Chunks: squares in which a level is generated.
//!
//! A chunk is a function of the seed and its own position, so that the level does not depend on the
//! player's way. Features that two neighbours share, such as a passage between them, are a function
//! of the position of their common side. Rejected: a function of single cells. A cave of several
//! generations would be computed again for every cell, and structures larger than a cell, such as
//! rooms or spanning trees, would not be possible.
//!
//! Positions wrap around: after the last cell that a number can name comes the first one, so that
//! no arithmetic on them overflows.

use std::fmt;
use std::iter;
use std::ops::Range;

use crate::world::{Cell, Flood};

/// The cells along each side of a chunk.
pub const CHUNK_SIDE: usize = 32;

/// A cell of a level without edges: columns from the west, rows from the north. The level's first
/// corner is at `(0, 0)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct Site {
    /// The cells to the east of the first corner.
    pub column: i64,
    /// The cells to the south of the first corner.
    pub row: i64,
}

/// The position of a chunk: columns and rows of chunks, from the one whose north-west cell is the
/// first corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct ChunkIndex {
    /// The chunks to the east of the first one.
    pub column: i64,
    /// The chunks to the south of the first one.
    pub row: i64,
}

impl Site {
    /// The chunk that contains the cell, and the cell's column and row in it.
    pub fn chunk(self) -> (ChunkIndex, (usize, usize)) {
        const SIDE: i64 = CHUNK_SIDE as i64;
        let index =
            ChunkIndex { column: self.column.div_euclid(SIDE), row: self.row.div_euclid(SIDE) };
        let local = |place: i64| place.rem_euclid(SIDE) as usize;
        (index, (local(self.column), local(self.row)))
    }
}

impl ChunkIndex {
    /// The chunk at an offset to the east and to the south.
    #[must_use]
    pub fn offset(self, columns: i64, rows: i64) -> Self {
        // Indices wrap where cells do.
        const SPARE_BITS: u32 = CHUNK_SIDE.trailing_zeros();
        let wrapped = |index: i64, by: i64| (index.wrapping_add(by) << SPARE_BITS) >> SPARE_BITS;
        Self { column: wrapped(self.column, columns), row: wrapped(self.row, rows) }
    }

    /// A cell of the chunk, at an offset from its north-west cell.
    pub fn site(self, column: i64, row: i64) -> Site {
        const SIDE: i64 = CHUNK_SIDE as i64;
        let place = |index: i64, by: i64| index.wrapping_mul(SIDE).wrapping_add(by);
        Site { column: place(self.column, column), row: place(self.row, row) }
    }
}

/// The size of a level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Extent {
    /// No end.
    #[default]
    Endless,
    /// This many cells to the east and south of the first corner. The outermost are wall.
    Cells {
        /// At least [`Extent::LEAST`].
        columns: u32,
        /// At least [`Extent::LEAST`].
        rows: u32,
    },
}

impl Extent {
    /// The least number of cells along a side.
    pub const LEAST: u32 = 8;
    /// The largest number of cells along a side.
    pub const MOST: u32 = 1_000_000_000;

    /// A level of this size. `None` if a side is out of range.
    pub fn new(columns: u32, rows: u32) -> Option<Self> {
        let is_in_range = |side: u32| (Self::LEAST..=Self::MOST).contains(&side);
        (is_in_range(columns) && is_in_range(rows)).then_some(Self::Cells { columns, rows })
    }

    /// The part of the level in a chunk.
    pub fn area(self, chunk: ChunkIndex) -> ChunkArea {
        let (columns, rows) = match self {
            Self::Endless => (0..CHUNK_SIDE, 0..CHUNK_SIDE),
            Self::Cells { columns, rows } => {
                (inside(chunk.column, columns), inside(chunk.row, rows))
            }
        };
        ChunkArea { extent: self, chunk, columns, rows }
    }
}

/// The cells of the chunk `index` that are inside the outermost wall around `side` cells.
fn inside(index: i64, side: u32) -> Range<usize> {
    const SIDE: i64 = CHUNK_SIDE as i64;
    let first = index.saturating_mul(SIDE);
    let local = |cell: i64| cell.saturating_sub(first).clamp(0, SIDE) as usize;
    let (start, end) = (local(1), local(i64::from(side) - 1));
    start.min(end)..end
}

/// The part of a chunk that may be filled by a terrain.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChunkArea {
    extent: Extent,
    /// The chunk.
    pub chunk: ChunkIndex,
    /// Its columns; none if the chunk is outside the level.
    pub columns: Range<usize>,
    /// Its rows; none if the chunk is outside the level.
    pub rows: Range<usize>,
}

impl ChunkArea {
    /// The area of the chunk at an offset to the east and to the south.
    #[must_use]
    pub fn neighbor(&self, columns: i64, rows: i64) -> Self {
        self.extent.area(self.chunk.offset(columns, rows))
    }

    /// Whether the area has no cells: it is outside the level.
    pub fn is_empty(&self) -> bool {
        self.columns.is_empty() || self.rows.is_empty()
    }

    /// Whether the area has at least `side` columns and rows.
    pub fn holds(&self, side: usize) -> bool {
        self.columns.len() >= side && self.rows.len() >= side
    }

    /// Whether a cell is in the area.
    pub fn contains(&self, column: usize, row: usize) -> bool {
        self.columns.contains(&column) && self.rows.contains(&row)
    }
}

/// The contents of a level, as a function of the position.
///
/// The same area always has the same chunk, whatever was generated before.
pub trait Terrain: fmt::Debug + Send + Sync {
    /// The seed for decisions outside the terrain, such as the place of the exit.
    fn seed(&self) -> u64;

    /// A map file that defines the characters of the chunks: its grid has each of them at least
    /// once. It has no keys; its walls include `#`; it has an exit. Patterns of floors and ceilings
    /// must have a scale that is a power of two up to 16: others would jump when the window moves.
    fn legend(&self) -> String;

    /// The cells of a chunk. Cells outside `area` do not matter: they become wall.
    ///
    /// Doors stand between solid cells, with open floor before and behind them. Chunks whose areas
    /// have a [hub](Terrain::hub) are connected with their neighbours that have one.
    fn chunk(&self, area: &ChunkArea) -> Chunk;

    /// An open cell of the chunk from which the player can reach the neighbours; `None` if the area
    /// is too small to have one.
    fn hub(&self, area: &ChunkArea) -> Option<(usize, usize)>;

    /// The cell of the chunk at which the player starts by default: its corner, unless the terrain
    /// knows a better one. If there is no way out of that cell, the hub is used.
    fn start(&self, _plot: &ChunkArea) -> (usize, usize) {
        (0, 0)
    }
}

/// The cells of a chunk, as the characters of a map.
#[derive(Clone, PartialEq, Eq)]
pub struct Chunk {
    cells: [[u8; CHUNK_SIDE]; CHUNK_SIDE],
}

impl Chunk {
    /// A chunk filled with `character`.
    pub fn full_of(character: u8) -> Self {
        Self { cells: [[character; CHUNK_SIDE]; CHUNK_SIDE] }
    }

    /// The character of a cell.
    ///
    /// # Panics
    /// If the cell is not in the chunk.
    pub fn get(&self, column: usize, row: usize) -> u8 {
        self.cells[row][column]
    }

    /// Sets the character of a cell.
    ///
    /// # Panics
    /// If the cell is not in the chunk.
    pub fn set(&mut self, column: usize, row: usize, character: u8) {
        self.cells[row][column] = character;
    }

    /// The cells of a row from the west.
    ///
    /// # Panics
    /// If there is no such row.
    pub fn row(&self, row: usize) -> &[u8; CHUNK_SIDE] {
        &self.cells[row]
    }

    /// Fills what is not in `area` with wall.
    pub(crate) fn clip(&mut self, area: &ChunkArea, character: u8) {
        for (column, row) in every_cell().filter(|&(column, row)| !area.contains(column, row)) {
            self.set(column, row, character);
        }
    }

    /// The cells that can be reached from `start` inside the chunk through characters for which
    /// `is_open` is true, in the order of their distance.
    pub(crate) fn reachable(
        &self,
        start: (usize, usize),
        is_open: impl Fn(u8) -> bool,
    ) -> Vec<(usize, usize)> {
        let start = Cell { column: start.0 as u32, row: start.1 as u32 };
        let place = |cell: Cell| (cell.column as usize, cell.row as usize);
        let mut flood = Flood::new((CHUNK_SIDE as u32, CHUNK_SIDE as u32), start);
        let is_open = |cell| {
            let (column, row) = place(cell);
            is_open(self.get(column, row))
        };
        iter::from_fn(|| flood.next(is_open)).map(|(cell, _)| place(cell)).collect()
    }
}

/// All cells of a chunk, row by row.
pub(crate) fn every_cell() -> impl Iterator<Item = (usize, usize)> {
    (0..CHUNK_SIDE).flat_map(|row| (0..CHUNK_SIDE).map(move |column| (column, row)))
}

/// The rows as text.
impl fmt::Display for Chunk {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.cells.iter().try_for_each(|row| writeln!(f, "{}", String::from_utf8_lossy(row)))
    }
}

impl fmt::Debug for Chunk {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\n{self}")
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn every_site_is_a_cell_of_one_chunk(column: i64, row: i64, columns in -9_i64..9, rows in -9_i64..9) {
            let (chunk, (x, y)) = Site { column, row }.chunk();
            prop_assert_eq!(chunk.site(x as i64, y as i64), Site { column, row });
            let further = chunk.offset(columns, rows);
            let moved = Site {
                column: column.wrapping_add(columns * CHUNK_SIDE as i64),
                row: row.wrapping_add(rows * CHUNK_SIDE as i64),
            };
            prop_assert_eq!(moved.chunk(), (further, (x, y)));
        }

        #[test]
        fn plots_are_what_is_within_the_outermost_wall(columns in 8_u32..200, rows in 8_u32..200) {
            let extent = Extent::new(columns, rows).unwrap();
            let areas = (-1..8).flat_map(|row| (-1..8).map(move |column| ChunkIndex { column, row }));
            let area: usize = areas.map(|index| extent.area(index)).map(|area| area.columns.len() * area.rows.len()).sum();
            prop_assert_eq!(area, (columns as usize - 2) * (rows as usize - 2));
        }
    }

    #[test]
    fn no_level_is_too_small_or_too_large() {
        assert_eq!(Extent::new(7, 8), None);
        assert_eq!(Extent::new(8, 1_000_000_001), None);
        assert!(Extent::new(8, 1_000_000_000).is_some());
    }
}
