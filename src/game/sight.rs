//! Lines of sight between two points at given heights.
//!
//! The walk follows a line through the cells in the exact order in which the line enters them. In
//! each cell the line has to stay in one gap between a floor and a ceiling. The leaf of a door or a
//! shape hides one end from the other if the line meets it, by an exact predicate ([`Segment`]).
//! Glass and masks hide nothing. Smoke hides everything inside and behind it.
//!
//! Rejected: the rays of the casters. They end at the first solid cell whatever its height, and do
//! not know where the line ends.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::Game;
use super::guards::GuardView;
use crate::cast::{Ray, RayWalk, Segment};
use crate::world::{Cell, Gap, TileId, World};

/// A position and a height, in cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    pub(crate) position: DVec2,
    pub(crate) height: f64,
}

/// The floor that a guard looks at, as rays that end at the first obstacle.
///
/// The rays end where the middle of a player who stands as high as the guard would be hidden.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SightCone {
    position: DVec2,
    /// A unit vector.
    direction: DVec2,
    /// Half the angle of the cone, in radians.
    half_angle: f64,
    /// The lengths of the rays in cells, at equal angles from left to right.
    reaches: [f64; SightCone::RAYS],
}

impl SightCone {
    const RAYS: usize = 16;
    /// The height of the middle of a player, in cells.
    const MIDDLE: f64 = 0.35;

    /// The place of the guard, in cells.
    pub fn position(&self) -> DVec2 {
        self.position
    }

    /// Whether the guard looks at the floor at `point`, however dark it is there.
    pub fn contains(&self, point: DVec2) -> bool {
        let way = point - self.position;
        let (along, across) = (way.dot(self.direction), way.dot(self.direction.perp()));
        let share = libm::atan2(across, along) / self.half_angle;
        let ray = f64::midpoint(share, 1.0) * Self::RAYS as f64;
        let reach = self.reaches.get(ray as usize).filter(|_| ray >= 0.0);
        reach.is_some_and(|reach| way.length_squared() <= reach * reach)
    }
}

impl Game {
    /// The floor that `guard` looks at; `None` if the guard is blind, sleeps or lies on the floor.
    pub fn sight_cone(&self, guard: &GuardView) -> Option<SightCone> {
        let (range, least_cosine) = guard.sight()?;
        let (position, direction) = (guard.position, guard.heading.direction());
        let half_angle = libm::acos(least_cosine);
        let from = guard.eye();
        let reaches = std::array::from_fn(|ray| {
            let share = (2 * ray + 1) as f64 / SightCone::RAYS as f64 - 1.0;
            let (sine, cosine) = libm::sincos(share * half_angle);
            let end = position + direction.rotate(DVec2::new(cosine, sine)) * range;
            let to = Point { position: end, height: guard.feet + SightCone::MIDDLE };
            let line = SightLine { world: &self.world, from, to };
            let smoke = self.smoke.clouds.iter().filter_map(|cloud| cloud.nearest(position, end));
            smoke.fold(line.free_part(), f64::min) * range
        });
        Some(SightCone { position, direction, half_angle, reaches })
    }
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
        && SightLine { world, from, to }.free_part() >= 1.0
}

impl Cloud {
    /// Whether the line from `from` to `to` meets this smoke.
    fn hides(&self, from: DVec2, to: DVec2) -> bool {
        self.nearest(from, to).is_some()
    }

    /// The fraction of the line from `from` to `to` at which it is nearest to the middle of this
    /// smoke; `None` if it does not meet the smoke.
    fn nearest(&self, from: DVec2, to: DVec2) -> Option<f64> {
        let (way, offset) = (to - from, self.position - from);
        let length_squared = way.length_squared();
        let along = if length_squared > 0.0 { offset.dot(way) / length_squared } else { 0.0 };
        let along = along.clamp(0.0, 1.0);
        let nearest = way * along;
        (nearest.distance_squared(offset) < self.radius * self.radius).then_some(along)
    }
}

struct SightLine<'a> {
    world: &'a World,
    from: Point,
    to: Point,
}

/// The walk may miss a cell that the line touches at this distance, in cells, from a corner.
const NEAR: f64 = 1e-9;

impl SightLine<'_> {
    /// The fraction of the line up to the cell in which it is hidden; 1 if it is free.
    fn free_part(&self) -> f64 {
        let grid = self.world.grid();
        let (from, to) = (self.from.position, self.to.position);
        if self.meets_what_stands_around(from) {
            return 0.0;
        }
        let Ok(ray) = Ray::new(from, to - from) else {
            return if self.is_in_one_gap() { 1.0 } else { 0.0 };
        };
        let mut walk = RayWalk::new(grid, &ray);
        let Some(mut position) = walk.cell(grid) else { return 0.0 };
        let (mut height, mut entered) = (self.from.height, 0.0);
        loop {
            let crossed = walk.cross(grid);
            let (end, along) = walk.meeting(&crossed);
            let end = end.clamp(0.0, 1.0);
            let is_last = end >= 1.0 || crossed.into.is_none();
            let next = if is_last { self.to.height } else { self.height_at(end) };
            if self.gap_with(position.1, height, next).is_none() {
                return entered;
            }
            height = next;
            let Some(into) = crossed.into.filter(|_| !is_last) else {
                return if self.meets_what_stands_around(to) { entered } else { end };
            };
            let is_hidden = if (NEAR..1.0 - NEAR).contains(&along) {
                self.meets_what_stands(into)
            } else {
                self.meets_what_stands_around(ray.at(end))
            };
            (position, entered) = (into, end);
            if is_hidden {
                return entered;
            }
        }
    }

    /// Whether the line is free, for two points above each other.
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

    /// Whether the line meets the leaf of a door or a shape in a cell that contains or touches `point`.
    fn meets_what_stands_around(&self, point: DVec2) -> bool {
        let [columns, rows] = [point.x, point.y]
            .map(|place| (place - NEAR).floor() as i64..=(place + NEAR).floor() as i64);
        let mut cells = rows.flat_map(|row| columns.clone().map(move |column| (column, row)));
        cells.any(|(column, row)| {
            let cell = self.world.grid().cell(column, row);
            cell.is_some_and(|it| self.meets_what_stands(it))
        })
    }

    /// Whether the line meets the leaf of a door or a shape in the cell.
    fn meets_what_stands(&self, (cell, TileId(tile)): (Cell, TileId)) -> bool {
        let ends = [self.from.position, self.to.position];
        let segment = Segment { ends, heights: [self.from.height, self.to.height] };
        segment.meets(self.world, cell, &self.world.tiles()[usize::from(tile)])
    }
}

#[cfg(test)]
mod tests;
