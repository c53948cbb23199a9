//! The cells of a map that the player has seen.
//!
//! For each column of pixels, one ray is followed cell by cell, in the exact order in which it enters them, with the
//! range of slopes that is still visible. Floors and things raise the lower end of the range, and ceilings lower the
//! upper end. A cell is seen if its floor, or a face of something in it, is within the range. The vertical field of
//! view does not count, because the player knows the floor at their feet without looking down.
//!
//! Most cells have the observer's own gap: floor and ceiling at the heights of the observer's cell. A ray sees all of
//! these cells. Until it enters another tile, it only crosses lines, and there are no mirrors to consider.
//!
//! A mirror ends a line of sight. A map cannot show which of its cells the mirror shows, and reflections would reveal
//! cells behind corners.
//!
//! Rejected: the cells of the renderer's own rays. On flat maps the renderer casts only few rays, and it would have to
//! store cells that only the minimap needs.

use std::collections::BTreeMap;

use crate::cast::{Crossed, Crossing, Intersection, Ray, RayWalk, Side, WalkFromInside};
use crate::generate::Site;
use crate::world::{Camera, Cell, Gap, Tile, TileId, TileKind, World};

/// The cells of a map that a player has seen, for a [`Minimap`](super::Minimap).
///
/// A value belongs to one level. A world of another size counts as another level, which has not been seen yet.
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
    /// A bit for each cell, row by row. Each row begins with a new word.
    words: Vec<u32>,
    /// The number of cells that are not walls. The next field is the number of them that have been seen.
    open: u32,
    open_seen: u32,
    /// The cell of a generated level at which the world begins.
    corner: Site,
    /// The seen cells of a generated level, stored whenever the window moves. A word contains 32 cells of a row. Its
    /// key is the row, and the column divided by 32.
    elsewhere: BTreeMap<(i64, i64), u32>,
}

/// The cells of a row that have been seen, with a bit for each. Cells beyond the last one have not been seen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeenRow<'a>(&'a [u32]);

/// The number of cells in a word.
const WORD: u32 = u32::BITS;

impl Explored {
    /// Adds the cells of `world` that `camera` sees. `rays` is the width of the picture, whose columns have the same
    /// rays.
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

    /// Returns true if `cell` has been seen.
    pub fn contains(&self, cell: Cell) -> bool {
        self.row(cell.row).contains(cell.column)
    }

    /// The cells of a row that have been seen.
    pub(crate) fn row(&self, row: u32) -> SeenRow<'_> {
        let words = self.words_of_a_row();
        SeenRow(self.words.chunks_exact(words.max(1)).nth(row as usize).unwrap_or_default())
    }

    /// The seen share of the cells that are not walls, from 0 to 1.
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

    /// Marks `cell`, which must be on the map, as seen. Returns `false` if it was marked before.
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

    /// The row and the column in the generated level of a cell of the world.
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

/// Cells in which fog leaves less than this share of light are not seen.
const MIN_CLEARNESS: f64 = 1.0 / 32.0;

/// An eye at a position in a world. All rays from that position share it.
struct Observer<'a> {
    world: &'a World,
    /// The height of the eye, in cells.
    eye: f64,
    /// The greatest height of anything.
    top: f64,
    /// A distance up to which fog hides nothing.
    clear_to: f64,
    /// The gap around the eye in the observer's cell.
    own_gap: Gap,
    /// For each tile, its effect on a ray that has only been in cells with that gap.
    passages: [RayEffect; TileId::MAX],
}

/// The range of slopes that is still visible along a ray, in height per distance.
#[derive(Clone, Copy)]
struct SlopeRange {
    low: f64,
    high: f64,
}

impl SlopeRange {
    fn is_empty(self) -> bool {
        self.low >= self.high
    }

    /// The intersection of two ranges.
    fn intersection(self, other: Self) -> Self {
        Self { low: self.low.max(other.low), high: self.high.min(other.high) }
    }
}

impl<'a> Observer<'a> {
    /// The eye of `camera`.
    fn new(world: &'a World, camera: &Camera) -> Self {
        let eye = camera.eye();
        let heights = world.tiles().iter().map(|tile| {
            let top_gap = tile.gaps().next_back().map_or(0.0, |gap| gap.bottom);
            top_gap.max(tile.top_of_what_stands())
        });
        let top = heights.fold(0.0, f64::max);
        let place = camera.position().floor();
        let tile = world.grid().tile(place.x as i64, place.y as i64);
        let own_gap = gap_around(eye, tile.map_or(world.ground(), |tile| world.tile(tile)));
        let clear_to = world.fog().map_or(f64::INFINITY, |fog| fog.clear_to(MIN_CLEARNESS));
        let passages = [RayEffect::Other; TileId::MAX];
        let mut observer = Self { world, eye, top, clear_to, own_gap, passages };
        observer.find_passages();
        observer
    }
}

