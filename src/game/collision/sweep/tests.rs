//! Corners of walls.

use super::*;
use crate::world::Grid;

#[test]
fn a_joint_of_a_wall_is_no_corner() {
    let felt = |rows: &[&str]| {
        let grid = Grid::sketch(rows).unwrap();
        let room = Room { obstacles: &grid, column: 1, row: 1, radius: Radius(0.25) };
        let path = Path::new(DVec2::new(1.5, 1.5), DVec2::new(-1.0, -1.0)).unwrap();
        room.corner_events(path).count()
    };
    assert_eq!(felt(&["#..", "...", "..."]), 1);
    assert_eq!(felt(&["##.", "...", "..."]), 0);
    assert_eq!(felt(&["#..", "#..", "..."]), 0);
    assert_eq!(felt(&[".#.", "#..", "..."]), 0);
}
