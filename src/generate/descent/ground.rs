//! The ground of a floor: its cells, the paths from the start, and visibility between cells.

use std::iter;
use std::num::NonZeroU32;

use super::super::tileset::Tileset;
use crate::rng::SplitMix64;
use crate::world::{Cell, Flood};

/// The cells of a floor before things and guards are placed.
pub(crate) struct Ground {
    /// The map characters, row by row.
    cells: Vec<Vec<u8>>,
    /// The properties of each cell, row by row.
    kinds: Vec<CellProperties>,
    pub(crate) start: Cell,
    /// The number of steps from the start to each cell, row by row; `None` if there is no path.
    distances: Vec<Option<u32>>,
    /// The reachable cells, nearest first.
    pub(crate) reachable: Vec<Cell>,
}

/// The properties of a cell that affect paths and visibility.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a property of its own")]
struct CellProperties {
    /// `true` if a player can walk there once doors are open.
    is_walkable: bool,
    is_door: bool,
    /// `true` if the cell is floor with nothing on it.
    is_bare: bool,
    /// `true` if the cell blocks the view.
    is_opaque: bool,
}

impl Ground {
    pub(crate) fn new(cells: Vec<Vec<u8>>, start: (u32, u32), tileset: &Tileset) -> Self {
        let kind = |&character: &u8| CellProperties {
            is_walkable: tileset.is_walkable(character),
            is_door: tileset.is_walkable(character) && !tileset.is_floor(character),
            is_bare: tileset.is_bare(character),
            is_opaque: tileset.is_opaque(character),
        };
        let kinds = cells.iter().flatten().map(kind).collect();
        let start = Cell { column: start.0, row: start.1 };
        let mut ground = Self { cells, kinds, start, distances: Vec::new(), reachable: Vec::new() };
        let ways = ground.ways_from(start, u32::MAX, |kind| kind.is_walkable);
        ground.distances = vec![None; ground.kinds.len()];
        for &(cell, distance) in &ways {
            let index = ground.index(cell);
            ground.distances[index] = Some(distance);
        }
        ground.reachable = ways.into_iter().map(|(cell, _)| cell).collect();
        ground
    }

    /// The number of reachable cells that have nothing opaque around them.
    pub(crate) fn open_count(&self) -> usize {
        self.reachable.iter().filter(|&&cell| self.is_open(cell)).count()
    }

    /// The number of steps from the start to a reachable cell; 0 for any other cell.
    pub(crate) fn distance(&self, cell: Cell) -> u32 {
        self.distances[self.index(cell)].unwrap_or(0)
    }

    /// Returns true if a cell is floor with nothing on it.
    pub(crate) fn is_bare(&self, cell: Cell) -> bool {
        self.kind(cell).is_bare
    }

    /// The number of walkable cells beside a cell that is not on the edge.
    pub(crate) fn exits_of(&self, cell: Cell) -> usize {
        cell.beside().filter(|&cell| self.kind(cell).is_walkable).count()
    }

    /// The cells within `most` steps over open floor, nearest first, with the number of steps to
    /// each.
    pub(crate) fn around(&self, cell: Cell, most: u32) -> Vec<(Cell, u32)> {
        self.ways_from(cell, most, |kind| kind.is_walkable && !kind.is_door)
    }

    /// Draws the exit into one of the cells farthest from the start.
    pub(crate) fn place_exit(&mut self, tileset: &Tileset, random: &mut SplitMix64) -> Cell {
        let bare = self.reachable.iter().filter(|&&cell| cell != self.start && self.is_bare(cell));
        let bare: Vec<Cell> = bare.copied().collect();
        let farthest = &bare[bare.len() - bare.len().div_ceil(8)..];
        let exit = farthest.get(random.below(farthest.len())).copied().unwrap_or(self.start);
        let character = &mut self.cells[exit.row as usize][exit.column as usize];
        *character = tileset.exit_on(*character).unwrap_or(*character);
        let index = self.index(exit);
        self.kinds[index].is_bare = false;
        exit
    }

    /// Returns true if something in the cell `to` could be seen from the cell `from`: a line from
    /// the middle of `from` to the middle of `to`, or to a point near its edge, meets nothing
    /// opaque.
    pub(crate) fn sees(&self, from: Cell, to: Cell) -> bool {
        /// The targets, in hundredths of a cell from the middle.
        const BODY: [(i64, i64); 9] = [
            (0, 0),
            (-40, 0),
            (40, 0),
            (0, -40),
            (0, 40),
            (-30, -30),
            (30, -30),
            (-30, 30),
            (30, 30),
        ];
        /// The number of points tested for each cell of a line's length.
        const POINTS: i64 = 16;
        let middle = |place: u32| i64::from(place) * 100 + 50;
        let (x, y) = (middle(from.column), middle(from.row));
        BODY.iter().any(|&(across, down)| {
            let (dx, dy) = (middle(to.column) + across - x, middle(to.row) + down - y);
            let count = (dx.abs().max(dy.abs()) * POINTS / 100).max(1);
            let side = 100 * count;
            (1..count).all(|point| {
                let (x, y) = (x * count + dx * point, y * count + dy * point);
                // A point on the border of two cells says nothing about either.
                let is_between = x % side == 0 || y % side == 0;
                let cell = || Cell { column: (x / side) as u32, row: (y / side) as u32 };
                is_between || !self.kind(cell()).is_opaque
            })
        })
    }

    /// The number of columns.
    pub(crate) fn width(&self) -> NonZeroU32 {
        let width = self.cells.first().map_or(0, Vec::len);
        NonZeroU32::new(width as u32).unwrap_or(NonZeroU32::MIN)
    }

    /// The map characters, row by row.
    pub(crate) fn rows(&self) -> Vec<Vec<u8>> {
        self.cells.clone()
    }

    /// The cells within `most` steps of `from` through cells for which `is_open` returns true,
    /// nearest first, with the number of steps to each.
    fn ways_from(
        &self,
        from: Cell,
        most: u32,
        is_open: impl Fn(CellProperties) -> bool,
    ) -> Vec<(Cell, u32)> {
        let mut flood = Flood::new((self.width().get(), self.cells.len() as u32), from);
        let next = || flood.next(|cell| is_open(self.kind(cell)));
        iter::from_fn(next).take_while(|&(_, distance)| distance <= most).collect()
    }

    /// Returns true if neither the cell nor any of its eight neighbours is opaque.
    fn is_open(&self, Cell { column, row }: Cell) -> bool {
        (row - 1..=row + 1).all(|row| {
            (column - 1..=column + 1).all(|column| !self.kind(Cell { column, row }).is_opaque)
        })
    }

    fn kind(&self, cell: Cell) -> CellProperties {
        self.kinds[self.index(cell)]
    }

    fn index(&self, cell: Cell) -> usize {
        cell.row as usize * self.width().get() as usize + cell.column as usize
    }
}
