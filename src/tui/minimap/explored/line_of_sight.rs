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

use super::is_wall;
use crate::cast::{MirroredWalk, Ray};
use crate::world::{Cell, Gap, TileId, TileKind, World};

/// Cells in which fog leaves less than this share of light are not seen.
const LEAST_CLEARNESS: f64 = 1.0 / 32.0;

/// An eye in a world, which all rays of one position share.
pub(super) struct Observer<'a> {
    pub(super) world: &'a World,
    /// The height of the eye, in cells.
    pub(super) eye: f64,
    /// The greatest height of anything.
    pub(super) top: f64,
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

impl Observer<'_> {
    /// Calls `see` with each cell that `ray` sees, and with `true` if it is not a wall.
    pub(super) fn follow(&self, ray: &Ray, mut see: impl FnMut(Cell, bool)) {
        let grid = self.world.grid();
        let mut walk = MirroredWalk::new(grid, ray, 0);
        let mut position = walk.cell(grid);
        let mut gap = self.gap_around_eye(position);
        let mut visible = SlopeRange { low: f64::NEG_INFINITY, high: f64::INFINITY };
        let mut from = 0.0;
        if let Some((cell, tile)) = position {
            see(cell, !is_wall(self.world.tile(tile).kind));
        }
        loop {
            if let Some((cell, tile)) = position
                && let Some((t, top)) = self.standing(&walk, cell, tile)
            {
                see(cell, true);
                visible.low = visible.low.max(self.slope(top, t));
            }
            let crossed = walk.cross(grid);
            let t = walk.distance(&crossed);
            let through_gap = self.slopes_through(gap, t);
            if let Some((cell, tile)) = position {
                let floor = SlopeRange { low: self.slope(gap.bottom, from), high: through_gap.low };
                if self.eye > gap.bottom && !floor.intersection(visible).is_empty() {
                    see(cell, !is_wall(self.world.tile(tile).kind));
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
            let kind = self.world.tile(tile).kind;
            match self.enter(tile, visible, t) {
                Entered { gap: None, .. } => return see(cell, !is_wall(kind)),
                Entered { gap: Some(next), shows_face } => {
                    if shows_face {
                        see(cell, !is_wall(kind));
                    }
                    gap = next;
                    visible = visible.intersection(self.slopes(next, t));
                }
            }
            (position, from) = (crossed.into, t);
        }
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
    fn standing(&self, walk: &MirroredWalk, cell: Cell, tile: TileId) -> Option<(f64, f64)> {
        let tile = &self.world.tiles()[usize::from(tile.0)];
        if !matches!(tile.kind, TileKind::Door(_) | TileKind::Shape(_)) {
            return None;
        }
        let hit = walk.standing(self.world, cell, tile.kind).hit?;
        Some((hit.t, tile.top_of_what_stands()))
    }

    fn is_hidden_by_fog(&self, t: f64) -> bool {
        self.world.fog().is_some_and(|fog| fog.clearness(t) < LEAST_CLEARNESS)
    }

    /// The gap that contains the eye; inside of solid rock, everything.
    fn gap_around_eye(&self, position: Option<(Cell, TileId)>) -> Gap {
        let tile = position.map_or(self.world.ground(), |(_, tile)| self.world.tile(tile));
        let around = tile.gaps().find(|gap| gap.holds(self.eye));
        around.unwrap_or(Gap { bottom: f64::NEG_INFINITY, top: f64::INFINITY })
    }
}

/// The result of entering a cell.
struct Entered {
    /// `None` if the ray ends at the cell's edge.
    gap: Option<Gap>,
    shows_face: bool,
}
