//! The grid: one byte a cell, row by row from the north.

use std::collections::BTreeSet;
use std::num::NonZeroU32;
use std::sync::Arc;

use glam::DVec2;

use super::Lamplight;
use super::clearance::Clearance;

/// The place of a cell: column from the west, row from the north, both from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Cell {
    /// Cells to the west of this one.
    pub column: u32,
    /// Cells to the north of this one.
    pub row: u32,
}

impl Cell {
    /// The middle of the cell.
    pub fn center(self) -> DVec2 {
        DVec2::new(f64::from(self.column) + 0.5, f64::from(self.row) + 0.5)
    }
}

/// Which kind of tile a cell holds: an index into the world's list of tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TileId(pub u8);

impl TileId {
    /// A world has no more tiles.
    #[cfg_attr(not(feature = "tui"), expect(dead_code, reason = "only the minimap has a table"))]
    pub(crate) const MOST: usize = 1 << u8::BITS;
}

/// Which tile each cell holds, and which tiles are solid.
///
/// Tiles are numbered with the open ones first, so that asking whether a cell is solid is one
/// comparison and needs no table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Grid {
    width: NonZeroU32,
    height: NonZeroU32,
    first_solid: TileId,
    cells: Vec<TileId>,
    /// Where something stands that is in the way.
    occupied: BTreeSet<Cell>,
    /// Where rays need not look. It is shared, as it never changes.
    clearance: Arc<Clearance>,
}

impl Grid {
    /// A grid of `width` × `height` cells, row by row from the north, where tiles from
    /// `first_solid` on are solid. `None` where `cells` is not as long as that.
    pub fn new(
        width: NonZeroU32,
        height: NonZeroU32,
        first_solid: TileId,
        cells: Vec<TileId>,
    ) -> Option<Self> {
        let count = u64::from(width.get()) * u64::from(height.get());
        if cells.len() as u64 != count {
            return None;
        }
        let is_solid = |&tile: &TileId| tile >= first_solid;
        let rows = cells.chunks_exact(width.get() as usize);
        let clearance = Clearance::new(rows.map(|row| row.iter().map(is_solid)));
        Some(Self {
            width,
            height,
            first_solid,
            occupied: BTreeSet::new(),
            clearance: Arc::new(clearance),
            cells,
        })
    }

    /// A grid drawn in characters: `.` and a space are open floor (tile 0), anything else is solid
    /// (tile 1). `None` where it is empty or its rows are not of one length.
    ///
    /// ```
    /// let grid = cellcaster::world::Grid::sketch(&["###", "#.#", "###"]).unwrap();
    /// assert!(grid.is_solid(0, 0) && !grid.is_solid(1, 1));
    /// ```
    pub fn sketch(rows: &[&str]) -> Option<Self> {
        let width = NonZeroU32::new(rows.first()?.chars().count() as u32)?;
        let height = NonZeroU32::new(rows.len() as u32)?;
        if rows.iter().any(|row| row.chars().count() as u32 != width.get()) {
            return None;
        }
        let tile = |character| TileId(u8::from(!matches!(character, '.' | ' ')));
        let cells = rows.iter().flat_map(|row| row.chars()).map(tile).collect();
        Self::new(width, height, TileId(1), cells)
    }

    /// Lets rays skip what is empty, where the map is empty enough, though some of its open tiles
    /// `may_become_solid`.
    pub(super) fn clear(&mut self, may_become_solid: impl Fn(TileId) -> bool) {
        self.clearance = Arc::new(self.near(may_become_solid).measured_if_worthwhile());
    }

    /// As [`Grid::clear`], however many walls there are.
    #[cfg(test)]
    pub(crate) fn measure_clearance(&mut self, may_become_solid: impl Fn(TileId) -> bool) {
        self.clearance = Arc::new(self.near(may_become_solid).measured());
    }

    /// As [`Grid::measure_clearance`], with shafts.
    #[cfg(test)]
    pub(crate) fn make_shafts(&mut self, may_become_solid: impl Fn(TileId) -> bool) {
        self.clearance = Arc::new(self.near(may_become_solid).measured().with_shafts());
    }

