//! The grid walk: from line to line, in double precision.
//!
//! The ray meets the next x line at `(x - origin.x) / direction.x` and the next y line at
//! `(y - origin.y) / direction.y`. Only their order matters while walking, so both are multiplied by
//! `|direction.x · direction.y|`: two products are compared, nothing is divided, and a ray through a
//! corner compares equal. Both are computed from the index of the line; adding up a length from line
//! to line, as "sideDist += deltaDist" does, was refused because its error grows with the distance.
//!
//! Source: the digital differential analyser of Lode Vandevenne's "Raycasting", in its form whose
//! distance comes from the cell; after Amanatides and Woo, "A Fast Voxel Traversal Algorithm" (1987).

use super::{Caster, Hit, Ray, Side};
use crate::world::{Cell, Grid, TileId};

/// Casts by walking the grid in double precision.
#[derive(Clone, Copy, Debug, Default)]
pub struct Dda;

impl Caster for Dda {
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        let wall = Walk::new(grid, ray).find(|crossing| grid.is_solid_tile(crossing.tile))?;
        Some(Hit::entering(ray, wall.cell, wall.side))
    }
}

/// A cell that a ray enters, and the kind of line that it crosses to do so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crossing {
    /// The cell.
    pub cell: Cell,
    /// What it holds.
    pub tile: TileId,
    /// The kind of line that was crossed into it.
    pub side: Side,
}

/// The cells of a map that a ray enters, from near to far, open ones included.
///
/// It ends where the ray leaves the map. [`Hit::entering`] tells the distance of one of them.
#[derive(Clone, Debug)]
pub struct Walk<'grid> {
    grid: &'grid Grid,
    x: Axis,
    y: Axis,
}

impl<'grid> Walk<'grid> {
    /// The walk of `ray` through `grid`.
    pub fn new(grid: &'grid Grid, ray: &Ray) -> Self {
        let (origin, direction) = (ray.origin(), ray.direction());
        // Only the ratio of the two counts here. Their larger one is brought between 1 and 2, so
        // that no product of a length and a direction overflows or vanishes.
        let exponent = libm::ilogb(direction.abs().max_element());
        let scale = |component: f64| libm::scalbn(component.abs(), -exponent);
        Self {
            grid,
            x: Axis::new(origin.x, direction.x, scale(direction.y), grid.width()),
            y: Axis::new(origin.y, direction.y, scale(direction.x), grid.height()),
        }
    }
}

impl Iterator for Walk<'_> {
    type Item = Crossing;

    fn next(&mut self) -> Option<Crossing> {
        loop {
            let side = if self.y.next_line() <= self.x.next_line() { Side::Y } else { Side::X };
            let axis = match side {
                Side::X => &mut self.x,
                Side::Y => &mut self.y,
            };
            axis.cross();
            if axis.has_left() {
                return None;
            }
            let (column, row) = (self.x.index, self.y.index);
            if let Some(tile) = self.grid.tile(column, row) {
                let cell = Cell { column: column as u32, row: row as u32 };
                return Some(Crossing { cell, tile, side });
            }
        }
    }
}

/// A ray's progress along one axis of the grid.
#[derive(Clone, Debug)]
struct Axis {
    origin: f64,
    /// The column or row that the ray is in; off the map, any that it has yet to cross out of.
    index: i64,
    /// Where the next line is.
    line: f64,
    /// From one line to the next: 1, −1, or 0 where the ray never meets one.
    step: i64,
    /// `step` times the other axis's share of the direction.
    weight: f64,
    /// How many columns or rows the map has.
    count: i64,
}

impl Axis {
    fn new(origin: f64, direction: f64, other: f64, count: u32) -> Self {
        let count = i64::from(count);
        // A ray that is still off the map begins just before its edge: what it crosses until there
        // is nothing, however far away it starts.
        let (line, index, step) = if direction > 0.0 {
            let line = origin.ceil().max(0.0);
            (line, (line as i64).saturating_sub(1), 1)
        } else if direction < 0.0 {
            let line = origin.floor().min(count as f64);
            (line, line as i64, -1)
        } else {
            (f64::INFINITY, origin.floor() as i64, 0)
        };
        let weight = if step < 0 { -other } else { other };
        Self { origin, index, line, step, weight, count }
    }

    /// How far the next line is, in a measure that both axes share.
    fn next_line(&self) -> f64 {
        (self.line - self.origin) * self.weight
    }

    fn cross(&mut self) {
        self.index = self.index.saturating_add(self.step);
        self.line += self.step as f64;
    }

