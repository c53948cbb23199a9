//! The running sum: the distance to the next line of each kind grows by a constant at every
//! crossing.
//!
//! Each line costs one addition, and the distance of a hit is known when the ray stops. But each
//! addition rounds, and the errors accumulate: after many lines, the smaller sum need not be the
//! nearer line.
//!
//! Source: Lode Vandevenne, "Raycasting", in its newer form (`sideDist += deltaDist`), and its
//! edition with Chinese annotations. There the last addition is subtracted again; here the previous
//! sum is kept, which is the same without a rounding.

use glam::DVec2;

use super::clipped_ray::ClippedRay;
use cellcaster::cast::first_line;
use cellcaster::cast::{Caster, Hit, Order, Ray, Side, Walk};
use cellcaster::world::Grid;

/// Casts by adding up the distances between lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Accumulate;

impl Caster for Accumulate {
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        let clipped = ClippedRay::new(grid, ray)?;
        let mut walk = Walk::in_order(grid, &clipped.ray, Sums::new(grid, &clipped.ray));
        let wall = walk.first_solid()?;
        Some(clipped.hit_at(wall.cell, wall.side, walk.order().crossed))
    }
}

/// The order of lines by sums of distances.
#[derive(Clone, Debug)]
struct Sums {
    /// The distances to the next lines.
    next: DVec2,
    /// The distances between lines of the same kind.
    between: DVec2,
    /// The distance to the line crossed last.
    crossed: f64,
}

impl Sums {
    fn new(grid: &Grid, ray: &Ray) -> Self {
        let between = ray.direction().abs().recip();
        let first = |origin: f64, direction: f64, between: f64, count: u32| {
            let way = (first_line(origin, direction, count) - origin).abs();
            // A distance of zero takes no time at any speed, not even at zero.
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