impl Observer<'_> {
    /// Calls `see` with each cell that `ray` sees, and with `true` if it is not a wall.
    fn follow(&self, ray: &Ray, mut see: impl FnMut(Cell, bool)) {
        let grid = self.world.grid();
        let walk = WalkFromInside::new(grid, ray);
        let position = walk.as_ref().map(|&(_, cell, tile)| (cell, tile));
        if let Some((cell, tile)) = position {
            see(cell, self.is_open(tile));
        }
        let mut visible = SlopeRange { low: f64::NEG_INFINITY, high: f64::INFINITY };
        let (mut gap, mut line) = if let Some((walk, cell, tile)) = walk
            && self.passage(tile) == RayEffect::Same
        {
            let start = (cell, tile);
            let Some(line) = self.follow_through_own_gap(walk, ray, start, &mut see) else {
                return;
            };
            visible = self.slopes(self.own_gap, line.from);
            (self.own_gap, line)
        } else {
            let line = SightRay { walk: RayWalk::new(grid, ray), position, from: 0.0 };
            (self.gap_around_eye(position), line)
        };
        let mut crossed = self.cross(&mut line, &mut visible, &mut see);
        loop {
            let SightRay { walk, position, from } = &mut line;
            let t = walk.meeting(&crossed).0;
            let through_gap = self.slopes_through(gap, t);
            if let Some((cell, tile)) = *position {
                let floor =
                    SlopeRange { low: self.slope(gap.bottom, *from), high: through_gap.low };
                if self.eye > gap.bottom && !floor.intersection(visible).is_empty() {
                    see(cell, self.is_open(tile));
                }
            }
            visible = visible.intersection(through_gap);
            let Some((cell, tile)) = crossed.into else { return };
            if visible.is_empty()
                || self.slope(self.top, t) <= visible.low
                || self.is_hidden_by_fog(t)
            {
                return;
            }
            // The ray continues in the lowest visible gap, or ends at the cell's edge.
            let gaps = self.world.tiles()[usize::from(tile.0)].gaps();
            let mut gaps = gaps.map(|gap| (gap, self.slopes(gap, t)));
            let next = gaps.find(|(_, slopes)| !slopes.intersection(visible).is_empty());
            let Some((next, slopes)) = next else { return see(cell, self.is_open(tile)) };
            // True if the face below or above the gap is visible, too.
            if slopes.low > visible.low || slopes.high < visible.high {
                see(cell, self.is_open(tile));
            }
            gap = next;
            visible = visible.intersection(slopes);
            (*position, *from) = (crossed.into, t);
            crossed = self.cross(&mut line, &mut visible, &mut see);
        }
    }

    /// Passes the thing that stands in the current cell, if any, and crosses the next line.
    fn cross(
        &self,
        line: &mut SightRay,
        visible: &mut SlopeRange,
        see: &mut impl FnMut(Cell, bool),
    ) -> Crossed {
        if let Some((cell, tile)) = line.position
            && let Some((t, top)) = self.standing(&line.walk, cell, tile)
        {
            see(cell, true);
            visible.low = visible.low.max(self.slope(top, t));
        }
        line.walk.cross(self.world.grid())
    }

    /// Returns true if cells with `tile` are not walls.
    fn is_open(&self, TileId(tile): TileId) -> bool {
        !is_wall(self.world.tiles()[usize::from(tile)].kind)
    }

    /// The range of slopes of a gap that begins or ends at `t`.
    fn slopes(&self, gap: Gap, t: f64) -> SlopeRange {
        SlopeRange { low: self.slope(gap.bottom, t), high: self.slope(gap.top, t) }
    }

    /// The range of slopes at which the eye sees through a gap that ends at `t`.
    fn slopes_through(&self, gap: Gap, t: f64) -> SlopeRange {
        let SlopeRange { low, high } = self.slopes(gap, t);
        SlopeRange {
            low: if self.eye > gap.bottom { low } else { f64::NEG_INFINITY },
            high: if self.eye < gap.top { high } else { f64::INFINITY },
        }
    }

    fn slope(&self, height: f64, t: f64) -> f64 {
        let rise = height - self.eye;
        if rise == 0.0 { 0.0 } else { rise / t }
    }

    /// The distance and the height of an opaque thing that the ray hits in `cell`.
    fn standing(&self, walk: &RayWalk, cell: Cell, tile: TileId) -> Option<(f64, f64)> {
        let tile = &self.world.tiles()[usize::from(tile.0)];
        if !is_opaque_inside(tile) {
            return None;
        }
        let hit = Intersection::of_tile(walk.ray(), self.world, cell, tile.kind).hit?;
        Some((hit.t, tile.top_of_what_stands()))
    }

    fn is_hidden_by_fog(&self, t: f64) -> bool {
        t > self.clear_to && self.world.fog().is_some_and(|fog| fog.clearness(t) < MIN_CLEARNESS)
    }

    /// The gap that contains the eye.
    fn gap_around_eye(&self, position: Option<(Cell, TileId)>) -> Gap {
        let tile = position.map_or(self.world.ground(), |(_, tile)| self.world.tile(tile));
        gap_around(self.eye, tile)
    }
}