    /// Whether the ray is past the edge that it moves towards.
    fn has_left(&self) -> bool {
        if self.step > 0 { self.index >= self.count } else { self.index < 0 }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;
    use proptest::prelude::*;

    use super::super::NotARay;
    use super::*;

    fn cast(rows: &[&str], origin: (f64, f64), direction: (f64, f64)) -> Option<Hit> {
        let grid = Grid::sketch(rows).unwrap();
        let ray = Ray::new(DVec2::from(origin), DVec2::from(direction)).unwrap();
        Dda.cast(&grid, &ray)
    }

    #[expect(clippy::unnecessary_wraps, reason = "it is compared with what casting returns")]
    fn hit(column: u32, row: u32, side: Side, t: f64, u: f64) -> Option<Hit> {
        Some(Hit { cell: Cell { column, row }, side, t, u })
    }

    const ROOM: [&str; 3] = ["###", "#.#", "###"];

    #[test]
    fn straight_ahead() {
        assert_eq!(cast(&ROOM, (1.5, 1.25), (1.0, 0.0)), hit(2, 1, Side::X, 0.5, 0.25));
        assert_eq!(cast(&ROOM, (1.5, 1.25), (-1.0, 0.0)), hit(0, 1, Side::X, 0.5, 0.75));
        assert_eq!(cast(&ROOM, (1.25, 1.5), (0.0, 1.0)), hit(1, 2, Side::Y, 0.5, 0.75));
        assert_eq!(cast(&ROOM, (1.25, 1.5), (-0.0, -2.0)), hit(1, 0, Side::Y, 0.25, 0.25));
    }

    #[test]
    fn the_y_line_is_crossed_first_at_a_corner() {
        assert_eq!(cast(&ROOM, (1.5, 1.5), (1.0, 1.0)), hit(1, 2, Side::Y, 0.5, 0.0));
        assert_eq!(cast(&ROOM, (1.5, 1.5), (-3.0, -3.0)), hit(1, 0, Side::Y, 0.5 / 3.0, 0.0));
        let diagonal = ["..#", ".#.", "..."];
        assert_eq!(cast(&diagonal, (0.0, 0.5), (2.0, 1.0)), hit(1, 1, Side::X, 0.5, 0.0));
    }

    #[test]
    fn a_start_on_a_line_crosses_it() {
        assert_eq!(cast(&ROOM, (2.0, 1.5), (1.0, 0.0)), hit(2, 1, Side::X, 0.0, 0.5));
        assert_eq!(cast(&ROOM, (1.0, 1.5), (-1.0, 0.0)), hit(0, 1, Side::X, 0.0, 0.5));
        let wall_below = ["..", "##"];
        assert_eq!(cast(&wall_below, (0.5, 1.0), (1.0, 0.0)), hit(1, 1, Side::X, 0.5, 0.0));
    }

    #[test]
    fn a_start_inside_a_wall_hits_the_next_one() {
        assert_eq!(cast(&ROOM, (0.5, 1.5), (1.0, 0.0)), hit(2, 1, Side::X, 1.5, 0.5));
        assert_eq!(cast(&ROOM, (0.5, 0.5), (1.0, 0.0)), hit(1, 0, Side::X, 0.5, 0.5));
    }

    #[test]
    fn off_the_map() {
        assert_eq!(cast(&ROOM, (-7.0, 1.5), (2.0, 0.0)), hit(0, 1, Side::X, 3.5, 0.5));
        assert_eq!(cast(&ROOM, (-1e15, 1.5), (1.0, 0.0)), hit(0, 1, Side::X, 1e15, 0.5));
        assert_eq!(cast(&ROOM, (9.0, 9.5), (-1.0, -1.0)), hit(2, 2, Side::Y, 6.5, 0.5));
        assert_eq!(cast(&ROOM, (-7.0, 1.5), (-1.0, 0.0)), None);
        assert_eq!(cast(&ROOM, (1e300, 1e300), (1.0, -1.0)), None);
        assert_eq!(cast(&ROOM, (5.0, 1.0), (0.0, 1.0)), None);
        assert_eq!(cast(&["..", ".."], (0.5, 0.5), (0.3, 0.4)), None);
    }

    #[test]
    fn tiny_directions_are_directions() {
        let t = 0.5 / 1e-300;
        assert_eq!(cast(&ROOM, (1.5, 1.5), (1e-300, 0.0)), hit(2, 1, Side::X, t, 0.5));
        let subnormal = cast(&ROOM, (1.5, 1.5), (5e-324, 0.0)).unwrap();
        assert_eq!((subnormal.cell, subnormal.side), (Cell { column: 2, row: 1 }, Side::X));
        assert_eq!(cast(&ROOM, (1.5, 1.5), (1.0, 5e-324)), hit(2, 1, Side::X, 0.5, 0.5));
    }

    #[test]
    fn no_ray_without_a_direction() {
        let ray = |x, y, dx, dy| Ray::new(DVec2::new(x, y), DVec2::new(dx, dy));
        assert_eq!(ray(0.0, 0.0, 0.0, -0.0), Err(NotARay::NoDirection));
        assert_eq!(ray(0.0, f64::NAN, 1.0, 0.0), Err(NotARay::Origin));
        assert_eq!(ray(0.0, 0.0, f64::INFINITY, 0.0), Err(NotARay::Direction));
    }

    proptest! {
        /// Whatever the ray, it ends, in at most one step a line, each into a neighbour.
        #[test]
        fn every_ray_ends(
            origin in (any::<f64>(), any::<f64>()),
            direction in (any::<f64>(), any::<f64>()),
        ) {
            let grid = Grid::sketch(&["....", "....", "...."]).unwrap();
            let ray = Ray::new(DVec2::from(origin), DVec2::from(direction));
            prop_assume!(ray.is_ok());
            let entered: Vec<Crossing> = Walk::new(&grid, &ray.unwrap()).collect();
            prop_assert!(entered.len() <= 7);
            for pair in entered.windows(2) {
                let steps = pair[0].cell.column.abs_diff(pair[1].cell.column)
                    + pair[0].cell.row.abs_diff(pair[1].cell.row);
                prop_assert_eq!(steps, 1);
            }
        }

        /// The distance and the place on the face are where the ray meets the line.
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
