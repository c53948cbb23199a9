//! The DDA of `dda` in single precision.
//!
//! Lines, distances and the texture coordinate have 24 bits. Single precision is chosen elsewhere
//! for half the memory and twice the SIMD lanes. Casting one ray at a time uses neither; this
//! method shows what single precision would cost in accuracy.
//!
//! Source: as for `dda`, with `float` instead of `double`.

use glam::{DVec2, Vec2};

use super::clipped_ray::ClippedRay;
use cellcaster::cast::{Caster, Hit, Order, Ray, Side, Walk};
use cellcaster::world::Grid;

/// Casts by a DDA in single precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dda32;

impl Caster for Dda32 {
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        let clipped = ClippedRay::new(grid, ray)?;
        let mut walk = Walk::in_order(grid, &clipped.ray, Single::new(&clipped.ray));
        let wall = walk.first_solid()?;
        let Single { origin, direction, .. } = *walk.order();
        let far_side = |direction: f32| if direction < 0.0 { 1.0 } else { 0.0 };
        let cell = DVec2::new(f64::from(wall.cell.column), f64::from(wall.cell.row)).as_vec2();
        let offset = cell - origin;
        let (distance, along) = match wall.side {
            Side::X => {
                let distance = ratio(offset.x + far_side(direction.x), direction.x);
                (distance, distance * direction.y - offset.y)
            }
            Side::Y => {
                let distance = ratio(offset.y + far_side(direction.y), direction.y);
                (distance, distance * direction.x - offset.x)
            }
        };
        Some(clipped.hit(wall.cell, wall.side, distance.into(), along.into()))
    }
}

/// The quotient of the offset to a line and the direction; 0 for no offset, even if the direction
/// was rounded to 0.
fn ratio(way: f32, direction: f32) -> f32 {
    if way == 0.0 { 0.0 } else { (way / direction).abs() }
}

/// The order of lines by their distances in single precision.
#[derive(Clone, Debug)]
struct Single {
    origin: Vec2,
    direction: Vec2,
    /// For each axis, the size of the direction along the other axis, with the sign of this axis.
    weight: Vec2,
}

impl Single {
    fn new(ray: &Ray) -> Self {
        let (origin, direction) = (ray.origin().as_vec2(), ray.direction().as_vec2());
        let weight = |own: f64, other: f32| if own < 0.0 { -other.abs() } else { other.abs() };
        let weight = Vec2::new(
            weight(ray.direction().x, direction.y),
            weight(ray.direction().y, direction.x),
        );
        Self { origin, direction, weight }
    }
}

impl Order for Single {
    fn next(&mut self, x: f64, y: f64) -> Side {
        let to_x = (x as f32 - self.origin.x) * self.weight.x;
        let to_y = (y as f32 - self.origin.y) * self.weight.y;
        if to_y <= to_x { Side::Y } else { Side::X }
    }
}
