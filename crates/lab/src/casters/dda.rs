//! The DDA: from line to line, in double precision.
//!
//! The order of the lines is that of [`RoundedOrder`], with which the exact caster begins; here it
//! is not checked.
//!
//! Source: the digital differential analyser of Lode Vandevenne, "Raycasting", in its older form,
//! whose distance is computed from the cell (in "Raycasting II"); after Amanatides and Woo, "A Fast
//! Voxel Traversal Algorithm" (1987).

use glam::{DVec2, Vec2};

use super::clipped_ray::ClippedRay;
use cellcaster::cast::{Caster, Hit, Order, Ray, RoundedOrder, Side, Walk};
use cellcaster::world::Grid;

/// Casts by a DDA in double precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dda;

impl Caster for Dda {
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        let wall = Walk::in_order(grid, ray, RoundedOrder::new(ray)).first_solid()?;
        Some(Hit::entering(ray, wall.cell, wall.side))
    }
}

// The same in single precision.
//
// Lines, distances and the texture coordinate have 24 bits. Single precision is chosen elsewhere
// for half the memory and twice the SIMD lanes. Casting one ray at a time uses neither; this
// method shows what single precision would cost in accuracy.
//
// Source: as above, with `float` instead of `double`.

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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use cellcaster::world::Cell;

    fn cast(rows: &[&str], origin: (f64, f64), direction: (f64, f64)) -> Option<Hit> {
        let grid = Grid::sketch(rows).unwrap();
        let ray = Ray::new(DVec2::from(origin), DVec2::from(direction)).unwrap();
        Dda.cast(&grid, &ray)
    }

    fn hit(column: u32, row: u32, side: Side, t: f64, u: f64) -> Hit {
        Hit { cell: Cell { column, row }, side, t, u }
    }

    const ROOM: [&str; 3] = ["###", "#.#", "###"];

    #[test]
    fn straight_ahead() {
        assert_eq!(cast(&ROOM, (1.5, 1.25), (1.0, 0.0)), Some(hit(2, 1, Side::X, 0.5, 0.25)));
        assert_eq!(cast(&ROOM, (1.5, 1.25), (-1.0, 0.0)), Some(hit(0, 1, Side::X, 0.5, 0.75)));
        assert_eq!(cast(&ROOM, (1.25, 1.5), (0.0, 1.0)), Some(hit(1, 2, Side::Y, 0.5, 0.75)));
        assert_eq!(cast(&ROOM, (1.25, 1.5), (-0.0, -2.0)), Some(hit(1, 0, Side::Y, 0.25, 0.25)));
    }

    #[test]
    fn the_y_line_is_crossed_first_at_a_corner() {
        assert_eq!(cast(&ROOM, (1.5, 1.5), (1.0, 1.0)), Some(hit(1, 2, Side::Y, 0.5, 0.0)));
        assert_eq!(cast(&ROOM, (1.5, 1.5), (-3.0, -3.0)), Some(hit(1, 0, Side::Y, 0.5 / 3.0, 0.0)));
        let diagonal = ["..#", ".#.", "..."];
        assert_eq!(cast(&diagonal, (0.0, 0.5), (2.0, 1.0)), Some(hit(1, 1, Side::X, 0.5, 0.0)));
    }

    #[test]
    fn a_start_on_a_line_crosses_it() {
        assert_eq!(cast(&ROOM, (2.0, 1.5), (1.0, 0.0)), Some(hit(2, 1, Side::X, 0.0, 0.5)));
        assert_eq!(cast(&ROOM, (1.0, 1.5), (-1.0, 0.0)), Some(hit(0, 1, Side::X, 0.0, 0.5)));
        let wall_below = ["..", "##"];
        assert_eq!(cast(&wall_below, (0.5, 1.0), (1.0, 0.0)), Some(hit(1, 1, Side::X, 0.5, 0.0)));
    }

    #[test]
    fn a_start_inside_a_wall_hits_the_next_one() {
        assert_eq!(cast(&ROOM, (0.5, 1.5), (1.0, 0.0)), Some(hit(2, 1, Side::X, 1.5, 0.5)));
        assert_eq!(cast(&ROOM, (0.5, 0.5), (1.0, 0.0)), Some(hit(1, 0, Side::X, 0.5, 0.5)));
    }

    #[test]
    fn off_the_map() {
        assert_eq!(cast(&ROOM, (-7.0, 1.5), (2.0, 0.0)), Some(hit(0, 1, Side::X, 3.5, 0.5)));
        assert_eq!(cast(&ROOM, (-1e15, 1.5), (1.0, 0.0)), Some(hit(0, 1, Side::X, 1e15, 0.5)));
        assert_eq!(cast(&ROOM, (9.0, 9.5), (-1.0, -1.0)), Some(hit(2, 2, Side::Y, 6.5, 0.5)));
        assert_eq!(cast(&ROOM, (-7.0, 1.5), (-1.0, 0.0)), None);
        assert_eq!(cast(&ROOM, (1e300, 1e300), (1.0, -1.0)), None);
        assert_eq!(cast(&ROOM, (5.0, 1.0), (0.0, 1.0)), None);
        assert_eq!(cast(&["..", ".."], (0.5, 0.5), (0.3, 0.4)), None);
    }

    #[test]
    fn tiny_directions_are_directions() {
        let t = 0.5 / 1e-300;
        assert_eq!(cast(&ROOM, (1.5, 1.5), (1e-300, 0.0)), Some(hit(2, 1, Side::X, t, 0.5)));
        let subnormal = cast(&ROOM, (1.5, 1.5), (5e-324, 0.0)).unwrap();
        assert_eq!((subnormal.cell, subnormal.side), (Cell { column: 2, row: 1 }, Side::X));
        assert_eq!(cast(&ROOM, (1.5, 1.5), (1.0, 5e-324)), Some(hit(2, 1, Side::X, 0.5, 0.5)));
    }

    proptest! {
        /// The distance and the position on the face are where the ray meets the line.
        #[test]
        fn a_hit_is_on_its_face(
            origin in (1.0..6.0, 1.0..4.0),
            direction in (-1.0..1.0, -1.0..1.0),
        ) {
            let rows = ["#######", "#.....#", "#..#..#", "#.....#", "#######"];
            let grid = Grid::sketch(&rows).unwrap();
            let ray = Ray::new(DVec2::from(origin), DVec2::from(direction));
            prop_assume!(ray.is_ok());
            let ray = ray.unwrap();
            let hit = Dda.cast(&grid, &ray).expect("the room is closed");
            let point = ray.at(hit.t);
            let (across, along) = match hit.side {
                Side::X => (point.x - f64::from(hit.cell.column), point.y - f64::from(hit.cell.row)),
                Side::Y => (point.y - f64::from(hit.cell.row), point.x - f64::from(hit.cell.column)),
            };
            prop_assert!(across.abs() < 1e-12 || (across - 1.0).abs() < 1e-12);
            prop_assert!((along - hit.u).abs() < 1e-12 || (1.0 - along - hit.u).abs() < 1e-12);
        }
    }
}
