//! The running sum: to each kind of line a distance that grows by the same amount at every crossing.
//!
//! One addition a line, and the distance of a hit is there when the walk ends. But each addition
//! rounds, and the roundings add up: after many lines the smaller sum need not be the nearer line.
//!
//! Source: Lode Vandevenne's "Raycasting", in its newer form (`sideDist += deltaDist`), and its
//! Chinese-annotated edition. There the last addition is subtracted again; here the sum is kept as
//! it was before, which is the same without a rounding.

use glam::DVec2;

use super::approach::Approach;
use crate::cast::first_line;
use crate::cast::{Caster, Hit, Order, Ray, Side, Walk};
use crate::world::Grid;

/// Casts by adding up the distances between lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Accumulate;

impl Caster for Accumulate {
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        let approach = Approach::new(grid, ray)?;
        let mut walk = Walk::in_order(grid, &approach.ray, Sums::new(grid, &approach.ray));
        let wall = walk.first_solid()?;
        Some(approach.hit_at(wall.cell, wall.side, walk.order().crossed))
    }
}

/// The order of lines by sums of distances.
#[derive(Clone, Debug)]
struct Sums {
    /// How far the next lines are.
    next: DVec2,
    /// How far it is from one line to the next of its kind.
    between: DVec2,
    /// How far the line is that was crossed last.
    crossed: f64,
}

impl Sums {
    fn new(grid: &Grid, ray: &Ray) -> Self {
        let between = ray.direction().abs().recip();
        let first = |origin: f64, direction: f64, between: f64, count: u32| {
            let way = (first_line(origin, direction, count) - origin).abs();
            // Where there is nothing to go, it takes no time even at no speed.
            if way == 0.0 { 0.0 } else { way * between }
        };
        let (origin, direction) = (ray.origin(), ray.direction());
        let next = DVec2::new(
            first(origin.x, direction.x, between.x, grid.width()),
            first(origin.y, direction.y, between.y, grid.height()),
        );
        Self { next, between, crossed: 0.0 }
    }
}

impl Order for Sums {
    fn next(&mut self, _: f64, _: f64) -> Side {
        if self.next.y <= self.next.x {
            self.crossed = self.next.y;
            self.next.y += self.between.y;
            Side::Y
        } else {
            self.crossed = self.next.x;
            self.next.x += self.between.x;
            Side::X
        }
    }
}
