//! Which cells of a map have been seen so far.
//!
//! One ray is followed for each column of pixels, in the exact order of the cells that it enters. It carries the
//! slopes at which it still sees: what stands raises the lower one, what hangs lowers the upper one. A cell has
//! been seen where its floor, or a face of what stands in it, is between the two. How far the picture reaches up
//! and down does not count: the floor before one's feet is known without looking down.
//!
//! What a mirror shows is not seen by this, since a map can't tell which of its cells it is; and it would give
//! away what lies behind corners.
//!
//! To take the cells from the renderer's own rays was refused: on level maps it casts only few of them, and it
//! would have to keep what nobody but a map asks for.

use std::collections::BTreeMap;

use crate::cast::{MirroredWalk, Ray};
use crate::generate::Site;
use crate::world::{Camera, Cell, Gap, TileId, TileKind, World};

/// The cells of a map that a player has seen so far, for a [`Minimap`](super::Minimap) to show.
///
/// One belongs to one level: a world of another size is another level, of which nothing has been seen.
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
    /// Columns and rows of the world.
    size: (u32, u32),
    /// A bit for each cell, row by row, each row in whole words.
    words: Vec<u32>,
    /// How many cells that are no wall there are, and how many of them have been seen.
    open: u32,
    open_seen: u32,
    /// The cell of a generated level at which the world begins.
    corner: Site,
    /// What has been seen of such a level before its window moved: 32 cells of a row by the row and the first
    /// column.
    elsewhere: BTreeMap<(i64, i64), u32>,
}

/// Cells in a word.
const WORD: u32 = u32::BITS;
/// What fog leaves less of than this share is not seen.
const FAINTEST: f64 = 1.0 / 32.0;

impl Explored {
    /// Adds what `camera` sees of `world` by so many `rays`, which are those of the columns of a picture as wide.
    pub fn look(&mut self, world: &World, camera: &Camera, rays: u32) {
        self.begin(world);
        let heights = world.tiles().iter().map(|tile| {
            let top_gap = tile.gaps().next_back().map_or(0.0, |gap| gap.bottom);
            top_gap.max(tile.top_of_what_stands())
        });
        let top = heights.fold(0.0, f64::max);
        let look = Look { world, eye: camera.eye(), top };
        let plane = camera.direction().perp() * camera.field_of_view.half_width();
        for column in 0..rays {
            let across = 2.0 * (f64::from(column) + 0.5) / f64::from(rays) - 1.0;
            let direction = camera.direction() + plane * across;
            if let Ok(ray) = Ray::new(camera.position(), direction) {
                look.follow(&ray, |cell, is_open| self.insert(cell, is_open));
            }
        }
    }

    /// Keeps what was seen when the window of a generated level moves: the world's first cell, in the north-west,
    /// is that of `corner` now.
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
    #[inline]
    pub fn contains(&self, cell: Cell) -> bool {
        let is_on_map = cell.column < self.size.0 && cell.row < self.size.1;
        is_on_map && self.words[self.word(cell)] >> (cell.column % WORD) & 1 == 1
    }

    /// Which part of all cells that are no wall has been seen, from 0 to 1.
    pub fn share(&self) -> f64 {
        f64::from(self.open_seen) / f64::from(self.open.max(1))
    }

    /// Forgets another level.
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

    /// Notes that `cell`, which is on the map, has been seen; whether that is new.
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

    /// The row and the column in the level of `cell` in the world.
    fn site(&self, cell: Cell) -> (i64, i64) {
        let along = |first: i64, place: u32| first.wrapping_add(place.into());
        (along(self.corner.row, cell.row), along(self.corner.column, cell.column))
    }

    fn word(&self, cell: Cell) -> usize {
        cell.row as usize * self.words_of_a_row() + (cell.column / WORD) as usize
    }

    fn words_of_a_row(&self) -> usize {
        self.size.0.div_ceil(WORD) as usize
    }
}

/// What all rays of one look share.
struct Look<'a> {
    world: &'a World,
    /// How high the eye is, in cells.
    eye: f64,
    /// The height that nothing reaches above.
    top: f64,
}

/// The slopes at which a ray still sees, in heights per distance.
#[derive(Clone, Copy)]
struct Sight {
    low: f64,
    high: f64,
}

impl Sight {
    fn is_closed(self) -> bool {
        self.low >= self.high
    }

    /// What both see.
    fn and(self, other: Self) -> Self {
        Self { low: self.low.max(other.low), high: self.high.min(other.high) }
    }
}

