//! Lines of sight: the cells that one ray sees.
//!
//! A ray is followed cell by cell, in the exact order in which it enters them, with the range of
//! slopes at which it still sees. Floors and things raise the lower end of the range, ceilings
//! lower the upper end. A cell is seen if its floor, or a face of something in it, is within the
//! range. The vertical field of view does not count: the player knows the floor at their feet
//! without looking down.
//!
//! A mirror ends a line of sight: a map cannot show which of its cells is the one in the mirror,
//! and reflections would reveal what is behind corners.

mod own_gap;

use self::own_gap::Passage;
use super::is_wall;
use crate::cast::{Crossed, Ray, RayWalk, WalkFromInside};
use crate::world::{Camera, Cell, Gap, Tile, TileId, TileKind, World};

/// Cells in which fog leaves less than this share of light are not seen.
const LEAST_CLEARNESS: f64 = 1.0 / 32.0;

/// An eye in a world, which all rays of one position share.
pub(crate) struct Observer<'a> {
    world: &'a World,
    /// The height of the eye, in cells.
    eye: f64,
    /// The greatest height of anything.
    top: f64,
    /// A distance up to which fog hides nothing.
    clear_to: f64,
    /// The gap around the eye in the observer's cell.
    own_gap: Gap,
    /// What each tile is for a ray that has been in cells with that gap only.
    passages: [Passage; TileId::MOST],
}

/// The range of slopes at which a ray still sees, in height per distance.
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
    pub(crate) fn new(world: &'a World, camera: &Camera) -> Self {
        let eye = camera.eye();
        let heights = world.tiles().iter().map(|tile| {
            let top_gap = tile.gaps().next_back().map_or(0.0, |gap| gap.bottom);
            top_gap.max(tile.top_of_what_stands())
        });
        let top = heights.fold(0.0, f64::max);
        let place = camera.position().floor();
        let tile = world.grid().tile(place.x as i64, place.y as i64);
        let own_gap = gap_around(eye, tile.map_or(world.ground(), |tile| world.tile(tile)));
        let clear_to = world.fog().map_or(f64::INFINITY, |fog| fog.clear_to(LEAST_CLEARNESS));
        let passages = [Passage::Other; TileId::MOST];
        let mut observer = Self { world, eye, top, clear_to, own_gap, passages };
        observer.find_passages();
        observer
    }
}

impl Observer<'_> {
    /// Calls `see` with each cell that `ray` sees, and with `true` if it is not a wall.
    pub(crate) fn follow(&self, ray: &Ray, mut see: impl FnMut(Cell, bool)) {
        let grid = self.world.grid();
        let walk = WalkFromInside::new(grid, ray);
        let position = walk.as_ref().map(|&(_, cell, tile)| (cell, tile));
        if let Some((cell, tile)) = position {
            see(cell, self.is_open(tile));
        }
        let mut visible = SlopeRange { low: f64::NEG_INFINITY, high: f64::INFINITY };
        let (mut gap, mut line) = if let Some((walk, cell, tile)) = walk
            && self.passage(tile) == Passage::Same
        {
            let start = (cell, tile);
            let Some(line) = self.follow_through_own_gap(walk, ray, start, &mut see) else {
                return;
            };
            visible = self.slopes(self.own_gap, line.from);
            (self.own_gap, line)
        } else {
            let line = Line { walk: RayWalk::new(grid, ray), position, from: 0.0 };
            (self.gap_around_eye(position), line)
        };
        let mut crossed = self.cross(&mut line, &mut visible, &mut see);
        loop {
            let Line { walk, position, from } = &mut line;
            let t = walk.distance(&crossed);
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
            match self.enter(tile, visible, t) {
                Entered { gap: None, .. } => return see(cell, self.is_open(tile)),
                Entered { gap: Some(next), shows_face } => {
                    if shows_face {
                        see(cell, self.is_open(tile));
                    }
                    gap = next;
                    visible = visible.intersection(self.slopes(next, t));
                }
            }
            (*position, *from) = (crossed.into, t);
            crossed = self.cross(&mut line, &mut visible, &mut see);
        }
    }

    /// Crosses the next line, after what stands in the cell before it.
    fn cross(
        &self,
        line: &mut Line,
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

    /// Whether cells with `tile` are not walls.
    fn is_open(&self, TileId(tile): TileId) -> bool {
        !is_wall(self.world.tiles()[usize::from(tile)].kind)
    }

    /// The lowest visible gap of `tile`, in which a ray that enters it at `t` continues.
    fn enter(&self, tile: TileId, visible: SlopeRange, t: f64) -> Entered {
        let gaps = self.world.tiles()[usize::from(tile.0)].gaps();
        let gap =
            gaps.into_iter().find(|&gap| !self.slopes(gap, t).intersection(visible).is_empty());
        let shows_face = gap.is_some_and(|gap| {
            let SlopeRange { low, high } = self.slopes(gap, t);
            low > visible.low || high < visible.high
        });
        Entered { gap, shows_face }
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
        let hit = walk.standing(self.world, cell, tile.kind).hit?;
        Some((hit.t, tile.top_of_what_stands()))
    }

    fn is_hidden_by_fog(&self, t: f64) -> bool {
        t > self.clear_to && self.world.fog().is_some_and(|fog| fog.clearness(t) < LEAST_CLEARNESS)
    }

    /// The gap that contains the eye.
    fn gap_around_eye(&self, position: Option<(Cell, TileId)>) -> Gap {
        let tile = position.map_or(self.world.ground(), |(_, tile)| self.world.tile(tile));
        gap_around(self.eye, tile)
    }
}

/// The gap of a tile that contains the eye; inside of solid rock, everything.
fn gap_around(eye: f64, tile: Tile) -> Gap {
    let around = tile.gaps().find(|gap| gap.holds(eye));
    around.unwrap_or(Gap { bottom: f64::NEG_INFINITY, top: f64::INFINITY })
}

/// Whether something opaque stands in a gap of the tile.
fn is_opaque_inside(tile: &Tile) -> bool {
    matches!(tile.kind, TileKind::Door(_) | TileKind::Shape(_))
}

/// A line of sight as far as it has been followed.
pub(crate) struct Line {
    walk: RayWalk,
    /// The cell that it is in; `None` off the map.
    position: Option<(Cell, TileId)>,
    /// The distance at which it has entered that cell.
    from: f64,
}

/// The result of entering a cell.
struct Entered {
    /// `None` if the ray ends at the cell's edge.
    gap: Option<Gap>,
    shows_face: bool,
}
