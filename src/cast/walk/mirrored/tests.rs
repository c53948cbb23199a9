use proptest::prelude::*;

use super::*;
use crate::cast::{CommonOrder, Hit, Walk};

proptest! {
    /// Without mirrors, the walk equals the walk in the exact order, with the same distances.
    #[test]
    fn without_mirrors_it_equals_the_plain_walk(
        origin in (-3.0..9.0, -3.0..7.0),
        direction in (-1.0..1.0, -1.0..1.0),
    ) {
        let grid = Grid::sketch(&["......", "......", "......", "......"]).unwrap();
        let ray = Ray::new(DVec2::from(origin), DVec2::from(direction));
        prop_assume!(ray.is_ok());
        let ray = ray.unwrap();
        let mut mirrored = RayWalk::new(&grid, &ray);
        for crossing in Walk::new(&grid, &ray) {
            let crossed = mirrored.cross(&grid);
            let hit = Hit::entering(&ray, crossing.cell, crossing.side);
            prop_assert_eq!(crossed.into, Some((crossing.cell, crossing.tile)));
            prop_assert_eq!(crossed.side, crossing.side);
            prop_assert_eq!(mirrored.meeting(&crossed).0, hit.t);
        }
        prop_assert!(mirrored.cross(&grid).into.is_none());
    }

    /// A ray between two parallel mirrors goes back and forth, and ends where it leaves the map
    /// through an open side.
    #[test]
    fn a_reflected_ray_stays_between_the_mirrors(
        origin in (1.0..3.0, 0.0..2.0),
        direction in (-1.0..1.0, -1.0..1.0),
    ) {
        let grid = Grid::sketch(&["#..#", "#..#"]).unwrap();
        let ray = Ray::new(DVec2::from(origin), DVec2::from(direction));
        prop_assume!(ray.is_ok());
        let ray = ray.unwrap();
        let mut order = CommonOrder::new(&grid, ray.origin(), 100).along(ray.direction());
        let mut cross = |course: &mut Course| loop {
            let [x, y] = course.lines();
            if let Some(crossed) = course.cross(&grid, order.next(x, y)) {
                return crossed;
            }
        };
        let mut course = Course::new(&grid, &ray);
        let (mut transform, mut last) = (MirrorTransform::default(), 0.0);
        for _ in 0..200 {
            let crossed = cross(&mut course);
            let Some((cell, tile)) = crossed.into else { break };
            let (t, _) = meeting(&ray, crossed.side, course.corner(&crossed));
            prop_assert!(t >= last);
            last = t;
            if grid.is_solid_tile(tile) {
                _ = transform.reflect(Side::X, crossed.line as i64, 0);
                course = Course::resumed(&grid, ray.direction(), transform, course.place());
                let (before, _) = course.cell(&grid).unwrap();
                prop_assert_eq!(before.column, if cell.column == 0 { 1 } else { 2 });
            }
        }
    }
}
