//! Ray marching: constant steps, with a test of the cell after each step.
//!
//! The wall is found at the first step that ends inside it, up to one step behind its face. If the
//! ray crosses a wall for less than a step, it can miss the wall. The lines between the last two
//! steps determine the face.
//!
//! Source: the method against which Lode Vandevenne, "Raycasting", warns before presenting another,
//! and which most first raycasters use.

use glam::DVec2;

use super::clipped_ray::ClippedRay;
use cellcaster::cast::first_line;
use cellcaster::cast::{Caster, Hit, Ray, Side};
use cellcaster::world::{Cell, Grid};

/// Casts by steps of constant length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct March {
    /// The length of a step in cells, from 0.0001 to 1.
    pub(crate) step: f64,
}

impl Caster for March {
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        let clipped = ClippedRay::new(grid, ray)?;
        let (origin, direction) = (clipped.ray.origin(), clipped.ray.direction());
        let size = DVec2::new(f64::from(grid.width()), f64::from(grid.height()));
        let length = direction.length();
        let stride = direction / length * self.step;
        let mut place = origin;
        let mut cell = DVec2::new(
            cell_before(origin.x, direction.x, grid.width()),
            cell_before(origin.y, direction.y, grid.height()),
        );
        let mut steps = 0_u64;
        loop {
            let entered = place.floor();
            if entered != cell {
                let (column, row) = (entered.x as i64, entered.y as i64);
                if grid.is_solid(column, row) {
                    let side = side_crossed(cell, entered, place, stride);
                    let cell = Cell { column: column as u32, row: row as u32 };
                    let distance = steps as f64 * self.step / length;
                    return Some(clipped.hit_at(cell, side, distance));
                }
                if has_left(entered.x, stride.x, size.x) || has_left(entered.y, stride.y, size.y) {
                    return None;
                }
                cell = entered;
            }
            place += stride;
            steps += 1;
        }
    }
}

/// The column or row from which a ray starts. On a line, it is the one before the line.
fn cell_before(origin: f64, direction: f64, count: u32) -> f64 {
    if direction > 0.0 { first_line(origin, direction, count) - 1.0 } else { origin.floor() }
}

/// Returns whether a column or row is off the map, and stays off it.
fn has_left(index: f64, stride: f64, count: f64) -> bool {
    if stride > 0.0 { index >= count } else { index < 0.0 }
}

/// The kind of the last line between two positions that are a step apart.
fn side_crossed(from: DVec2, to: DVec2, place: DVec2, stride: DVec2) -> Side {
    let since = |from: f64, to: f64, place: f64, stride: f64| {
        if from == to {
            return f64::INFINITY;
        }
        let line = if stride > 0.0 { to } else { to + 1.0 };
        ((place - line) / stride).abs()
    };
    let since_x = since(from.x, to.x, place.x, stride.x);
    let since_y = since(from.y, to.y, place.y, stride.y);
    if since_x <= since_y { Side::X } else { Side::Y }
}
