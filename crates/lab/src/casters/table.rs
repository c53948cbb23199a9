//! Angle tables: rays along a fixed number of directions.
//!
//! The direction is rounded to the nearest angle of the table. The search follows the lines y =
//! const by the cotangent, from intersection to intersection, up to the border of a wall, and then
//! the lines x = const by the tangent. The nearer of the two walls is the hit. The result is a
//! length in cells. Dividing it by the length of the ray's direction gives `t`. A camera ray at the
//! angle β to the view is 1/cos β long, so this division is the multiplication by cos β that
//! corrects the fisheye distortion.
//!
//! Source: F. Permadi, "Ray-Casting Tutorial", with 1920 angles: 320 columns for 60°.

use std::f64::consts::TAU;

use glam::DVec2;

use super::clipped_ray::ClippedRay;
use cellcaster::cast::first_line;
use cellcaster::cast::{Caster, Hit, Ray, Side};
use cellcaster::world::{Cell, Grid};

/// Casts along the nearest angle of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct AngleTable {
    angles: Box<[Angle]>,
}

/// One entry of the tables.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Angle {
    cosine: f64,
    sine: f64,
    tangent: f64,
}

impl AngleTable {
    /// A caster with `count` angles in the circle, from 8 to 65536.
    pub(crate) fn new(count: u32) -> Self {
        Self { angles: (0..count).map(|index| Angle::new(index, count)).collect() }
    }

    /// The number of angles in the circle.
    pub(crate) fn angles(&self) -> usize {
        self.angles.len()
    }

    /// The entry nearest to a direction.
    fn nearest(&self, direction: DVec2) -> Angle {
        let count = self.angles.len();
        let turns = libm::atan2(direction.y, direction.x) / TAU;
        let index = (turns * count as f64).round() as i64;
        self.angles[index.rem_euclid(count as i64) as usize]
    }
}

impl Angle {
    fn new(index: u32, count: u32) -> Self {
        // The source has no entries for the axes; here they are exact.
        let (sine, cosine) = match (4 * index % count, 4 * index / count) {
            (0, 0) => (0.0, 1.0),
            (0, 1) => (1.0, 0.0),
            (0, 2) => (0.0, -1.0),
            (0, _) => (-1.0, 0.0),
            _ => libm::sincos(TAU * f64::from(index) / f64::from(count)),
        };
        Self { cosine, sine, tangent: sine / cosine }
    }
}

impl Caster for AngleTable {
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        let clipped = ClippedRay::new(grid, ray)?;
        let (origin, direction) = (clipped.ray.origin(), clipped.ray.direction());
        let Angle { cosine, sine, tangent } = self.nearest(direction);
        let (east, south) = (cosine, sine);
        let y = Search { start: origin.y, heading: south, other: origin.x, other_heading: east };
        let y = y.first_wall(1.0 / tangent, Side::Y, grid);
        let x = Search { start: origin.x, heading: east, other: origin.y, other_heading: south };
        let x = x.first_wall(tangent, Side::X, grid);
        let wall = match (x, y) {
            (Some(x), Some(y)) => {
                if y.length <= x.length {
                    y
                } else {
                    x
                }
            }
            (x, y) => x.or(y)?,
        };
        let distance = wall.length / direction.length();
        Some(clipped.hit(wall.cell, wall.side, distance, wall.along))
    }
}

/// A search for the nearest wall behind the lines of one kind.
#[derive(Clone, Copy, Debug)]
struct Search {
    /// The coordinate of the origin across the lines.
    start: f64,
    /// The cosine of the angle between the ray and the normal of the lines.
    heading: f64,
    /// The coordinate of the origin along the lines.
    other: f64,
    /// The sine of the same angle.
    other_heading: f64,
}

/// A wall found by a search.
#[derive(Clone, Copy, Debug)]
struct Wall {
    cell: Cell,
    side: Side,
    /// The distance, in cells.
    length: f64,
    /// The position on the face, in cells from its north or west end.
    along: f64,
}

impl Search {
    /// The first wall, for a ray that moves by `slope` along the lines for each cell across them.
    fn first_wall(&self, slope: f64, side: Side, grid: &Grid) -> Option<Wall> {
        let (lines, breadth) = match side {
            Side::X => (grid.width(), grid.height()),
            Side::Y => (grid.height(), grid.width()),
        };
        if self.heading == 0.0 {
            return None;
        }
        let step = 1_f64.copysign(self.heading);
        let mut line = first_line(self.start, self.heading, lines);
        let mut other = self.other + (line - self.start) * slope;
        loop {
            let across = if step > 0.0 { line } else { line - 1.0 };
            let along = other.floor();
            let has_left =
                if self.other_heading > 0.0 { along >= f64::from(breadth) } else { along < 0.0 };
            if has_left || !(0.0..f64::from(lines)).contains(&across) {
                return None;
            }
            let (column, row) = match side {
                Side::X => (across, along),
                Side::Y => (along, across),
            };
            if grid.is_solid(column as i64, row as i64) {
                let cell = Cell { column: column as u32, row: row as u32 };
                let length = (line - self.start) / self.heading;
                return Some(Wall { cell, side, length, along: other - along });
            }
            line += step;
            other += step * slope;
        }
    }
}
