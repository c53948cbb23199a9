//! The grid: one byte for each cell, row by row from the north.

use std::collections::BTreeSet;
use std::num::NonZeroU32;
use std::sync::Arc;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::distance_field::DistanceField;

/// The place of a cell: column from the west, row from the north, both from 0.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize,
)]
pub struct Cell {
    /// The number of cells to the west of this one.
    pub column: u32,
    /// The number of cells to the north of this one.
    pub row: u32,
}

impl Cell {
    /// The corner in the north-west.
    #[inline]
    pub(crate) fn corner(self) -> DVec2 {
        DVec2::new(f64::from(self.column), f64::from(self.row))
    }

    /// The middle of the cell.
    pub fn center(self) -> DVec2 {
        self.corner() + 0.5
    }

    /// The cell that contains `point`; `None` in the west or north of the map.
    #[inline]
    pub(crate) fn containing(point: DVec2) -> Option<Self> {
        (point.x >= 0.0 && point.y >= 0.0).then(|| Self::at(point))
    }

    /// The cell that contains `point`, which is not in the west or north of the map.
    #[inline]
    pub(crate) fn at(point: DVec2) -> Self {
        Self { column: point.x as u32, row: point.y as u32 }
    }

    /// The cell `columns` to the east and `rows` to the south; `None` at negative coordinates.
    pub(crate) fn moved(self, columns: i64, rows: i64) -> Option<Self> {
        let along = |index: u32, by: i64| u32::try_from(i64::from(index) + by).ok();
        Some(Self { column: along(self.column, columns)?, row: along(self.row, rows)? })
    }

    /// The neighbours in the west, east, north and south, except neighbours at negative
    /// coordinates.
    pub fn beside(self) -> impl Iterator<Item = Self> {
        let west = self.column.checked_sub(1).map(|column| Self { column, ..self });
        let east = self.column.checked_add(1).map(|column| Self { column, ..self });
        let north = self.row.checked_sub(1).map(|row| Self { row, ..self });
        let south = self.row.checked_add(1).map(|row| Self { row, ..self });
        [west, east, north, south].into_iter().flatten()
    }
}

/// A kind of tile: an index into the world's list of tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TileId(pub u8);

impl TileId {
    /// The largest number of tiles in a world.
    #[cfg_attr(not(feature = "tui"), expect(dead_code, reason = "only the minimap has a table"))]
    pub(crate) const MAX: usize = 1 << u8::BITS;
}

/// The tile of each cell, and which tiles are solid.
///
/// Open tiles have the lower numbers, so the test for a solid cell is one comparison without a
/// table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Grid {
    width: NonZeroU32,
    height: NonZeroU32,
    first_solid: TileId,
    cells: Vec<TileId>,
    /// The cells with things that block.
    occupied: BTreeSet<Cell>,
    /// The distance field. It is shared, because it never changes.
    distance_field: Arc<DistanceField>,
}

