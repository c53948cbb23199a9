use proptest::prelude::*;

use super::*;
use crate::cast::{Hit, Walk};

proptest! {
    /// Without mirrors, the walk is the one in the exact order, with the same distances.
    #[test]
    fn without_mirrors_it_is_the_plain_walk(
        origin in (-3.0..9.0, -3.0..7.0),
        direction in (-1.0..1.0, -1.0..1.0),
    ) {
        let grid = Grid::sketch(&["......", "......", "......", "......"]).unwrap();
        let ray = Ray::new(DVec2::from(origin), DVec2::from(direction));
        prop_assume!(ray.is_ok());
        let ray = ray.unwrap();
        let mut mirrored = MirroredWalk::new(&grid, &ray, 0);
        for crossing in Walk::new(&grid, &ray) {
            let crossed = mirrored.cross(&grid);
            let hit = Hit::entering(&ray, crossing.cell, crossing.side);
            prop_assert_eq!(crossed.into, Some((crossing.cell, crossing.tile)));
            prop_assert_eq!(crossed.side, crossing.side);
            prop_assert_eq!(mirrored.distance(&crossed), hit.t);
            prop_assert_eq!(mirrored.along_face(&crossed), hit.u);
        }
        prop_assert!(mirrored.cross(&grid).into.is_none());
    }

    /// A ray between two parallel mirrors goes back and forth, and ends where it leaves the map by
    /// an open side.
    #[test]
    fn a_reflected_ray_stays_between_the_mirrors(
        origin in (1.0..3.0, 0.0..2.0),
        direction in (-1.0..1.0, -1.0..1.0),
    ) {
        let grid = Grid::sketch(&["#..#", "#..#"]).unwrap();
        let ray = Ray::new(DVec2::from(origin), DVec2::from(direction));
        prop_assume!(ray.is_ok());
        let mut walk = MirroredWalk::new(&grid, &ray.unwrap(), 100);
        let mut last = 0.0;
        while let Some((cell, tile)) = walk.cross(&grid).into {
            if grid.is_solid_tile(tile) {
                walk.reflect(Side::X);
                let (before, _) = walk.cell(&grid).unwrap();
                prop_assert_eq!(before.column, if cell.column == 0 { 1 } else { 2 });
            }
            let crossed = walk.clone().cross(&grid);
            let (t, u) = (walk.distance(&crossed), walk.along_face(&crossed));
            prop_assert!(t >= last && (0.0..=1.0).contains(&u));
            last = t;
            if walk.bounces() == 100 {
                break;
            }
        }
    }
}
