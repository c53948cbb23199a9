//! Chunks: the squares in which a level is generated.
//!
//! A chunk is a function of the seed and its own position, so the level does not depend on the
//! player's path. A feature that two neighbours share, such as a passage between them, is a
//! function of the position of their common side. Rejected: a function of single cells. A cave with
//! several generations would be computed again for every cell, and structures larger than a cell,
//! such as rooms or spanning trees, would be impossible.
//!
//! Positions wrap around: the first cell follows the last cell that a number can represent.
//! Arithmetic on positions therefore never overflows.

use std::fmt;
use std::iter;
use std::ops::Range;

use crate::world::{Cell, Flood};

/// The number of cells along each side of a chunk.
pub const CHUNK_SIDE: usize = 32;

/// A cell of an endless level: its column from the west and its row from the north. The level's
/// first corner is at `(0, 0)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct Site {
    /// The number of cells to the east of the first corner.
    pub column: i64,
    /// The number of cells to the south of the first corner.
    pub row: i64,
}

/// The position of a chunk in columns and rows of chunks. The north-west cell of chunk `(0, 0)` is
/// the level's first corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct ChunkIndex {
    /// The number of chunks to the east of the first one.
    pub column: i64,
    /// The number of chunks to the south of the first one.
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
        // Indices wrap at the same place as cells.
        const SPARE_BITS: u32 = CHUNK_SIDE.trailing_zeros();
        let wrapped = |index: i64, by: i64| (index.wrapping_add(by) << SPARE_BITS) >> SPARE_BITS;
        Self { column: wrapped(self.column, columns), row: wrapped(self.row, rows) }
    }

    /// A cell, at an offset from the north-west cell of the chunk.
    pub fn site(self, column: i64, row: i64) -> Site {
        const SIDE: i64 = CHUNK_SIDE as i64;
        let place = |index: i64, by: i64| index.wrapping_mul(SIDE).wrapping_add(by);
        Site { column: place(self.column, column), row: place(self.row, row) }
    }
}

/// The size of a level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Extent {
    /// A level without an end.
    #[default]
    Endless,
    /// This number of cells to the east and south of the first corner. The outermost cells are
    /// wall.
    Cells {
        /// The width, at least [`Extent::MIN`].
        columns: u32,
        /// The height, at least [`Extent::MIN`].
        rows: u32,
    },
}

impl Extent {
    /// The minimum number of cells along a side.
    pub const MIN: u32 = 8;
    /// The maximum number of cells along a side.
    pub const MAX: u32 = 1_000_000_000;

    /// A level of this size; `None` if a side is out of range.
    pub fn new(columns: u32, rows: u32) -> Option<Self> {
        let is_in_range = |side: u32| (Self::MIN..=Self::MAX).contains(&side);
        (is_in_range(columns) && is_in_range(rows)).then_some(Self::Cells { columns, rows })
    }

    /// The part of a chunk that is inside the level.
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

/// The local coordinates of the cells of chunk `index` that are inside the outermost wall of a
/// level with `side` cells.
fn inside(index: i64, side: u32) -> Range<usize> {
    const SIDE: i64 = CHUNK_SIDE as i64;
    let first = index.saturating_mul(SIDE);
    let local = |cell: i64| cell.saturating_sub(first).clamp(0, SIDE) as usize;
    let (start, end) = (local(1), local(i64::from(side) - 1));
    start.min(end)..end
}

/// The part of a chunk that a terrain may fill.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChunkArea {
    extent: Extent,
    /// The chunk.
    pub chunk: ChunkIndex,
    /// The columns of the area; empty if the chunk is outside the level.
    pub columns: Range<usize>,
    /// The rows of the area; empty if the chunk is outside the level.
    pub rows: Range<usize>,
}

impl ChunkArea {
    /// The area of the chunk at an offset to the east and to the south.
    #[must_use]
    pub fn neighbor(&self, columns: i64, rows: i64) -> Self {
        self.extent.area(self.chunk.offset(columns, rows))
    }

    /// Returns true if the area has no cells, because the chunk is outside the level.
    pub fn is_empty(&self) -> bool {
        self.columns.is_empty() || self.rows.is_empty()
    }

    /// Returns true if the area has at least `side` columns and rows.
    pub fn holds(&self, side: usize) -> bool {
        self.columns.len() >= side && self.rows.len() >= side
    }

    /// Returns true if the cell is in the area.
    pub fn contains(&self, column: usize, row: usize) -> bool {
        self.columns.contains(&column) && self.rows.contains(&row)
    }
}

/// The content of a level as a function of the position.
///
/// The same area always produces the same chunk, whatever was generated before.
pub trait Terrain: fmt::Debug + Send + Sync {
    /// The seed for decisions outside the terrain, such as the position of the exit.
    fn seed(&self) -> u64;

    /// A map file that defines the characters in the chunks. Its grid contains each of them at
    /// least once. The map has no keys, `#` is one of its walls, and it has an exit. The scale of
    /// floor and ceiling patterns must be a power of two up to 16, because any other pattern would
    /// jump when the window moves.
    fn legend(&self) -> String;

    /// The cells of a chunk. Cells outside `area` are ignored and become wall.
    ///
    /// Doors stand between solid cells, with open floor on both sides. Two neighbouring chunks are
    /// connected if both areas have a [hub](Terrain::hub).
    fn chunk(&self, area: &ChunkArea) -> Chunk;

    /// An open cell of the chunk from which the player can reach the neighbours; `None` if the area
    /// is too small to have one.
    fn hub(&self, area: &ChunkArea) -> Option<(usize, usize)>;

    /// The cell of the chunk at which the player starts by default. This is the corner, unless the
    /// terrain provides a better cell. If there is no way out of that cell, the hub is used.
    fn start(&self, _plot: &ChunkArea) -> (usize, usize) {
        (0, 0)
    }
}

/// The cells of a chunk, as map characters.
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
    /// If the cell is outside the chunk.
    pub fn get(&self, column: usize, row: usize) -> u8 {
        self.cells[row][column]
    }

    /// Sets the character of a cell.
    ///
    /// # Panics
    /// If the cell is outside the chunk.
    pub fn set(&mut self, column: usize, row: usize, character: u8) {
        self.cells[row][column] = character;
    }

    /// The cells of a row, from west to east.
    ///
    /// # Panics
    /// If there is no such row.
    pub fn row(&self, row: usize) -> &[u8; CHUNK_SIDE] {
        &self.cells[row]
    }

    /// Fills every cell outside `area` with `character`.
    pub(crate) fn clip(&mut self, area: &ChunkArea, character: u8) {
        for (column, row) in every_cell().filter(|&(column, row)| !area.contains(column, row)) {
            self.set(column, row, character);
        }
    }

    /// The cells that can be reached from `start` inside the chunk through characters for which
    /// `is_open` returns true, in order of distance.
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

/// Formats the rows as text.
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
        fn every_site_is_in_exactly_one_chunk(column: i64, row: i64, columns in -9_i64..9, rows in -9_i64..9) {
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
        fn plots_cover_everything_inside_the_outer_wall(columns in 8_u32..200, rows in 8_u32..200) {
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