/// The gap of a tile that contains the eye. Inside of solid rock, the gap has no bounds.
fn gap_around(eye: f64, tile: Tile) -> Gap {
    let around = tile.gaps().find(|gap| gap.holds(eye));
    around.unwrap_or(Gap { bottom: f64::NEG_INFINITY, top: f64::INFINITY })
}

/// Returns true if something opaque stands in a gap of the tile.
fn is_opaque_inside(tile: &Tile) -> bool {
    matches!(tile.kind, TileKind::Door(_) | TileKind::Shape(_))
}

/// A line of sight as far as it has been followed.
struct SightRay {
    walk: RayWalk,
    /// The cell in which the line is. `None` off the map.
    position: Option<(Cell, TileId)>,
    /// The distance at which the line has entered that cell.
    from: f64,
}

/// The effect of a tile on a ray that has only been in cells with the observer's own gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RayEffect {
    /// The tile has the same gap, and nothing opaque stands in it. The ray sees the cell.
    Same,
    /// The tile is a block that ends the ray. The ray sees its face.
    Block,
    Other,
}

impl Observer<'_> {
    /// Makes rays take the general path in all cells.
    #[cfg(test)]
    fn forget_passages(&mut self) {
        self.passages.fill(RayEffect::Other);
    }

    fn find_passages(&mut self) {
        let Self { world, eye, top, own_gap, .. } = *self;
        let is_inside = own_gap.bottom < eye && eye < own_gap.top && own_gap.bottom < top;
        if !is_inside {
            return;
        }
        for (passage, tile) in self.passages.iter_mut().zip(world.tiles()) {
            let is_empty = !is_opaque_inside(tile);
            let Some(lowest) = tile.gaps().next() else { continue };
            let hides_all = is_empty && eye < lowest.bottom && top <= lowest.bottom;
            if own_gap.top <= lowest.bottom || hides_all {
                *passage = RayEffect::Block;
            } else if lowest == own_gap && is_empty && !is_wall(tile.kind) {
                *passage = RayEffect::Same;
            }
        }
    }

    /// Follows the walk of `ray` from `position`, the cell in which it begins, through cells with the observer's own
    /// gap. Returns the line in the last of these cells, or `None` if the ray ends there.
    #[inline]
    fn follow_through_own_gap(
        &self,
        walk: WalkFromInside,
        ray: &Ray,
        mut position: (Cell, TileId),
        see: &mut impl FnMut(Cell, bool),
    ) -> Option<SightRay> {
        let (mut from, mut entered) = (0.0, None);
        for (Crossing { cell: next, tile, side }, to) in walk {
            let passage = self.passage(tile);
            if passage == RayEffect::Other || to > self.clear_to {
                break;
            }
            // Both distances are equal if the ray meets only a corner of the cell.
            if from < to {
                see(position.0, true);
            }
            if passage == RayEffect::Block {
                see(next, self.is_open(tile));
                return None;
            }
            (position, from, entered) = ((next, tile), to, Some(side));
        }
        Some(self.line_in(ray, position, from, entered))
    }

    /// The line of `ray` in a cell that it has entered, or in which it begins.
    #[inline(never)]
    fn line_in(
        &self,
        ray: &Ray,
        position: (Cell, TileId),
        from: f64,
        entered: Option<Side>,
    ) -> SightRay {
        let grid = self.world.grid();
        let walk = match entered {
            Some(side) => RayWalk::entering(grid, ray, (position.0, side)),
            None => RayWalk::new(grid, ray),
        };
        SightRay { walk, position: Some(position), from }
    }

    #[inline]
    fn passage(&self, tile: TileId) -> RayEffect {
        self.passages[usize::from(tile.0)]
    }
}

#[cfg(test)]
mod tests;
