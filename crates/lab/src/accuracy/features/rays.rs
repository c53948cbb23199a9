//! Rays at doors that are ajar, pillars, diagonals and thin walls, compared with a reference in
//! fixed point.

use std::hint::black_box;

use glam::DVec2;

use super::super::fixed_point::FixedPoint;
use super::super::{cast as cast_at_walls, random_ray};
use super::Feature;
use cellcaster::cast::{Caster, Exact, Hit, Ray, Side};
use cellcaster::map;
use cellcaster::rng::SplitMix64;
use cellcaster::world::{Cell, Grid, Line, Opening, Outline, TileKind, World};

const RAYS: usize = 2000;

pub(crate) fn features(seed: u64) -> Vec<Feature> {
    let [pillars, diagonals, thin] = [
        "a = { pillar = '#ffffff' }\nb = { pillar = '#ffffff', radius = 0.5 }\n\
         c = { pillar = '#ffffff', radius = 0.125 }\nd = { pillar = '#ffffff', radius = 1e-9 }",
        "a = { diagonal = '#ffffff', from = 'north-east' }\nb = { diagonal = '#ffffff', from = 'north-west' }\n\
         c = { diagonal = '#ffffff', from = 'south-east' }\nd = { diagonal = '#ffffff', from = 'south-west' }",
        "a = { thin = '#ffffff', at = 'north' }\nb = { thin = '#ffffff', at = 'east-west' }\n\
         c = { thin = '#ffffff', at = 'west' }\nd = { thin = '#ffffff', at = 'north-south' }",
    ]
    .map(field);
    vec![
        doors(seed),
        shapes("pillars", pillars, seed),
        shapes("diagonals", diagonals, seed),
        shapes("thin walls", thin, seed),
    ]
}

/// An open map with these tiles.
fn field(tiles: &str) -> World {
    parse(&format!(
        "grid = '''\n.........\n.a..b..c.\n...d.....\n.b...a.d.\n..c...b..\n.d..@...a\n.........\n'''\n\
         [tiles]\n{tiles}\n[things]\n'@' = {{ start = 0 }}\n"
    ))
}

/// Parses a map of this module.
fn parse(text: &str) -> World {
    map::parse_str(text).expect("the maps of this module are sound, and tests parse them")
}

/// Rays from any place in any direction, and rays from one multiple of an eighth of a cell to
/// another, which run along lines, touch pillars and hit ends.
fn rays(grid: &Grid, seed: u64) -> Vec<Ray> {
    let mut random = SplitMix64::new(seed);
    let mut all = Vec::with_capacity(RAYS);
    while all.len() < RAYS {
        all.push(random_ray(grid, &mut random));
        let mut point = || DVec2::new(random.whole(-8, 80), random.whole(-8, 64)) / 8.0;
        let (from, to) = (point(), point());
        all.extend(Ray::new(from, to - from));
    }
    all
}

/// A place where a ray may end.
struct PossibleHit {
    cell: Cell,
    t: FixedPoint,
    /// `true` at the end of a wall, on the border of its cell. The ray may pass in the next cell.
    is_end: bool,
}

/// The possible hits of a ray.
struct PossibleHits {
    /// All places up to the first place that is not an end. There are several if a ray through the
    /// end of one wall meets another wall.
    places: Vec<PossibleHit>,
    /// `true` if the ray may hit nothing.
    may_escape: bool,
}

impl PossibleHits {
    fn new(mut places: Vec<PossibleHit>) -> Self {
        places.sort_by(|one, other| one.t.cmp(&other.t));
        let certain = places.iter().position(|met| !met.is_end);
        if let Some(certain) = certain {
            let equal = places[certain..].iter().take_while(|met| met.t == places[certain].t);
            let count = certain + equal.count();
            places.truncate(count);
        }
        Self { places, may_escape: certain.is_none() }
    }
}

/// The feature of these rays in `world`, compared with these truths.
fn compared(name: &'static str, world: World, rays: Vec<Ray>, truths: &[PossibleHits]) -> Feature {
    let outcome = |(ray, truth): (&Ray, &PossibleHits)| {
        let Some(hit) = cast(&world, ray) else { return (!truth.may_escape, None) };
        let met = truth.places.iter().find(|met| met.cell == hit.cell);
        (met.is_none(), met.map(|met| met.t.relative_error(hit.t)))
    };
    let outcomes = rays.iter().zip(truths).map(outcome).collect();
    let work = move || {
        for ray in &rays {
            black_box(cast(&world, black_box(ray)));
        }
    };
    let (figure, unit) = ("distance of a ray", "relative");
    Feature { name, figure, unit, outcomes, work: Box::new(work) }
}

fn cast(world: &World, ray: &Ray) -> Option<Hit> {
    Exact.cast_through(world, ray, &mut |_| ())
}

fn shapes(name: &'static str, world: World, seed: u64) -> Feature {
    let rays = rays(world.grid(), seed);
    let outlines: Vec<(Cell, Outline)> = cells(&world)
        .filter_map(|(cell, kind)| match kind {
            TileKind::Shape(shape) => Some((cell, shape.outline)),
            _ => None,
        })
        .collect();
    let truths: Vec<PossibleHits> = rays
        .iter()
        .map(|ray| {
            let meetings = outlines.iter().filter_map(|&(cell, outline)| match outline {
                Outline::Line(line) => meet_line(ray, cell, line),
                Outline::Pillar(radius) => meet_pillar(ray, cell, radius.cells()),
            });
            PossibleHits::new(meetings.collect())
        })
        .collect();
    compared(name, world, rays, &truths)
}