impl Grid {
    /// A grid of `width` × `height` cells, row by row from the north. Tiles from `first_solid` on
    /// are solid. `None` if `cells` does not have that length.
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
        let distance_field = DistanceField::new(rows.map(|row| row.iter().map(is_solid)));
        Some(Self {
            width,
            height,
            first_solid,
            occupied: BTreeSet::new(),
            distance_field: Arc::new(distance_field),
            cells,
        })
    }

    /// A grid drawn with characters: `.` and a space are open floor (tile 0), all others are solid
    /// (tile 1). `None` if it is empty, or if its rows differ in length.
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

    /// Computes the distance field, if the map is empty enough for it to pay off. Some open tiles
    /// `may_become_solid`.
    pub fn clear(&mut self, may_become_solid: impl Fn(TileId) -> bool) {
        self.distance_field = Arc::new(self.near(may_become_solid).measured_if_worthwhile());
    }

    /// Computes the distance field as [`Grid::clear`] does, whatever the map.
    #[cfg(test)]
    pub(crate) fn measure_distances(&mut self, may_become_solid: impl Fn(TileId) -> bool) {
        self.distance_field = Arc::new(self.near(may_become_solid).measured());
    }

    /// The distance field of zeros and ones.
    fn near(&self, may_become_solid: impl Fn(TileId) -> bool) -> DistanceField {
        let may_be_solid = |&tile: &TileId| self.is_solid_tile(tile) || may_become_solid(tile);
        DistanceField::new(self.rows().map(|row| row.iter().map(may_be_solid)))
    }

    /// The distance field.
    #[inline]
    pub(crate) fn distance_field(&self) -> &DistanceField {
        &self.distance_field
    }

    /// The number of columns.
    pub fn width(&self) -> u32 {
        self.width.get()
    }

    /// The number of rows.
    pub fn height(&self) -> u32 {
        self.height.get()
    }

    /// The number of columns and of rows: the corner of the map in the south-east.
    #[inline]
    pub(crate) fn extent(&self) -> DVec2 {
        DVec2::new(f64::from(self.width()), f64::from(self.height()))
    }

    /// The tile at a column and a row; `None` outside the map.
    #[inline]
    pub fn tile(&self, column: i64, row: i64) -> Option<TileId> {
        // As unsigned numbers, negative ones are greater than any width.
        let (column, row) = (column as u64, row as u64);
        let is_on_map = column < u64::from(self.width()) && row < u64::from(self.height());
        is_on_map.then(|| self.cells[row as usize * self.width() as usize + column as usize])
    }

    /// The tile of `cell`; `None` outside the map.
    #[inline]
    pub fn tile_in(&self, cell: Cell) -> Option<TileId> {
        self.tile(cell.column.into(), cell.row.into())
    }

    /// The cell at a column and a row, and its tile; `None` outside the map.
    #[inline]
    pub(crate) fn cell(&self, column: i64, row: i64) -> Option<(Cell, TileId)> {
        let tile = self.tile(column, row)?;
        Some((Cell { column: column as u32, row: row as u32 }, tile))
    }

    /// The same cells, in which uneven tiles are solid, too. Uneven tiles are not stored.
    pub(crate) fn ending_at_others(&self, is_level: impl Fn(TileId) -> bool) -> Self {
        let tile = |&tile: &TileId| if is_level(tile) { tile } else { TileId(u8::MAX) };
        Self { cells: self.cells.iter().map(tile).collect(), ..self.clone() }
    }

    /// Sets the tile of `cell`, which must be on the map.
    pub(crate) fn set(&mut self, cell: Cell, tile: TileId) {
        let width = self.width() as usize;
        self.cells[cell.row as usize * width + cell.column as usize] = tile;
    }

    /// Records that a thing in `cell` blocks.
    pub(crate) fn occupy(&mut self, cell: Cell) {
        self.occupied.insert(cell);
    }

    /// Returns whether a thing blocks a cell of the map.
    pub fn is_occupied(&self, column: i64, row: i64) -> bool {
        let cell = Cell { column: column as u32, row: row as u32 };
        !self.occupied.is_empty() && self.occupied.contains(&cell)
    }

    /// Returns whether a cell is solid; `false` outside the map.
    pub fn is_solid(&self, column: i64, row: i64) -> bool {
        self.tile(column, row).is_some_and(|tile| self.is_solid_tile(tile))
    }

    /// The first solid tile; all later ones are solid, too.
    pub(crate) fn first_solid(&self) -> TileId {
        self.first_solid
    }

    /// Returns whether cells with `tile` are solid.
    pub fn is_solid_tile(&self, tile: TileId) -> bool {
        tile >= self.first_solid
    }

    /// The size of the cells and of the distance field in memory, in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(self.cells.as_slice()) + self.distance_field.bytes()
    }

    /// The tiles of all cells, in the order of [`Grid::rows`].
    #[cfg(feature = "tui")]
    pub(crate) fn cells(&self) -> &[TileId] {
        &self.cells
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
    fn cells_off_the_map_are_empty() {
        let grid = Grid::sketch(&["#.", "##", "##"]).unwrap();
        assert_eq!((grid.width(), grid.height()), (2, 3));
        assert!(!grid.is_solid(1, 0) && grid.is_solid(1, 2));
        for (column, row) in [(-1, 0), (0, -1), (2, 0), (0, 3), (i64::MAX, i64::MIN)] {
            assert_eq!(grid.tile(column, row), None);
            assert!(!grid.is_solid(column, row));
        }
    }

    #[test]
    fn empty_and_ragged_grids_are_refused() {
        assert_eq!(Grid::sketch(&[]), None);
        assert_eq!(Grid::sketch(&[""]), None);
        assert_eq!(Grid::sketch(&["##", "#"]), None);
    }
}
