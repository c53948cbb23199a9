//! Lines of sight between two points at given heights.
//!
//! The walk follows a line through the cells in the exact order in which the line enters them. In
//! each cell the line has to stay in one gap between a floor and a ceiling. A door hides everything
//! behind its leaf, and a shape everything behind it. Glass and masks hide nothing. Smoke hides
//! everything inside and behind it.
//!
//! Rejected: the rays of the casters. They end at the first solid cell whatever its height, and do
//! not know where the line ends.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::cast::{Ray, RayWalk};
use crate::world::{Cell, Gap, TileId, TileKind, World};

/// A position and a height, in cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    pub(crate) position: DVec2,
    pub(crate) height: f64,
}

/// Smoke: an opaque disc.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Cloud {
    /// The centre, in cells.
    pub(crate) position: DVec2,
    /// The radius, in cells.
    pub(crate) radius: f64,
}

/// Whether nothing hides one of two points from the other.
pub(crate) fn is_in_sight(world: &World, clouds: &[Cloud], from: Point, to: Point) -> bool {
    !clouds.iter().any(|cloud| cloud.hides(from.position, to.position))
        && SightLine { world, from, to }.is_free()
}

impl Cloud {
    /// Whether the line from `from` to `to` meets this smoke.
    fn hides(&self, from: DVec2, to: DVec2) -> bool {
        let (way, offset) = (to - from, self.position - from);
        let length_squared = way.length_squared();
        let along = if length_squared > 0.0 { offset.dot(way) / length_squared } else { 0.0 };
        let nearest = way * along.clamp(0.0, 1.0);
        nearest.distance_squared(offset) < self.radius * self.radius
    }
}

struct SightLine<'a> {
    world: &'a World,
    from: Point,
    to: Point,
}

impl SightLine<'_> {
    fn is_free(&self) -> bool {
        let grid = self.world.grid();
        let way = self.to.position - self.from.position;
        let Ok(ray) = Ray::new(self.from.position, way) else {
            return self.is_in_one_gap();
        };
        let mut walk = RayWalk::new(grid, &ray);
        let Some(mut position) = walk.cell(grid) else { return false };
        let mut height = self.from.height;
        loop {
            if self.is_hidden_by_what_stands(&walk, position) {
                return false;
            }
            let crossed = walk.cross(grid);
            let end = walk.distance(&crossed).clamp(0.0, 1.0);
            let is_last = end >= 1.0 || crossed.into.is_none();
            let next = if is_last { self.to.height } else { self.height_at(end) };
            if self.gap_with(position.1, height, next).is_none() {
                return false;
            }
            height = next;
            match crossed.into {
                Some(into) if !is_last => position = into,
                _ => return end >= 1.0,
            }
        }
    }

    /// Like `is_free`, for two points above each other.
    fn is_in_one_gap(&self) -> bool {
        let DVec2 { x, y } = self.from.position;
        let tile = self.world.grid().tile(x.floor() as i64, y.floor() as i64);
        tile.is_some_and(|tile| self.gap_with(tile, self.from.height, self.to.height).is_some())
    }

    fn height_at(&self, t: f64) -> f64 {
        self.from.height + (self.to.height - self.from.height) * t
    }

    /// The gap of `tile` that contains both heights.
    fn gap_with(&self, TileId(tile): TileId, one: f64, other: f64) -> Option<Gap> {
        let tile = &self.world.tiles()[usize::from(tile)];
        tile.gaps().find(|gap| gap.holds(one) && gap.holds(other))
    }

    /// Whether the leaf of a door or a shape in the cell hides the line.
    fn is_hidden_by_what_stands(
        &self,
        walk: &RayWalk,
        (cell, TileId(tile)): (Cell, TileId),
    ) -> bool {
        let tile = &self.world.tiles()[usize::from(tile)];
        if !matches!(tile.kind, TileKind::Door(_) | TileKind::Shape(_)) {
            return false;
        }
        let passage = walk.standing(self.world, cell, tile.kind);
        let top = tile.top_of_what_stands();
        let ts = [passage.hit.map(|hit| hit.t), passage.end];
        ts.into_iter().flatten().any(|t| t <= 1.0 && self.height_at(t) <= top)
    }
}

#[cfg(test)]
mod tests;
