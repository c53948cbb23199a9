//! The named sets: ordinary scenes, and all that is stiff or extreme.

mod cameras;
mod directions;
mod lengths;
mod ordinary;
mod origins;

pub use ordinary::ordinary;

use glam::DVec2;

use crate::cast::Ray;
use crate::rng::SplitMix64;
use crate::world::{Grid, TileId};

/// Rays that have something in common, and the grid they are cast in.
#[derive(Clone, Debug)]
pub struct Set {
    /// What they have in common, in a word or two.
    pub name: &'static str,
    /// The grid.
    pub grid: Grid,
    /// The rays.
    pub rays: Vec<Ray>,
}

/// All stiff and extreme sets. The largest has some thousands of rays; those on maps of a million
/// cells have a few.
pub fn sets(seed: u64) -> Vec<Set> {
    let mut random = SplitMix64::new(seed);
    let mut sets = directions::sets(&mut random);
    sets.extend(origins::sets(&mut random));
    sets.extend(lengths::sets(&mut random));
    sets.extend(cameras::sets());
    sets
}

/// A hall with pillars, walls that meet at corners only, and an open side to the east.
fn hall() -> Grid {
    drawn(&[
        "################",
        "#..............#",
        "#..#....#..#....",
        "#...#......#...#",
        "#....#...#.....#",
        "#...#..........#",
        "#..#....##....##",
        "#.............#.",
        "#..#.#.#....#..#",
        "#...............",
        "#.......#......#",
        "####.#####..####",
    ])
}

/// A grid from a drawing that is known to be one.
fn drawn(rows: &[&str]) -> Grid {
    Grid::sketch(rows).expect("the drawings in this module are rectangles")
}

/// A grid of so many cells, solid where `is_solid` says so of a column and a row.
fn made(width: u32, height: u32, is_solid: impl Fn(u32, u32) -> bool) -> Grid {
    let cell = |row| {
        let is_solid = &is_solid;
        move |column| TileId(u8::from(is_solid(column, row)))
    };
    let cells = (0..height).flat_map(|row| (0..width).map(cell(row))).collect();
    let size = (width.try_into(), height.try_into());
    let (Ok(width), Ok(height)) = size else { unreachable!("no set is on an empty map") };
    Grid::new(width, height, TileId(1), cells).expect("there is a cell for each column and row")
}

/// The rays from every origin along every direction.
fn all(origins: &[DVec2], directions: &[DVec2]) -> Vec<Ray> {
    let along = |&origin| directions.iter().filter_map(move |&d| Ray::new(origin, d).ok());
    origins.iter().flat_map(along).collect()
}

/// A few places on the floor of the hall: in general position, in the middle of a cell, on lines.
fn places() -> [DVec2; 5] {
    [
        DVec2::new(2.37, 5.61),
        DVec2::new(6.5, 9.5),
        DVec2::new(7.0, 5.0),
        DVec2::new(12.0, 4.25),
        DVec2::new(1.1, 1.9),
    ]
}

/// A direction and its reflections, with the axes swapped too.
fn turned(x: f64, y: f64) -> [DVec2; 8] {
    let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    std::array::from_fn(|index| {
        let (x_sign, y_sign) = signs[index / 2];
        let vector = DVec2::new(x * x_sign, y * y_sign);
        if index % 2 == 0 { vector } else { DVec2::new(vector.y, vector.x) }
    })
}