    /// How clear it is where one looks one cell far.
    fn near(&self, may_become_solid: impl Fn(TileId) -> bool) -> Clearance {
        let may_be_solid = |&tile: &TileId| self.is_solid_tile(tile) || may_become_solid(tile);
        Clearance::new(self.rows().map(|row| row.iter().map(may_be_solid)))
    }

    /// Where rays need not look.
    #[inline]
    pub(crate) fn clearance(&self) -> &Clearance {
        &self.clearance
    }

    /// Lamplight for as many cells, in which no lamp shines yet.
    pub(crate) fn lamplight(&self) -> Lamplight {
        Lamplight::new(self.width, self.height)
    }

    /// Columns, from west to east.
    pub fn width(&self) -> u32 {
        self.width.get()
    }

    /// Rows, from north to south.
    pub fn height(&self) -> u32 {
        self.height.get()
    }

    /// The tile at a place, or `None` off the map.
    #[inline]
    pub fn tile(&self, column: i64, row: i64) -> Option<TileId> {
        // As unsigned numbers, those below 0 are beyond any width.
        let (column, row) = (column as u64, row as u64);
        let is_on_map = column < u64::from(self.width()) && row < u64::from(self.height());
        is_on_map.then(|| self.cells[row as usize * self.width() as usize + column as usize])
    }

    /// The same cells, where those are solid as well whose tile is not among `level`.
    ///
    /// The tiles of these cells are not known from it.
    pub(super) fn ending_at_others(&self, is_level: impl Fn(TileId) -> bool) -> Self {
        let tile = |&tile: &TileId| if is_level(tile) { tile } else { TileId(u8::MAX) };
        Self { cells: self.cells.iter().map(tile).collect(), ..self.clone() }
    }

    /// Puts `tile` into `cell`, which must be on the map.
    pub(super) fn set(&mut self, cell: Cell, tile: TileId) {
        let width = self.width() as usize;
        self.cells[cell.row as usize * width + cell.column as usize] = tile;
    }

    /// Notes that something stands in `cell` that one cannot walk through.
    pub(crate) fn occupy(&mut self, cell: Cell) {
        self.occupied.insert(cell);
    }

    /// Whether something stands at a place, on the map, that nobody can walk through.
    pub fn is_occupied(&self, column: i64, row: i64) -> bool {
        let cell = Cell { column: column as u32, row: row as u32 };
        !self.occupied.is_empty() && self.occupied.contains(&cell)
    }

    /// Whether there is something solid at a place; off the map there is nothing.
    pub fn is_solid(&self, column: i64, row: i64) -> bool {
        self.tile(column, row).is_some_and(|tile| self.is_solid_tile(tile))
    }

    /// The first tile that is solid; so are all that come after it.
    pub(crate) fn first_solid(&self) -> TileId {
        self.first_solid
    }

    /// Whether cells that hold `tile` are solid.
    pub fn is_solid_tile(&self, tile: TileId) -> bool {
        tile >= self.first_solid
    }

    /// How many bytes it takes in memory: its cells, and what rays know of them.
    pub fn bytes(&self) -> usize {
        size_of_val(self.cells.as_slice()) + self.clearance.bytes()
    }

    /// The tiles row by row from the north, each row from the west.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[TileId]> {
        self.cells.chunks_exact(self.width() as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn off_the_map_is_nothing() {
        let grid = Grid::sketch(&["#.", "##", "##"]).unwrap();
        assert_eq!((grid.width(), grid.height()), (2, 3));
        assert!(!grid.is_solid(1, 0) && grid.is_solid(1, 2));
        for (column, row) in [(-1, 0), (0, -1), (2, 0), (0, 3), (i64::MAX, i64::MIN)] {
            assert_eq!(grid.tile(column, row), None);
            assert!(!grid.is_solid(column, row));
        }
    }

    #[test]
    fn no_grid_without_cells_or_with_ragged_rows() {
        assert_eq!(Grid::sketch(&[]), None);
        assert_eq!(Grid::sketch(&[""]), None);
        assert_eq!(Grid::sketch(&["##", "#"]), None);
    }
}
