//! The DDA in fixed point: integer arithmetic, once the ray is converted.
//!
//! Origin and direction are rounded to a number of fractional bits. The ray then goes from border
//! to border of its cells with integer products and quotients. Quotients are rounded down, so that
//! the ray could reach the border of the other axis too early; a guard keeps it one unit away from
//! that border.
//!
//! Source: the example program of drummyfish's LRS article on raycasting, with 10 bits and the same
//! guard. That program mirrors rays to the west or the north. Here the distance to the next border
//! is stored instead of the position in the cell, which needs no mirror and is also correct on a
//! border. As in the source, a component that rounds to zero becomes one unit; a component of zero
//! stays zero.

use super::clipped_ray::ClippedRay;
use cellcaster::cast::first_line;
use cellcaster::cast::{Caster, Hit, Order, Ray, Side, Walk};
use cellcaster::world::Grid;

/// Casts by a DDA in integers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fixed {
    /// The number of fractional bits, from 4 to 26.
    pub(crate) fraction_bits: u32,
}

impl Fixed {
    /// The value of 1, in units.
    fn unit(self) -> i64 {
        1 << self.fraction_bits
    }
}

impl Caster for Fixed {
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        let clipped = ClippedRay::new(grid, ray)?;
        let mut walk = Walk::in_order(grid, &clipped.ray, Integers::new(*self, &clipped.ray));
        let wall = walk.first_solid()?;
        let order = walk.order();
        let unit = self.unit() as f64;
        let (other, other_component) = match wall.side {
            Side::X => (&order.y, clipped.ray.direction().y),
            Side::Y => (&order.x, clipped.ray.direction().x),
        };
        let left = other.ahead as f64 / unit;
        let along = if other_component < 0.0 { left } else { 1.0 - left };
        let distance = order.distance() as f64 / unit;
        Some(clipped.hit(wall.cell, wall.side, distance, along))
    }
}

/// The order of lines by integers.
#[derive(Clone, Debug)]
struct Integers {
    unit: i64,
    x: Progress,
    y: Progress,
}

impl Integers {
    fn new(fixed: Fixed, ray: &Ray) -> Self {
        let (origin, direction) = (ray.origin(), ray.direction());
        let unit = fixed.unit();
        Self {
            unit,
            x: Progress::new(origin.x, direction.x, unit),
            y: Progress::new(origin.y, direction.y, unit),
        }
    }

    /// The distance of the ray from its origin in lengths of its direction, computed along the axis
    /// of the larger component.
    fn distance(&self) -> i128 {
        let axis = if self.x.speed >= self.y.speed { &self.x } else { &self.y };
        i128::from(axis.travelled) * i128::from(self.unit) / i128::from(axis.speed)
    }
}

impl Order for Integers {
    fn next(&mut self, _: f64, _: f64) -> Side {
        if self.y.ahead * self.x.speed <= self.x.ahead * self.y.speed {
            self.y.cross(&mut self.x, self.unit);
            Side::Y
        } else {
            self.x.cross(&mut self.y, self.unit);
            Side::X
        }
    }
}

/// The progress of a ray along one axis, in units.
#[derive(Clone, Debug)]
struct Progress {
    /// The size of the direction's component. At least one of the two components is 1/2 or more.
    speed: i64,
    /// The distance to the next border; at most 1.
    ahead: i64,
    /// The distance from the origin.
    travelled: i64,
}

impl Progress {
    fn new(origin: f64, direction: f64, unit: i64) -> Self {
        let place = (origin * unit as f64).floor() as i64;
        let ahead = if direction == 0.0 {
            unit - place % unit
        } else {
            // The map's edge does not matter here: the ray does not start beyond it.
            let line = first_line(origin, direction, u32::MAX) as i64 * unit;
            (line - place).abs()
        };
        let speed = (direction.abs() * unit as f64).round() as i64;
        let speed = if direction == 0.0 { 0 } else { speed.max(1) };
        Self { speed, ahead, travelled: 0 }
    }

    /// Moves to the next border of this axis, and moves the other axis by the corresponding
    /// distance.
    fn cross(&mut self, other: &mut Self, unit: i64) {
        let rounded = other.speed * self.ahead / self.speed;
        let guarded = rounded.min(other.ahead - 1).max(0);
        other.ahead -= guarded;
        other.travelled += guarded;
        self.travelled += self.ahead;
        self.ahead = unit;
    }
}
