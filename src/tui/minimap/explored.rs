//! The cells of a map that the player has seen so far.
//!
//! For each column of pixels, one ray is followed along its [line of sight](line_of_sight).
//!
//! Taking the cells from the renderer's own rays was refused: on flat maps it casts only few of
//! them, and it would have to store cells that only the minimap needs.

mod line_of_sight;

use std::collections::BTreeMap;

use crate::cast::Ray;
use crate::generate::Site;
use crate::world::{Camera, Cell, TileId, TileKind, World};
use line_of_sight::Observer;

/// The cells of a map that a player has seen so far, for a [`Minimap`](super::Minimap).
///
/// A value belongs to one level. A world of another size is another level, of which nothing has
/// been seen.
///
/// ```
/// use cellcaster::tui::{Explored, Minimap};
/// use cellcaster::world::{Cell, FieldOfView};
///
/// let world = cellcaster::map::builtin::LEVELS[0].world()?;
/// let camera = world.start_camera(FieldOfView::default());
/// let mut explored = Explored::default();
/// explored.look(&world, &camera, 80);
/// assert!(explored.contains(world.start().cell));
/// assert!(!explored.contains(Cell { column: 18, row: 12 }), "the exit is around corners");
/// let map = Minimap::new(&world, &camera).explored(&explored);
/// # Ok::<(), cellcaster::fault::Faults>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Explored {
    /// The numbers of columns and rows of the world.
    size: (u32, u32),
    /// A bit for each cell, row by row; each row begins with a new word.
    words: Vec<u32>,
    /// The number of cells that are not walls, and the number of those that have been seen.
    open: u32,
    open_seen: u32,
    /// The cell of a generated level at which the world begins.
    corner: Site,
    /// The seen cells of a generated level, stored whenever the window moves: 32 cells of a row, by
    /// the row and the first column.
    elsewhere: BTreeMap<(i64, i64), u32>,
}

/// The cells of a row that have been seen: a bit for each. Beyond the last cell there are none.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeenRow<'a>(&'a [u32]);

/// The number of cells in a word.
const WORD: u32 = u32::BITS;

impl Explored {
    /// Adds the cells of `world` that `camera` sees. `rays` is the width of the picture: its
    /// columns have the same rays.
    pub fn look(&mut self, world: &World, camera: &Camera, rays: u32) {
        self.look_by(&Observer::new(world, camera), world, camera, rays);
    }

    fn look_by(&mut self, observer: &Observer, world: &World, camera: &Camera, rays: u32) {
        self.begin(world);
        let forward = camera.direction();
        let plane = forward.perp() * camera.field_of_view.half_width();
        for column in 0..rays {
            let across = 2.0 * (f64::from(column) + 0.5) / f64::from(rays) - 1.0;
            let ray = Ray::of_camera(camera.position(), forward + plane * across);
            observer.follow(&ray, |cell, is_open| self.insert(cell, is_open));
        }
    }

    /// Keeps the seen cells when the window of a generated level moves. `corner` is the new first
    /// cell of the world, in the north-west.
    pub fn follow(&mut self, corner: Site) {
        if corner == self.corner {
            return;
        }
        for cell in self.cells() {
            let (row, column) = self.site(cell);
            let word = self.elsewhere.entry((row, column.div_euclid(WORD.into()))).or_default();
            *word |= 1 << column.rem_euclid(WORD.into());
        }
        self.words.fill(0);
        self.corner = corner;
        let (width, height) = self.size;
        let elsewhere = std::mem::take(&mut self.elsewhere);
        for row in 0..height {
            let (site_row, first) = self.site(Cell { column: 0, row });
            let words =
                first.div_euclid(WORD.into())..=(first + i64::from(width)).div_euclid(WORD.into());
            let known = elsewhere.range((site_row, *words.start())..=(site_row, *words.end()));
            for (&(_, index), &word) in known {
                for bit in (0..WORD).filter(|bit| word >> bit & 1 == 1) {
                    let column = index * i64::from(WORD) + i64::from(bit) - first;
                    if let Some(column) = u32::try_from(column).ok().filter(|&it| it < width) {
                        self.set(Cell { column, row });
                    }
                }
            }
        }
        self.elsewhere = elsewhere;
    }

    /// Whether `cell` has been seen.
    pub fn contains(&self, cell: Cell) -> bool {
        self.row(cell.row).contains(cell.column)
    }

    /// The cells of a row that have been seen.
    pub(crate) fn row(&self, row: u32) -> SeenRow<'_> {
        let words = self.words_of_a_row();
        SeenRow(self.words.chunks_exact(words.max(1)).nth(row as usize).unwrap_or_default())
    }

    /// The share of cells seen, from 0 to 1, among those that are not walls.
    pub fn share(&self) -> f64 {
        f64::from(self.open_seen) / f64::from(self.open.max(1))
    }

    /// Clears everything if `world` is another level.
    fn begin(&mut self, world: &World) {
        let grid = world.grid();
        let size = (grid.width(), grid.height());
        if self.size == size {
            return;
        }
        let is_open = |&&tile: &&TileId| !is_wall(world.tile(tile).kind);
        self.open = grid.rows().flatten().filter(is_open).count() as u32;
        self.open_seen = 0;
        self.size = size;
        self.words.clear();
        self.words.resize(self.words_of_a_row() * size.1 as usize, 0);
        self.elsewhere.clear();
    }

    fn insert(&mut self, cell: Cell, is_open: bool) {
        if self.set(cell) && is_open {
            self.open_seen += 1;
        }
    }

    /// Marks `cell`, which must be on the map, as seen. Returns `false` if it was before.
    fn set(&mut self, cell: Cell) -> bool {
        let (word, bit) = (self.word(cell), 1 << (cell.column % WORD));
        let is_new = self.words[word] & bit == 0;
        self.words[word] |= bit;
        is_new
    }

    fn cells(&self) -> Vec<Cell> {
        let (width, height) = self.size;
        let all = (0..height).flat_map(|row| (0..width).map(move |column| Cell { column, row }));
        all.filter(|&cell| self.contains(cell)).collect()
    }

    /// The row and the column, in the level, of a cell of the world.
    fn site(&self, cell: Cell) -> (i64, i64) {
        let along = |first: i64, offset: u32| first.wrapping_add(offset.into());
        (along(self.corner.row, cell.row), along(self.corner.column, cell.column))
    }

    fn word(&self, cell: Cell) -> usize {
        cell.row as usize * self.words_of_a_row() + (cell.column / WORD) as usize
    }

    fn words_of_a_row(&self) -> usize {
        self.size.0.div_ceil(WORD) as usize
    }
}

impl SeenRow<'_> {
    #[inline]
    pub(crate) fn contains(self, column: u32) -> bool {
        let word = self.0.get((column / WORD) as usize);
        word.is_some_and(|word| word >> (column % WORD) & 1 == 1)
    }
}

fn is_wall(kind: TileKind) -> bool {
    matches!(kind, TileKind::Wall(_) | TileKind::Mirror(_))
}

#[cfg(test)]
mod tests;
