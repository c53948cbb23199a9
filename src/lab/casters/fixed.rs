//! The walk in fixed point: integers only, once the ray is one.
//!
//! Origin and direction are rounded to so many bits after the point, and from there on the ray goes
//! from border to border of its cells with integer products and quotients. A quotient is rounded
//! down, and can still reach a border that the ray has yet to come to; the guard keeps it one unit
//! short of it.
//!
//! Source: the example program of drummyfish's LRS article on raycasting, which has 10 bits, and its
//! guard. It mirrors a ray that goes west or north; here the way to the next border is kept instead
//! of the place in the cell, which needs no mirror and is right on a border too. A component that
//! rounds to zero is one unit, as there; one that is zero stays zero.

use std::ops::RangeInclusive;

use super::approach::Approach;
use crate::cast::first_line;
use crate::cast::{Caster, Hit, Order, Ray, Side, Walk};
use crate::world::Grid;

/// Casts by walking the grid in integers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fixed {
    fraction_bits: u32,
}

impl Fixed {
    /// How many bits there can be after the point.
    pub const FRACTION_BITS: RangeInclusive<u32> = 4..=26;

    /// With so many bits after the point; `None` out of range.
    pub fn new(fraction_bits: u32) -> Option<Self> {
        Self::FRACTION_BITS.contains(&fraction_bits).then_some(Self { fraction_bits })
    }

    /// How many bits there are after the point.
    pub fn fraction_bits(self) -> u32 {
        self.fraction_bits
    }

    /// What 1 is.
    fn unit(self) -> i64 {
        1 << self.fraction_bits
    }
}

impl Default for Fixed {
    /// As in the document: 10 bits.
    fn default() -> Self {
        Self { fraction_bits: 10 }
    }
}

impl Caster for Fixed {
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        let approach = Approach::new(grid, ray)?;
        let mut walk = Walk::in_order(grid, &approach.ray, Integers::new(*self, &approach.ray));
        let wall = walk.first_solid()?;
        let order = walk.order();
        let unit = self.unit() as f64;
        let (other, other_component) = match wall.side {
            Side::X => (&order.y, approach.ray.direction().y),
            Side::Y => (&order.x, approach.ray.direction().x),
        };
        let left = other.ahead as f64 / unit;
        let along = if other_component < 0.0 { left } else { 1.0 - left };
        let distance = order.distance() as f64 / unit;
        Some(approach.hit(wall.cell, wall.side, distance, along))
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

    /// How far the ray is from its origin in lengths of its direction, by the axis that it moves
    /// faster on.
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

/// How a ray gets on along one axis, in units.
#[derive(Clone, Debug)]
struct Progress {
    /// The size of the direction's component; for one of the two, at least half of 1.
    speed: i64,
    /// How far the next border is; at most 1.
    ahead: i64,
    /// How far it is from the origin.
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

    /// Goes to the next border of this axis, and as far as that takes it on the other one.
    fn cross(&mut self, other: &mut Self, unit: i64) {
        let rounded = other.speed * self.ahead / self.speed;
        let guarded = rounded.min(other.ahead - 1).max(0);
        other.ahead -= guarded;
        other.travelled += guarded;
        self.travelled += self.ahead;
        self.ahead = unit;
    }
}
