//! Casters that go from line to line: the DDA in double and single precision, by a running sum, and in fixed point.

use glam::{DVec2, Vec2};

use super::clipped_ray::ClippedRay;
use cellcaster::cast::{Caster, Hit, Order, Ray, RoundedOrder, Side, Walk, first_line};
use cellcaster::world::Grid;

// The DDA: from line to line, in double precision.
//
// It takes the lines in [`RoundedOrder`], which the exact caster uses first; here the order is not
// checked.
//
// Source: the digital differential analyser of Lode Vandevenne, "Raycasting", in its older form,
// whose distance is computed from the cell (in "Raycasting II"); after Amanatides and Woo, "A Fast
// Voxel Traversal Algorithm" (1987).

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
// Lines, distances and the texture coordinate have 24 bits. Other programs choose single precision
// for half the memory and twice the SIMD lanes. Casting one ray at a time benefits from neither;
// this method shows how much accuracy single precision would cost.
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

// The running sum: the distance to the next line of each kind grows by a constant at every
// crossing.
//
// Each line costs one addition, and the distance of a hit is known when the ray stops. But each
// addition rounds, and the errors accumulate: after many lines, the smaller sum may not belong to
// the nearer line.
//
// Source: Lode Vandevenne, "Raycasting", in its newer form (`sideDist += deltaDist`), and its
// edition with Chinese annotations. They subtract the last addition again; here the previous sum is
// kept, which gives the same result without rounding.

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
            // A distance of zero takes no time, whatever the speed.
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

// The DDA in fixed point: integer arithmetic, once the ray is converted.
//
// Origin and direction are rounded to a number of fractional bits. The ray then goes from border to
// border of its cells with integer products and quotients. Quotients are rounded down, so the ray
// could reach the border of the other axis too early. A guard keeps it one unit away from that
// border.
//
// Source: the example program of drummyfish's LRS article on raycasting, with 10 bits and the same
// guard. That program mirrors rays to the west or the north. Here the distance to the next border
// is stored instead of the position in the cell, which needs no mirroring and is also correct on a
// border. As in the source, a component that rounds to zero becomes one unit; a component of zero
// stays zero.

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
    /// with the larger component.
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
    /// The absolute value of the direction's component. At least one of the two components is 1/2
    /// or more.
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
            // The map's edge does not matter here, because the ray does not start beyond it.
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
    fn straight_rays_hit_the_wall_ahead() {
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
    fn rays_from_outside_hit_the_map_or_nothing() {
        assert_eq!(cast(&ROOM, (-7.0, 1.5), (2.0, 0.0)), Some(hit(0, 1, Side::X, 3.5, 0.5)));
        assert_eq!(cast(&ROOM, (-1e15, 1.5), (1.0, 0.0)), Some(hit(0, 1, Side::X, 1e15, 0.5)));
        assert_eq!(cast(&ROOM, (9.0, 9.5), (-1.0, -1.0)), Some(hit(2, 2, Side::Y, 6.5, 0.5)));
        assert_eq!(cast(&ROOM, (-7.0, 1.5), (-1.0, 0.0)), None);
        assert_eq!(cast(&ROOM, (1e300, 1e300), (1.0, -1.0)), None);
        assert_eq!(cast(&ROOM, (5.0, 1.0), (0.0, 1.0)), None);
        assert_eq!(cast(&["..", ".."], (0.5, 0.5), (0.3, 0.4)), None);
    }

    #[test]
    fn tiny_directions_are_valid() {
        let t = 0.5 / 1e-300;
        assert_eq!(cast(&ROOM, (1.5, 1.5), (1e-300, 0.0)), Some(hit(2, 1, Side::X, t, 0.5)));
        let subnormal = cast(&ROOM, (1.5, 1.5), (5e-324, 0.0)).unwrap();
        assert_eq!((subnormal.cell, subnormal.side), (Cell { column: 2, row: 1 }, Side::X));
        assert_eq!(cast(&ROOM, (1.5, 1.5), (1.0, 5e-324)), Some(hit(2, 1, Side::X, 0.5, 0.5)));
    }

    proptest! {
        /// The distance and the position on the face match the point where the ray meets the line.
        #[test]
        fn a_hit_lies_on_its_face(
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