impl Look<'_> {
    /// Tells `see` each cell that `ray` sees, and whether it is no wall.
    fn follow(&self, ray: &Ray, mut see: impl FnMut(Cell, bool)) {
        let grid = self.world.grid();
        let mut walk = MirroredWalk::new(grid, ray, 0);
        let mut place = walk.cell(grid);
        let mut gap = self.gap_around_the_eye(place);
        let mut sight = Sight { low: f64::NEG_INFINITY, high: f64::INFINITY };
        let mut from = 0.0;
        if let Some((cell, tile)) = place {
            see(cell, !is_wall(self.world.tile(tile).kind));
        }
        loop {
            if let Some((cell, tile)) = place
                && let Some((t, top)) = self.standing(&walk, cell, tile)
            {
                see(cell, true);
                sight.low = sight.low.max(self.slope(top, t));
            }
            let crossed = walk.cross(grid);
            let t = walk.distance(&crossed);
            let seen_of_gap = self.seen_of(gap, t);
            if let Some((cell, tile)) = place {
                let floor = Sight { low: self.slope(gap.bottom, from), high: seen_of_gap.low };
                if self.eye > gap.bottom && !floor.and(sight).is_closed() {
                    see(cell, !is_wall(self.world.tile(tile).kind));
                }
            }
            sight = sight.and(seen_of_gap);
            let Some((cell, tile)) = crossed.into else { return };
            if sight.is_closed() || self.slope(self.top, t) <= sight.low || self.is_hidden_by_fog(t)
            {
                return;
            }
            let kind = self.world.tile(tile).kind;
            match self.enter(tile, sight, t) {
                Entered { gap: None, .. } => return see(cell, !is_wall(kind)),
                Entered { gap: Some(next), shows_face } => {
                    if shows_face {
                        see(cell, !is_wall(kind));
                    }
                    gap = next;
                    sight = sight.and(self.slopes(next, t));
                }
            }
            (place, from) = (crossed.into, t);
        }
    }

    /// The gap that a ray goes on in which enters `tile` at `t`: the lowest in view.
    fn enter(&self, tile: TileId, sight: Sight, t: f64) -> Entered {
        let gaps = self.world.tiles()[usize::from(tile.0)].gaps();
        let gap = gaps.into_iter().find(|&gap| !self.slopes(gap, t).and(sight).is_closed());
        let shows_face = gap.is_some_and(|gap| {
            let Sight { low, high } = self.slopes(gap, t);
            low > sight.low || high < sight.high
        });
        Entered { gap, shows_face }
    }

    /// The slopes of a gap that begins or ends at `t`.
    fn slopes(&self, gap: Gap, t: f64) -> Sight {
        Sight { low: self.slope(gap.bottom, t), high: self.slope(gap.top, t) }
    }

    /// The slopes at which one sees through a gap that ends at `t`.
    fn seen_of(&self, gap: Gap, t: f64) -> Sight {
        let Sight { low, high } = self.slopes(gap, t);
        Sight {
            low: if self.eye > gap.bottom { low } else { f64::NEG_INFINITY },
            high: if self.eye < gap.top { high } else { f64::INFINITY },
        }
    }

    fn slope(&self, height: f64, t: f64) -> f64 {
        let rise = height - self.eye;
        if rise == 0.0 { 0.0 } else { rise / t }
    }

    /// Where the ray meets what stands in `cell` and can't be seen through, and how high that is.
    fn standing(&self, walk: &MirroredWalk, cell: Cell, tile: TileId) -> Option<(f64, f64)> {
        let tile = &self.world.tiles()[usize::from(tile.0)];
        if !matches!(tile.kind, TileKind::Door(_) | TileKind::Shape(_)) {
            return None;
        }
        let hit = walk.standing(self.world, cell, tile.kind).hit?;
        Some((hit.t, tile.top_of_what_stands()))
    }

    fn is_hidden_by_fog(&self, t: f64) -> bool {
        self.world.fog().is_some_and(|fog| fog.clearness(t) < FAINTEST)
    }

    /// What is open where the eye is; inside rock, everything.
    fn gap_around_the_eye(&self, place: Option<(Cell, TileId)>) -> Gap {
        let tile = place.map_or(self.world.ground(), |(_, tile)| self.world.tile(tile));
        let around = tile.gaps().find(|gap| gap.holds(self.eye));
        around.unwrap_or(Gap { bottom: f64::NEG_INFINITY, top: f64::INFINITY })
    }
}

/// What a ray meets where it enters a cell.
struct Entered {
    /// `None` where it ends there.
    gap: Option<Gap>,
    shows_face: bool,
}

fn is_wall(kind: TileKind) -> bool {
    matches!(kind, TileKind::Wall(_) | TileKind::Mirror(_))
}

#[cfg(test)]
mod tests;
