//! Compares the traversal with the walk.

use proptest::prelude::*;

use super::*;
use crate::cast::Walk;
use crate::world::World;

/// Positions and directions. Many of these rays meet corners and run along lines.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        -1.0..14.0_f64,
        (-4..52_i32).prop_map(|quarters| f64::from(quarters) / 4.0),
        (0..12_i32, -3..3_i64).prop_map(|(whole, ulps)| {
            f64::from_bits((f64::from(whole).to_bits() as i64 + ulps).max(0) as u64)
        }),
    ]
}

/// Maps with few walls, and open doors.
fn map() -> impl Strategy<Value = Vec<Vec<u8>>> {
    let tile = prop_oneof![30 => Just(0_u8), 1 => Just(1_u8), 2 => Just(2_u8)];
    prop::collection::vec(prop::collection::vec(tile, 12), 1..12)
}

fn grid(map: &[Vec<u8>]) -> Grid {
    let [width, height] = [12, map.len() as u32].map(|side| side.try_into().unwrap());
    let cells = map.iter().flatten().map(|&tile| TileId(tile)).collect();
    Grid::new(width, height, TileId(2), cells).unwrap()
}

proptest! {
    /// Line by line or by leaps, the traversal stops where the walk does.
    #[test]
    fn it_hits_the_same_cells_as_the_walk(
        map in map(),
        origin in (number(), number()),
        direction in (number(), number()),
        signs in (any::<bool>(), any::<bool>()),
    ) {
        let sign = |number: f64, is_negative| if is_negative { -number } else { number };
        let direction = DVec2::new(sign(direction.0, signs.0), sign(direction.1, signs.1));
        let ray = Ray::new(origin.into(), direction);
        prop_assume!(ray.is_ok());
        let (grid, ray) = (grid(&map), ray.unwrap());
        let mut measured = grid.clone();
        measured.measure_distances(|tile| tile == TileId(1));
        for grid in [&grid, &measured] {
            let walk = Walk::new(grid, &ray).filter(|met| grid.is_solid_tile(met.tile));
            let Some(traversal) = MajorAxisTraversal::new(grid, &ray) else { continue };
            prop_assert_eq!(traversal.collect::<Vec<_>>(), walk.collect::<Vec<_>>());
        }
    }
}

proptest! {
    /// The same on maps so empty that the traversal also leaps by blocks.
    #[test]
    fn it_hits_the_same_cells_as_the_walk_far_from_walls(
        (width, height) in (30_u32..140, 30_u32..140),
        pillars in prop::collection::vec((any::<u32>(), any::<u32>()), 0..6),
        share in (0.0..1.0, 0.0..1.0),
        direction in (-1.0..1.0_f64, -1.0..1.0_f64),
    ) {
        let mut cells = vec![TileId(0); (width * height) as usize];
        for (column, row) in pillars {
            cells[(row % height * width + column % width) as usize] = TileId(1);
        }
        let sides = [width, height].map(|side| side.try_into().unwrap());
        let mut grid = Grid::new(sides[0], sides[1], TileId(1), cells).unwrap();
        grid.measure_distances(|_| false);
        let size = DVec2::new(f64::from(width), f64::from(height));
        let ray = Ray::new(DVec2::from(share) * size, direction.into());
        prop_assume!(ray.is_ok());
        let ray = ray.unwrap();
        let walk = Walk::new(&grid, &ray).filter(|met| grid.is_solid_tile(met.tile));
        let Some(traversal) = MajorAxisTraversal::new(&grid, &ray) else { return Ok(()) };
        prop_assert_eq!(traversal.collect::<Vec<_>>(), walk.collect::<Vec<_>>());
    }
}

