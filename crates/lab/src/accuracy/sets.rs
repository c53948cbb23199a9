//! Named sets of rays: ordinary scenes, and stiff or extreme cases. Random rays are typical camera rays.

use std::f64::consts::TAU;

use glam::DVec2;

use cellcaster::cast::Ray;
use cellcaster::rng::SplitMix64;
use cellcaster::world::{Camera, FieldOfView, Grid, Heading, TileId};

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

/// All stiff and extreme sets. The largest set has some thousands of rays; sets on maps of a
/// million cells have few.
pub fn sets(seed: u64) -> Vec<Set> {
    let mut random = SplitMix64::new(seed);
    let mut sets = directions(&mut random);
    sets.extend(origins(&mut random));
    sets.extend(lengths(&mut random));
    sets.extend(cameras());
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

/// A grid of this size. Cells for which `is_solid` is true, given the column and the row, are
/// solid.
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

/// A square grid with a wall around it and further solid cells.
fn walled(side: u32, is_solid: impl Fn(u32, u32) -> bool) -> Grid {
    let is_edge = |index: u32| index == 0 || index == side - 1;
    made(side, side, |column, row| is_edge(column) || is_edge(row) || is_solid(column, row))
}

/// Rays from every origin along every direction.
fn all(origins: &[DVec2], directions: &[DVec2]) -> Vec<Ray> {
    let along = |&origin| directions.iter().filter_map(move |&d| Ray::new(origin, d).ok());
    origins.iter().flat_map(along).collect()
}

/// Points on the floor of the hall: in general position, in the middle of a cell, and on lines.
fn places() -> [DVec2; 5] {
    [(2.37, 5.61), (6.5, 9.5), (7.0, 5.0), (12.0, 4.25), (1.1, 1.9)].map(DVec2::from)
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

// Ordinary scenes, with rays from points on open floor.

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
    let mut grid = walled(4096, |column, row| column % 64 == 32 && row % 64 == 32);
    // A world computes the distance field, too.
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
    walled(64, |column, row| column % 4 == 2 && row % 4 == 2)
}

/// Corridors of 62 cells, one cell wide, with crossings at every eighth cell.
fn corridors() -> Grid {
    walled(64, |column, row| column % 8 != 4 && row % 8 != 4)
}

// Directions that are hard to cast.

fn directions(random: &mut SplitMix64) -> Vec<Set> {
    let tiny = [(1e-300, 2e-300), (1e-310, 3e-310), (5e-324, 5e-324), (5e-324, 1e-323)];
    let unlike = [(1e300, 5e-324), (1e300, 1e-300), (f64::MAX, f64::MIN_POSITIVE), (1e300, 1.0)];
    let powers_of_ten = (3..=17).map(|exponent| libm::exp10(f64::from(-exponent)));
    vec![
        set("axis-parallel", all(&places(), &turned(1.0, 0.0))),
        set("negative zero", all(&places(), &negative_zeros())),
        set("tiny beside one", all(&places(), &beside_one([1e-300, 1e-308, 1e-310, 5e-324]))),
        set("tiny", all(&places(), &all_turned(tiny))),
        set("unlike components", all(&places(), &all_turned(unlike))),
        set("nearly parallel", all(&places(), &beside_one(powers_of_ten))),
        set("through corners", through_corners(random)),
        set("between diagonal walls", between_diagonal_walls()),
        set("along lines", along_lines()),
    ]
}

fn set(name: &'static str, rays: Vec<Ray>) -> Set {
    Set { name, grid: hall(), rays }
}

fn negative_zeros() -> Vec<DVec2> {
    turned(1.0, -0.0).into_iter().chain(turned(-1.0, -0.0)).collect()
}

/// Images of directions that have one component of these `sizes` and another of 1.
fn beside_one(sizes: impl IntoIterator<Item = f64>) -> Vec<DVec2> {
    all_turned(sizes.into_iter().map(|size| (1.0, size)))
}

/// The images of each of these directions.
fn all_turned(directions: impl IntoIterator<Item = (f64, f64)>) -> Vec<DVec2> {
    directions.into_iter().flat_map(|(x, y)| turned(x, y)).collect()
}

/// Rays from random points to every corner of the grid, and an ulp beside it.
fn through_corners(random: &mut SplitMix64) -> Vec<Ray> {
    let anywhere = DVec2::new(random.between(1.0, 3.0), random.between(8.0, 10.0));
    let mut rays = Vec::new();
    for origin in places().into_iter().chain([anywhere]) {
        for corner in (0..=12).flat_map(|y| (0..=16).map(move |x| DVec2::new(x.into(), y.into()))) {
            let way = corner - origin;
            let directions =
                [way, way.with_x(way.x.next_up()), way.with_x(way.x.next_down()), way / 3.0];
            rays.extend(all(&[origin], &directions));
        }
    }
    rays
}

/// Rays through the corners at (4, 3), (5, 4) and (5, 5), where walls meet diagonally.
fn between_diagonal_walls() -> Vec<Ray> {
    let mut rays = Vec::new();
    for corner in [DVec2::new(4.0, 3.0), DVec2::new(5.0, 4.0), DVec2::new(5.0, 5.0)] {
        for way in turned(0.5, 0.5).into_iter().chain(turned(0.75, 0.25)) {
            let ways = [way, way.with_y(way.y.next_up()), way.with_y(way.y.next_down())];
            rays.extend(all(&[corner - way], &ways));
        }
    }
    rays
}

fn along_lines() -> Vec<Ray> {
    let origins: Vec<DVec2> = (1..12)
        .flat_map(|row| [DVec2::new(1.5, row.into()), DVec2::new(14.0, row.into())])
        .chain((1..16).map(|column| DVec2::new(column.into(), 9.5)))
        .collect();
    all(&origins, &turned(1.0, 0.0))
}

// Origins that are hard to cast from.

fn origins(random: &mut SplitMix64) -> Vec<Set> {
    vec![
        set("on lines", all(&on_lines(), &slopes())),
        set("beside lines", all(&beside_lines(), &slopes())),
        set("beside zero", all(&beside_zero(), &slopes())),
        set("inside walls", all(&inside_walls(), &slopes())),
        far_end(),
        set("off the map", off_the_map(random)),
        set("very far off the map", very_far()),
    ]
}

fn slopes() -> Vec<DVec2> {
    all_turned([(1.0, 0.0), (1.0, 1.0), (2.0, 1.0), (0.3, 0.1), (1.0, 1e-9), (0.7, 1e-300)])
}

/// Origins on lines of either kind, on both, and on all edges of the map.
fn on_lines() -> Vec<DVec2> {
    [
        (7.0, 5.3),
        (6.2, 5.0),
        (7.0, 5.0),
        (3.0, 2.0),
        (0.0, 5.5),
        (16.0, 2.5),
        (4.5, 12.0),
        (5.0, 0.0),
    ]
    .map(DVec2::from)
    .to_vec()
}

fn beside_lines() -> Vec<DVec2> {
    on_lines()
        .into_iter()
        .flat_map(|DVec2 { x, y }| {
            [(x.next_up(), y), (x.next_down(), y), (x, y.next_up()), (x.next_down(), y.next_up())]
        })
        .map(DVec2::from)
        .collect()
}

fn beside_zero() -> Vec<DVec2> {
    let sizes = [0.0, 5e-324, -5e-324, 1e-300, -1e-300, 1e-17, -1e-17];
    sizes.iter().flat_map(|&x| sizes.iter().map(move |&y| DVec2::new(x, y))).collect()
}

fn inside_walls() -> Vec<DVec2> {
    [(3.5, 2.5), (0.5, 0.5), (4.25, 3.75), (8.9, 6.1), (15.5, 11.5)].map(DVec2::from).to_vec()
}

/// The last cells of a map that is a million cells long.
fn far_end() -> Set {
    let grid = made(1_000_000, 4, |column, row| row % 3 == 0 || column % 499_999 == 0);
    let origins = [(999_998.25, 1.7), (999_999.0, 2.0), (999_997.9, 2.999_999)].map(DVec2::from);
    let directions = [(1.0, 0.1), (0.3, -0.8), (-1.0, 1e-3), (-3.0, -1.0), (-1.0, 1e-5)];
    Set { name: "far end", grid, rays: all(&origins, &directions.map(DVec2::from)) }
}

/// Rays from outside the map towards it, past it and away from it.
fn off_the_map(random: &mut SplitMix64) -> Vec<Ray> {
    let mut rays = Vec::new();
    for distance in [1.0, 1e3, 1e6, 1e9, 1e12, 1e15] {
        for way in turned(1.0, 0.25).into_iter().chain(turned(1.0, 0.0)).chain(turned(1.0, 1.0)) {
            let target = DVec2::new(random.whole(0, 16), random.between(0.0, 12.0));
            rays.extend(all(&[target - way * distance], &[way, -way, way * 1e-3]));
        }
    }
    rays
}

fn very_far() -> Vec<Ray> {
    [1e16, 1e30, 1e100, 1e300, 1e308, f64::MAX]
        .into_iter()
        .flat_map(|distance| {
            turned(1.0, 1.0).into_iter().chain(turned(1.0, 0.0)).flat_map(move |way| {
                let origin = DVec2::new(5.0, 5.0) - way * distance;
                all(&[origin], &[way, way * 1e300, way * 5e-324])
            })
        })
        .collect()
}

// Rays that cross many cells before they hit.

fn lengths(random: &mut SplitMix64) -> Vec<Set> {
    vec![long_corridor(), long_map(), open_plain(random)]
}

/// A corridor of 10⁵ cells, one cell wide.
fn long_corridor() -> Set {
    let length = 100_000;
    let last = length - 1;
    let grid = made(length, 3, |column, row| row != 1 || column == 0 || column == last);
    let origins = [(1.5, 1.5), (1.1, 1.0 + 1e-9)].map(DVec2::from);
    let directions = [(1.0, 0.0), (1.0, 1e-6), (1.0, 4.9e-6), (1.0, 5.1e-6), (1.0, -1e-300)];
    Set { name: "corridor", grid, rays: all(&origins, &directions.map(DVec2::from)) }
}

/// A map of 10⁶ cells with walls close to the place where the ray crosses the line between two
/// rows.
fn long_map() -> Set {
    let length = 1_000_000;
    let grid = made(length, 4, |column, row| row % 3 == 0 || column == length - 1);
    let slope = 1.0 / 3e5;
    let directions = [(1.0, slope), (0.7, 0.7 * slope), (1.0, 1e-6)].map(DVec2::from);
    Set { name: "long map", grid, rays: all(&[DVec2::new(0.5, 1.0)], &directions) }
}

/// An open plain of 4096 × 4096 cells, with a wall around it.
fn open_plain(random: &mut SplitMix64) -> Set {
    let grid = walled(4096, |_, _| false);
    let mut rays = all(
        &[DVec2::new(1.5, 1.5), DVec2::new(1.0, 1.0), DVec2::new(2048.5, 2048.5)],
        &[(1.0, 1.0), (2.0, 1.0), (-1.0, -1.0), (1.0, 1.0 + f64::EPSILON)].map(DVec2::from),
    );
    for _ in 0..30 {
        let origin = DVec2::new(random.between(1.0, 4095.0), random.between(1.0, 4095.0));
        let (sine, cosine) = libm::sincos(random.between(0.0, TAU));
        rays.extend(Ray::new(origin, DVec2::new(cosine, sine)));
    }
    Set { name: "plain", grid, rays }
}

// Camera rays with extreme fields of view, or with a wall close to the camera.

fn cameras() -> Vec<Set> {
    let headings = [0.0, 30.0, 45.0, 90.0, 200.0, 315.0];
    let everywhere =
        || places().into_iter().flat_map(|place| headings.map(|degrees| (place, degrees)));
    vec![
        set("narrow view", views(everywhere(), 0.001)),
        set("wide view", views(everywhere(), 179.9)),
        set("nose to the wall", views(before_walls(), 66.0)),
    ]
}

/// Positions that are between 1e-12 cells and the smallest double away from the nearest wall, and
/// the heading towards it.
fn before_walls() -> Vec<(DVec2, f64)> {
    let mut places = Vec::new();
    for gap in [1e-12, 1e-15] {
        places.push((DVec2::new(1.0 + gap, 2.6), 180.0));
        places.push((DVec2::new(4.4, 1.0 + gap), 270.0));
    }
    // Only near zero are doubles close enough together, so these positions are off the map, before
    // its first column and row.
    for gap in [1e-12, 1e-30, 1e-100, 1e-300, 5e-324] {
        places.push((DVec2::new(-gap, 2.6), 0.0));
        places.push((DVec2::new(4.4, -gap), 90.0));
    }
    places
}

/// The rays of 40 columns of pixels for each camera.
fn views(cameras: impl IntoIterator<Item = (DVec2, f64)>, degrees: f64) -> Vec<Ray> {
    const COLUMNS: i32 = 40;
    let field_of_view = FieldOfView::from_degrees(degrees).unwrap_or_default();
    let camera = |(place, degrees)| {
        Camera::new(place, Heading::from_degrees(degrees).unwrap_or_default(), field_of_view)
    };
    let rays = |camera: Camera| {
        (0..COLUMNS).filter_map(move |column| {
            let across = f64::from(2 * column + 1 - COLUMNS) / f64::from(COLUMNS);
            Ray::new(camera.position(), camera.direction() + camera.plane() * across).ok()
        })
    };
    cameras.into_iter().filter_map(camera).flat_map(rays).collect()
}

/// A typical camera ray, from any point of the map, with any heading, and of about length 1.
///
/// # Panics
/// Never: rays are drawn until one is valid.
pub fn random_ray(grid: &Grid, random: &mut SplitMix64) -> Ray {
    let [width, height] = [grid.width(), grid.height()].map(f64::from);
    let mut ray = || {
        let origin = DVec2::new(random.between(0.0, width), random.between(0.0, height));
        let (sine, cosine) = libm::sincos(random.between(0.0, TAU));
        let direction = DVec2::new(cosine, sine);
        Ray::new(origin, direction + direction.perp() * random.between(-0.65, 0.65)).ok()
    };
    std::iter::repeat_with(&mut ray).flatten().next().expect("almost every ray is valid")
}
