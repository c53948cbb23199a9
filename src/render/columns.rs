//! The first pass: one ray for every column of pixels.

use std::ops::Range;

use glam::DVec2;

use super::Projection;
use super::see_through::Passed;
use crate::cast::{Caster, Hit, Ray, Side};
use crate::world::{Grid, World};

/// What the ray of one column of pixels met.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// What it hit, or `None` where it left the map.
    pub hit: Option<Hit>,
    /// How far it got, in cells from the camera plane: to the wall, or to the edge of the map.
    pub distance: f64,
    /// The rows of pixels between ceiling and floor at that distance: the wall or, beyond the edge
    /// of the map, the sky and the ground.
    pub rows: Range<u32>,
}

/// What a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// The ceiling.
    Ceiling,
    /// The sky beyond the edge of the map.
    Sky,
    /// A wall's west or east side.
    WallX,
    /// A wall's north or south side.
    WallY,
    /// The floor.
    Floor,
    /// Something that stands before all that.
    Thing,
}

impl Column {
    /// What the pixel in `row` of this column shows, where the ground begins in row `ground`.
    pub(super) fn surface(&self, row: u32, ground: u32) -> Surface {
        if row < self.rows.start {
            return Surface::Ceiling;
        }
        if row >= self.rows.end {
            return Surface::Floor;
        }
        match &self.hit {
            Some(Hit { side: Side::X, .. }) => Surface::WallX,
            Some(Hit { side: Side::Y, .. }) => Surface::WallY,
            None if row < ground => Surface::Sky,
            None => Surface::Floor,
        }
    }

    /// How many rows, from the top, show the ceiling, where the ground begins in row `ground`.
    pub(super) fn rows_of_ceiling(&self, ground: u32) -> u32 {
        self.rows.start.min(ground)
    }

    /// How many rows, from the bottom of a frame `height` pixels high, show the floor.
    pub(super) fn rows_of_floor(&self, ground: u32, height: u32) -> u32 {
        height
            - match self.hit {
                Some(_) => self.rows.end.max(ground),
                None => ground,
            }
    }
}

/// Casts the ray of every column into `columns`, and what it passes into `passed`, whatever they
/// held before.
pub(super) fn cast<C: Caster>(
    caster: &C,
    world: &World,
    projection: &Projection,
    columns: &mut Vec<Column>,
    passed: &mut Passed,
) {
    let grid = world.grid();
    columns.clear();
    passed.clear();
    let column = |ray: Ray, hit: Option<Hit>| {
        let distance = hit.map_or_else(|| distance_to_edge(grid, &ray), |hit| hit.t);
        Column { hit, distance, rows: projection.wall_rows(distance) }
    };
    if world.is_of_walls() {
        columns.extend(projection.rays().map(|ray| column(ray, caster.cast(grid, &ray))));
    } else {
        passed.make_room_for(projection.columns());
        columns.extend(projection.rays().enumerate().map(|(index, ray)| {
            column(ray, caster.cast_through(world, &ray, |hit| passed.push(index, hit)))
        }));
    }
}

/// How far along `ray` the map ends; 0 where the ray is off the map and never enters it.
fn distance_to_edge(grid: &Grid, ray: &Ray) -> f64 {
    let edges = DVec2::new(f64::from(grid.width()), f64::from(grid.height()));
    let along = |origin: f64, direction: f64, edge: f64| {
        if direction > 0.0 {
            (edge - origin) / direction
        } else if direction < 0.0 {
            origin / -direction
        } else {
            f64::INFINITY
        }
    };
    let (origin, direction) = (ray.origin(), ray.direction());
    let leaves = along(origin.x, direction.x, edges.x).min(along(origin.y, direction.y, edges.y));
    leaves.max(0.0)
}