#[test]
fn an_empty_hall_is_crossed_in_few_leaps() {
    let side = 4096;
    let count = u32::try_from(side).unwrap().try_into().unwrap();
    let is_edge = |place: usize| place == 0 || place == side - 1;
    let cells = (0..side * side).map(|index| is_edge(index % side) || is_edge(index / side));
    let cells = cells.map(|is_edge| TileId(u8::from(is_edge))).collect();
    let mut hall = Grid::new(count, count, TileId(1), cells).unwrap();
    let lookups = |grid: &Grid, direction| {
        let ray = Ray::new(DVec2::new(1.5, 2048.5), direction).unwrap();
        let mut traversal = MajorAxisTraversal::new(grid, &ray).unwrap();
        assert_eq!(traversal.next().map(|met| met.cell.column), Some(4095));
        traversal.lookups()
    };
    for direction in [DVec2::X, DVec2::new(1.0, 0.3), DVec2::new(1.0, -0.45)] {
        assert_eq!(lookups(&hall, direction), 4094);
    }
    hall.measure_distances(|_| false);
    for direction in [DVec2::X, DVec2::new(1.0, 0.3), DVec2::new(1.0, -0.45)] {
        assert!(lookups(&hall, direction) < 40, "{}", lookups(&hall, direction));
    }
}

/// A hall with moving tiles in some cells: walls, and floors that start level or uneven.
fn hall(moving: &[(u32, u32, char)]) -> World {
    let mut rows = vec![vec!['.'; HALL as usize]; HALL as usize];
    for &(column, row, character) in moving {
        rows[row as usize][column as usize] = character;
    }
    rows[0][..2].copy_from_slice(&['@', 'l']);
    // One tile of each kind is always there, so the lever sets something.
    rows[1][..5].copy_from_slice(&['s', 'w', 'd', 'u', 'c']);
    let rows: Vec<String> = rows.into_iter().map(|row| row.into_iter().collect()).collect();
    let text = format!(
        "grid = '''\n{}\n'''\n[tiles]\ns.secret = 'brick'\nw = {{ wall = 'brick', switch = 'on' }}\n\
         d = {{ moves_to = -1, switch = 'on' }}\nc.crumbles = -2\n\
         u = {{ floor_height = -1, moves_to = 0, switch = 'on' }}\n\
         [things]\n'@'.start = 0\nl.lever = 'on'\n",
        rows.join("\n")
    );
    crate::map::parse_str(&text).unwrap()
}

/// The columns and rows of [`hall`].
const HALL: u32 = 120;

proptest! {
    /// However tiles have moved, rays that leap hit the same cells as rays that do not.
    #[test]
    fn it_hits_the_same_cells_as_the_walk_when_tiles_move(
        moving in prop::collection::vec(
            (0..HALL, 2..HALL, prop::sample::select(&['s', 'w', 'd', 'u', 'c'][..])),
            0..8,
        ),
        moves in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>()), 0..12),
        share in (0.0..1.0, 0.0..1.0),
        direction in (-1.0..1.0_f64, -1.0..1.0_f64),
    ) {
        let mut world = hall(&moving);
        let places = world.moving_tiles().iter().map(|moving| moving.states[0]);
        let characters: Vec<char> = places.map(|state| world.tile(state).character).collect();
        for (cell, state) in moves {
            let Some(index) = (!moving.is_empty()).then(|| cell.index(moving.len())) else { break };
            let (column, row, _) = moving[index];
            let cell = Cell { column, row };
            let drawn = world.grid().tile(column.into(), row.into()).unwrap();
            let character = world.tile(drawn).character;
            let index = characters.iter().position(|&known| known == character).unwrap();
            let states = &world.moving_tiles()[index].states;
            let state = states[state.index(states.len())];
            world.set_tile(cell, state);
        }
        let ray = Ray::new(DVec2::from(share) * f64::from(HALL), direction.into());
        prop_assume!(ray.is_ok());
        let ray = ray.unwrap();
        for grid in [world.grid(), world.level_grid().unwrap()] {
            prop_assert!(grid.distance_field().is_measured());
            let walk = Walk::new(grid, &ray).filter(|met| grid.is_solid_tile(met.tile));
            let Some(traversal) = MajorAxisTraversal::new(grid, &ray) else { continue };
            prop_assert_eq!(traversal.collect::<Vec<_>>(), walk.collect::<Vec<_>>());
        }
    }
}
