//! The DDA: from line to line, in double precision.
//!
//! The order of the lines is that of [`RoundedOrder`], with which the exact caster begins; here it
//! is not checked.
//!
//! Source: the digital differential analyser of Lode Vandevenne, "Raycasting", in its older form,
//! whose distance is computed from the cell (in "Raycasting II"); after Amanatides and Woo, "A Fast
//! Voxel Traversal Algorithm" (1987).

use cellcaster::cast::{Caster, Hit, Ray, RoundedOrder, Walk};
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

#[cfg(test)]
mod tests {
    use glam::DVec2;
    use proptest::prelude::*;

    use super::*;
    use cellcaster::cast::Side;
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
