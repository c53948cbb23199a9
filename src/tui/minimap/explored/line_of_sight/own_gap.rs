//! Cells with the observer's own gap: floor and ceiling at the heights of the observer's cell.
//!
//! Most cells are such. A ray through them sees all of them, so that it only crosses lines until it enters
//! another tile, and knows nothing of mirrors until then.

use super::{Line, Observer, is_opaque_inside};
use crate::cast::{Crossing, Ray, RayWalk, Side, WalkFromInside, distance_on_entry};
use crate::tui::minimap::explored::is_wall;
use crate::world::{Cell, TileId};

/// What a tile is for a ray that has been in cells with the observer's own gap only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Passage {
    /// The same gap, in which nothing opaque stands: the ray sees the cell.
    Same,
    /// A block that ends the ray, which sees its face.
    Block,
    Other,
}

/// Beyond this distance, in cells, and so much farther, a slope is another one however it is rounded.
const NEAR: f64 = 1e-9;
const FARTHER: f64 = 1.0 + 1e-9;

/// What rounded distances of a walk, in its unit, say for certain.
struct Certain {
    /// A distance up to which fog hides nothing, or less.
    clear_to: f64,
    /// A distance beyond [`NEAR`], or more.
    near: f64,
}

impl Certain {
    fn new(unit: f64, clear_to: f64) -> Self {
        // More than enough for the errors of both distances.
        const MARGIN: f64 = 1.0 + 1e-9;
        /// The units of which no product has underflowed or overflowed.
        const SOUND: std::ops::Range<f64> = 1e-150..1e150;
        if SOUND.contains(&unit) {
            Self { clear_to: clear_to * unit / MARGIN, near: NEAR * unit * MARGIN }
        } else {
            Self { clear_to: 0.0, near: f64::INFINITY }
        }
    }

    /// Whether [`Observer::rises`] is true for these distances.
    #[inline]
    fn rises(&self, from: f64, to: f64) -> bool {
        from > self.near && to > from * (FARTHER * FARTHER)
    }
}

impl Observer<'_> {
    /// Has rays do the same in all cells.
    #[cfg(test)]
    pub(crate) fn forget_passages(&mut self) {
        self.passages.fill(Passage::Other);
    }

    pub(crate) fn find_passages(&mut self) {
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
                *passage = Passage::Block;
            } else if lowest == own_gap && is_empty && !is_wall(tile.kind) {
                *passage = Passage::Same;
            }
        }
    }

    /// Follows the walk of `ray` from `position`, where it begins, through cells with the observer's own
    /// gap. Returns the line in the last of them, or `None` if it ends there.
    #[inline]
    pub(crate) fn follow_through_own_gap(
        &self,
        walk: WalkFromInside,
        ray: &Ray,
        mut position: (Cell, TileId),
        see: &mut impl FnMut(Cell, bool),
    ) -> Option<Line> {
        let certain = Certain::new(walk.unit(), self.clear_to);
        let (mut from, mut entered) = (0.0, None);
        let distance = |cell, entered: Option<Side>| {
            entered.map_or(0.0, |side| distance_on_entry(ray, cell, side))
        };
        for (Crossing { cell: next, tile, side }, to) in walk {
            let passage = self.passage(tile);
            let is_clear = to < certain.clear_to || distance(next, Some(side)) <= self.clear_to;
            if passage == Passage::Other || !is_clear {
                break;
            }
            if certain.rises(from, to)
                || self.rises(distance(position.0, entered), distance(next, Some(side)))
            {
                see(position.0, true);
            }
            if passage == Passage::Block {
                see(next, self.is_open(tile));
                return None;
            }
            (position, from, entered) = ((next, tile), to, Some(side));
        }
        Some(self.line_in(ray, position, distance(position.0, entered), entered))
    }

    /// The line of `ray` in a cell that it has entered, or in which it begins.
    #[inline(never)]
    fn line_in(
        &self,
        ray: &Ray,
        position: (Cell, TileId),
        from: f64,
        entered: Option<Side>,
    ) -> Line {
        let grid = self.world.grid();
        let walk = match entered {
            Some(side) => RayWalk::entering(grid, ray, (position.0, side)),
            None => RayWalk::new(grid, ray),
        };
        Line { walk, position: Some(position), from }
    }

    /// Whether the floor of the observer's own gap has a lower slope at `from` than at `t`. They are equal in
    /// a cell of which the ray meets a corner only.
    #[inline]
    fn rises(&self, from: f64, t: f64) -> bool {
        let bottom = self.own_gap.bottom;
        from > NEAR && t > from * FARTHER || self.slope(bottom, from) < self.slope(bottom, t)
    }

    #[inline]
    pub(crate) fn passage(&self, tile: TileId) -> Passage {
        self.passages[usize::from(tile.0)]
    }
}
