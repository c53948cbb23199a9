//! Ordinary scenes, with rays from points on open floor.

use super::super::random_ray;
use super::{Set, drawn, made};
use cellcaster::cast::Ray;
use cellcaster::rng::SplitMix64;
use cellcaster::world::Grid;

/// Three ordinary scenes with `count` rays each: rooms, pillars and corridors.
pub fn ordinary(seed: u64, count: usize) -> Vec<Set> {
    let mut random = SplitMix64::new(seed);
    let scenes = [("rooms", rooms()), ("pillars", pillars()), ("corridors", corridors())];
    scenes
        .map(|(name, grid)| {
            let rays = rays_from_floor(&grid, count, &mut random);
            Set { name, grid, rays }
        })
        .into()
}

/// A plain of 4096 × 4096 cells with a tenth of `count` rays: a wall around it, and a pillar in every
/// sixty-fourth column of every sixty-fourth row.
pub fn plain(seed: u64, count: usize) -> Set {
    const SIDE: u32 = 4096;
    let is_edge = |index: u32| index == 0 || index == SIDE - 1;
    let mut grid = made(SIDE, SIDE, |column, row| {
        is_edge(column) || is_edge(row) || (column % 64 == 32 && row % 64 == 32)
    });
    // As a world has it.
    grid.clear(|_| false);
    let rays = rays_from_floor(&grid, count.div_ceil(10), &mut SplitMix64::new(seed));
    Set { name: "plain-4096", grid, rays }
}

fn rays_from_floor(grid: &Grid, count: usize, random: &mut SplitMix64) -> Vec<Ray> {
    let rays = std::iter::repeat_with(|| random_ray(grid, random));
    let is_on_floor = |ray: &Ray| {
        let cell = ray.origin().floor();
        !grid.is_solid(cell.x as i64, cell.y as i64)
    };
    rays.filter(is_on_floor).take(count).collect()
}

/// A level of rooms with doorways.
fn rooms() -> Grid {
    drawn(&[
        "########################",
        "#.......#......#.......#",
        "#..............#.......#",
        "#.......#......#.......#",
        "#.......#......####.####",
        "####.####..#...........#",
        "#..........#...#.......#",
        "#.......#......#..##...#",
        "#..##...#......#..##...#",
        "#..##...####.###.......#",
        "#.......#......#.......#",
        "#.......#..............#",
        "####.####......####.####",
        "#..............#.......#",
        "#.......#......#.......#",
        "########################",
    ])
}

/// An open square of 64 × 64 cells with a pillar in every fourth column of every fourth row.
fn pillars() -> Grid {
    let is_edge = |index: u32| index == 0 || index == 63;
    made(64, 64, |column, row| is_edge(column) || is_edge(row) || (column % 4 == 2 && row % 4 == 2))
}

/// Corridors of 62 cells, one cell wide, with crossings at every eighth cell.
fn corridors() -> Grid {
    let is_edge = |index: u32| index == 0 || index == 63;
    made(64, 64, |column, row| is_edge(column) || is_edge(row) || (column % 8 != 4 && row % 8 != 4))
}