fn cells(world: &World) -> impl Iterator<Item = (Cell, TileKind)> {
    let rows = (0..).zip(world.grid().rows());
    rows.flat_map(move |(row, tiles)| {
        (0..).zip(tiles).map(move |(column, &tile)| (Cell { column, row }, world.tile(tile).kind))
    })
}

/// The components of a vector in fixed point.
fn fixed(vector: DVec2) -> [FixedPoint; 2] {
    vector.to_array().map(FixedPoint::new)
}

/// The place where a ray meets a line, by Cramer's rule.
fn meet_line(ray: &Ray, cell: Cell, line: Line) -> Option<PossibleHit> {
    let ([x, y], [dx, dy]) = (fixed(ray.origin()), fixed(ray.direction()));
    let ([start_x, start_y], [extent_x, extent_y]) =
        (fixed(line.start(cell)), fixed(line.stretch()));
    let determinant = &(&dx * &extent_y) - &(&dy * &extent_x);
    if determinant.is_zero() {
        return None;
    }
    let (x, y) = (&start_x - &x, &start_y - &y);
    let t = &(&(&x * &extent_y) - &(&y * &extent_x)) / &determinant;
    let along = &(&(&x * &dy) - &(&y * &dx)) / &determinant;
    let is_beside = along.is_negative() || along > FixedPoint::new(1.0);
    let is_end = along.is_zero() || along == FixedPoint::new(1.0);
    (!t.is_negative() && !is_beside).then_some(PossibleHit { cell, t, is_end })
}

/// The place where a ray meets a pillar, by the quadratic formula.
fn meet_pillar(ray: &Ray, cell: Cell, radius: f64) -> Option<PossibleHit> {
    let ([x, y], [dx, dy]) = (fixed(ray.origin()), fixed(ray.direction()));
    let [center_x, center_y] = fixed(cell.center());
    let (x, y, radius) = (&x - &center_x, &y - &center_y, FixedPoint::new(radius));
    let a = &(&dx * &dx) + &(&dy * &dy);
    let b = &(&x * &dx) + &(&y * &dy);
    let c = &(&(&x * &x) + &(&y * &y)) - &(&radius * &radius);
    let discriminant = &(&b * &b) - &(&a * &c);
    let is_met = !discriminant.is_negative() && !c.is_negative() && b.is_negative();
    is_met.then(|| {
        let t = &(&-&b - &discriminant.square_root()) / &a;
        PossibleHit { cell, t, is_end: false }
    })
}

/// A room with doors that are open to different degrees.
fn doors(seed: u64) -> Feature {
    const ROWS: [&str; 7] =
        ["#########", "#@..#...#", "#...+...#", "#...#...#", "##+###+##", "#.......#", "#########"];
    let mut world = parse(&format!(
        "grid = '''\n{}\n'''\n[tiles]\n'#' = {{ wall = '#ff0000' }}\n'+' = {{ door = '#00ff00' }}\n\
         [things]\n'@' = {{ start = 0 }}\n",
        ROWS.join("\n")
    ));
    let leaves: Vec<(Cell, Side, f64)> =
        [(4, 2, Side::X, 0.3), (2, 4, Side::Y, 0.75), (6, 4, Side::Y, 0.015)]
            .map(|(column, row, side, part)| (Cell { column, row }, side, part))
            .into();
    for &(cell, _, part) in &leaves {
        if let Some(opening) = Opening::new(part) {
            world.set_opening(cell, opening);
        }
    }
    let rows = ROWS.map(|row| row.replace(['+', '@'], "."));
    let walls = Grid::sketch(&rows.each_ref().map(String::as_str));
    let walls = walls.expect("the rows are of one length");
    let is_open = |ray: &Ray| {
        let cell = ray.origin().floor();
        !walls.is_solid(cell.x as i64, cell.y as i64)
    };
    let rays: Vec<Ray> = rays(world.grid(), seed).into_iter().filter(is_open).collect();
    let truths: Vec<PossibleHits> = rays
        .iter()
        .map(|ray| {
            let met = leaves.iter().filter_map(|leaf| meet_leaf(ray, leaf));
            PossibleHits::new(met.chain(meet_wall(&walls, ray)).collect())
        })
        .collect();
    compared("doors ajar", world, rays, &truths)
}

fn meet_leaf(ray: &Ray, &(cell, side, part): &(Cell, Side, f64)) -> Option<PossibleHit> {
    let ([x, y], [dx, dy]) = (fixed(ray.origin()), fixed(ray.direction()));
    let (column, row) = (f64::from(cell.column), f64::from(cell.row));
    let (across, along, line, start) = match side {
        Side::X => ((x, dx), (y, dy), column + 0.5, row),
        Side::Y => ((y, dy), (x, dx), row + 0.5, column),
    };
    if across.1.is_zero() {
        return None;
    }
    let t = &(&FixedPoint::new(line) - &across.0) / &across.1;
    let place = &along.0 + &(&t * &along.1);
    let is_within =
        place >= FixedPoint::new(start) && place <= FixedPoint::new(start + (1.0 - part));
    (!t.is_negative() && is_within).then_some(PossibleHit { cell, t, is_end: false })
}

fn meet_wall(walls: &Grid, ray: &Ray) -> Option<PossibleHit> {
    let truth = cast_at_walls(walls, ray)?;
    let (origin, direction, index) = match truth.side {
        Side::X => (ray.origin().x, ray.direction().x, truth.cell.column),
        Side::Y => (ray.origin().y, ray.direction().y, truth.cell.row),
    };
    let line = f64::from(index) + if direction > 0.0 { 0.0 } else { 1.0 };
    let t = &(&FixedPoint::new(line) - &FixedPoint::new(origin)) / &FixedPoint::new(direction);
    Some(PossibleHit { cell: truth.cell, t, is_end: false })
}
