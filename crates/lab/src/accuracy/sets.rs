//! Named sets of rays: ordinary scenes, and stiff or extreme cases.

mod cameras;
mod directions;
mod lengths;
mod ordinary;
mod origins;

pub use ordinary::{ordinary, plain};

use glam::DVec2;

use cellcaster::cast::Ray;
use cellcaster::rng::SplitMix64;
use cellcaster::world::{Grid, TileId};

/// Rays with a common property, and the grid in which they are cast.
#[derive(Clone, Debug)]
pub struct Set {
    /// The common property in one or two words.
    pub name: &'static str,
    /// The grid.
    pub grid: Grid,
    /// The rays.
    pub rays: Vec<Ray>,
}

/// All stiff and extreme sets. The largest has some thousands of rays; sets on maps of a million
/// cells have few.
pub fn sets(seed: u64) -> Vec<Set> {
    let mut random = SplitMix64::new(seed);
    let mut sets = directions::sets(&mut random);
    sets.extend(origins::sets(&mut random));
    sets.extend(lengths::sets(&mut random));
    sets.extend(cameras::sets());
    sets
}

/// A hall with pillars, walls that meet only at corners, and an open side to the east.
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

/// The grid of a valid drawing.
fn drawn(rows: &[&str]) -> Grid {
    Grid::sketch(rows).expect("the drawings in this module are rectangles")
}

/// A grid of this size, which is solid where `is_solid` is true for the column and the row.
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

/// Rays from every origin along every direction.
fn all(origins: &[DVec2], directions: &[DVec2]) -> Vec<Ray> {
    let along = |&origin| directions.iter().filter_map(move |&d| Ray::new(origin, d).ok());
    origins.iter().flat_map(along).collect()
}

/// Points on the floor of the hall: in general position, in the middle of a cell, and on lines.
fn places() -> [DVec2; 5] {
    [
        DVec2::new(2.37, 5.61),
        DVec2::new(6.5, 9.5),
        DVec2::new(7.0, 5.0),
        DVec2::new(12.0, 4.25),
        DVec2::new(1.1, 1.9),
    ]
}

/// The eight images of a direction under reflections in the axes and the diagonals.
fn turned(x: f64, y: f64) -> [DVec2; 8] {
    let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    std::array::from_fn(|index| {
        let (x_sign, y_sign) = signs[index / 2];
        let vector = DVec2::new(x * x_sign, y * y_sign);
        if index % 2 == 0 { vector } else { DVec2::new(vector.y, vector.x) }
    })
}
