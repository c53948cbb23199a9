//! Pillars and lines: every hit compared with rational arithmetic, which does not round.

use cellcaster::cast::{Caster, Exact, Hit, Ray, Side};
use cellcaster::map;
use cellcaster::world::{Cell, Line, Outline, TileKind, World};
use glam::DVec2;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};
use proptest::prelude::*;

const MAP: &str = r##"
grid = '''
.......
.oOqr/.
.nesw\.
.-|/\O.
.O\.@./
.r-o|q.
.......
'''
[tiles]
"o" = { pillar = "marble" }
"O" = { pillar = "#ffffff", radius = 0.5 }
"q" = { pillar = "marble", radius = 0.25 }
"r" = { pillar = "marble", radius = 1e-9 }
"/" = { diagonal = "brick", from = "north-east" }
"\\" = { diagonal = "brick", from = "south-east" }
"n" = { thin = "wood", at = "north" }
"e" = { thin = "wood", at = "east" }
"s" = { thin = "wood", at = "south" }
"w" = { thin = "wood", at = "west" }
"-" = { thin = "wood", at = "east-west" }
"|" = { thin = "wood", at = "north-south" }
[things]
"@" = { start = 0 }
"##;

/// The largest difference between the two results.
const TOLERANCE: f64 = 1e-12;

type Number = BigRational;

fn exact(value: f64) -> Number {
    BigRational::from_float(value).unwrap()
}

/// The square root of a nonnegative number, accurate to hundreds of bits.
fn square_root(square: &Number) -> Number {
    const BITS: usize = 300;
    let scaled = (square.numer() * square.denom()) << (2 * BITS);
    BigRational::new(scaled.sqrt(), square.denom() << BITS)
}

/// A ray in exact numbers.
struct ExactRay {
    x: Number,
    y: Number,
    dx: Number,
    dy: Number,
}

/// An exact hit.
struct Meeting {
    cell: Cell,
    t: Number,
    u: f64,
}

impl ExactRay {
    fn new(ray: &Ray) -> Self {
        let (origin, direction) = (ray.origin(), ray.direction());
        let [x, y] = origin.to_array().map(exact);
        let [dx, dy] = direction.to_array().map(exact);
        Self { x, y, dx, dy }
    }

    fn meets(&self, cell: Cell, outline: Outline) -> Option<Meeting> {
        match outline {
            Outline::Line(line) => self.meets_line(cell, line),
            Outline::Pillar(radius) => self.meets_pillar(cell, radius.cells()),
        }
    }

    /// The meeting with a line, by Cramer's rule.
    fn meets_line(&self, cell: Cell, line: Line) -> Option<Meeting> {
        let [start_x, start_y] = line.start(cell).to_array().map(exact);
        let [stretch_x, stretch_y] = line.stretch().to_array().map(exact);
        let determinant = &self.dx * &stretch_y - &self.dy * &stretch_x;
        if determinant.is_zero() {
            return None;
        }
        let (x, y) = (start_x - &self.x, start_y - &self.y);
        let t = (&x * &stretch_y - &y * &stretch_x) / &determinant;
        let along = (&x * &self.dy - &y * &self.dx) / &determinant;
        let one = exact(1.0);
        if t.is_negative() || along.is_negative() || along > one {
            return None;
        }
        let u = if determinant.is_positive() { along } else { one - along };
        Some(Meeting { cell, t, u: u.to_f64().unwrap() })
    }

    /// The meeting with a pillar, by the quadratic formula.
    fn meets_pillar(&self, cell: Cell, radius: f64) -> Option<Meeting> {
        let [x, y] = cell.center().to_array().map(exact);
        let (x, y) = (&self.x - &x, &self.y - &y);
        let a = &self.dx * &self.dx + &self.dy * &self.dy;
        let b = &x * &self.dx + &y * &self.dy;
        let c = &x * &x + &y * &y - exact(radius) * exact(radius);
        let discriminant = &b * &b - &a * &c;
        if discriminant.is_negative() || c.is_negative() || !b.is_negative() {
            return None;
        }
        let t = (-b - square_root(&discriminant)) / a;
        let outward_x = (x + &t * &self.dx).to_f64().unwrap();
        let outward_y = (y + &t * &self.dy).to_f64().unwrap();
        let turn = libm::atan2(outward_y, outward_x) / std::f64::consts::TAU;
        let times = (std::f64::consts::TAU * radius).round().max(1.0);
        let u = -turn * times;
        Some(Meeting { cell, t, u: u - u.floor() })
    }
}

fn shapes(world: &World) -> impl Iterator<Item = (Cell, Outline)> {
    let rows = world.grid().rows().zip(0..);
    rows.flat_map(|(tiles, row)| {
        tiles.iter().zip(0..).map(move |(&tile, column)| (tile, column, row))
    })
    .filter_map(|(tile, column, row)| match world.tile(tile).kind {
        TileKind::Shape(shape) => Some((Cell { column, row }, shape.outline)),
        _ => None,
    })
}

fn cast(world: &World, ray: &Ray) -> Option<Hit> {
    Exact.cast_through(world, ray, &mut |_| panic!("there is nothing to see through"))
}

/// Half of the points are multiples of an eighth of a cell, and half of the directions lead from
/// one such point to another. Rays therefore hit ends, run along lines and touch pillars exactly.
fn any_ray() -> impl Strategy<Value = Ray> {
    let coordinate =
        || prop_oneof![-1.0..8.0, (-8..64).prop_map(|eighths| f64::from(eighths) / 8.0)];
    let points = (coordinate(), coordinate(), coordinate(), coordinate());
    points.prop_filter_map("it goes nowhere", |(x, y, to_x, to_y)| {
        Ray::new(DVec2::new(x, y), DVec2::new(to_x - x, to_y - y)).ok()
    })
}

/// The distance of two positions on a repeated texture.
fn apart(one: f64, other: f64) -> f64 {
    let apart = (one - other).abs();
    apart.min(1.0 - apart)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn hits_agree_with_exact_arithmetic(ray in any_ray()) {
        let world = map::parse_str(MAP).unwrap();
        let exact_ray = ExactRay::new(&ray);
        let mut meetings: Vec<Meeting> = shapes(&world)
            .filter_map(|(cell, outline)| exact_ray.meets(cell, outline))
            .collect();
        meetings.sort_by(|one, other| one.t.cmp(&other.t));
        let hit = cast(&world, &ray);
        // A ray through a corner of the grid is in only one of the two cells beside it, so it may
        // miss the end of a line in the other cell. A ray along a grid line may miss shapes that
        // touch the line.
        let is_corner = |meeting: &Meeting| {
            let x = &exact_ray.x + &meeting.t * &exact_ray.dx;
            let y = &exact_ray.y + &meeting.t * &exact_ray.dy;
            let along_x = exact_ray.dy.is_zero() || x.is_integer();
            let along_y = exact_ray.dx.is_zero() || y.is_integer();
            along_x && y.is_integer() || along_y && x.is_integer()
        };
        let is_it = |meeting: &Meeting, hit: &Hit| {
            let t = meeting.t.to_f64().unwrap();
            let of_u = if is_thin(&world, hit.cell) { 1e-6 } else { TOLERANCE };
            hit.cell == meeting.cell
                && (hit.t - t).abs() <= TOLERANCE * t.max(1.0)
                && apart(hit.u, meeting.u) <= of_u
        };
        let first = meetings.iter().find(|meeting| !is_corner(meeting));
        match (hit, first) {
            (None, None) => {}
            (None, Some(meeting)) => {
                prop_assert!(false, "it misses {:?} at {:?}", meeting.cell, meeting.t.to_f64());
            }
            (Some(hit), first) => {
                let is_first =
                    |meeting: &&Meeting| first.is_none_or(|first| meeting.t <= first.t);
                let agrees =
                    meetings.iter().take_while(is_first).any(|meeting| is_it(meeting, &hit));
                let cell = first.map(|meeting| (meeting.cell, meeting.t.to_f64(), meeting.u));
                prop_assert!(agrees, "{hit:?}, and not {cell:?}");
            }
        }
    }
}

/// Returns whether a cell has a pillar so thin that the side of a hit depends on the last digit.
fn is_thin(world: &World, cell: Cell) -> bool {
    shapes(world).any(|(other, outline)| {
        other == cell && matches!(outline, Outline::Pillar(radius) if radius.cells() < 1e-6)
    })
}

fn lone(tile: &str) -> World {
    let text = format!(
        "grid = '''\n.....\n..x..\n@....\n'''\n[tiles]\n\"x\" = {{ {tile} }}\n\
         [things]\n\"@\" = {{ start = 0 }}\n"
    );
    map::parse_str(&text).unwrap()
}

fn hit(tile: &str, origin: (f64, f64), direction: (f64, f64)) -> Option<(f64, Side)> {
    let ray = Ray::new(DVec2::from(origin), DVec2::from(direction)).unwrap();
    cast(&lone(tile), &ray).map(|hit| (hit.t, hit.side))
}

#[test]
fn a_ray_that_starts_inside_a_pillar_leaves_it() {
    let pillar = "pillar = \"brick\", radius = 0.5";
    for direction in [(1.0, 0.0), (0.3, -0.7), (-1.0, -1e-9)] {
        assert_eq!(hit(pillar, (2.5, 1.5), direction), None);
        assert_eq!(hit(pillar, (2.5 + 0.499, 1.5), direction), None);
    }
}

#[test]
fn a_pillar_touching_its_cells_edges_is_hit_there() {
    let pillar = "pillar = \"brick\", radius = 0.5";
    assert_eq!(hit(pillar, (0.0, 1.5), (1.0, 0.0)), Some((2.0, Side::X)));
    assert_eq!(hit(pillar, (2.5, 0.0), (0.0, 1.0)), Some((1.0, Side::Y)));
    // A ray along its edge, in the cell, touches it.
    assert_eq!(hit(pillar, (0.0, 1.0), (1.0, 0.0)), Some((2.5, Side::Y)));
    // A ray an ulp farther away is in the next cell.
    assert_eq!(hit(pillar, (0.0, 1.0_f64.next_down()), (1.0, 0.0)), None);
}

#[test]
fn a_line_is_hit_at_its_tips_but_not_along_itself() {
    let diagonal = "diagonal = \"brick\", from = \"north-west\"";
    assert_eq!(hit(diagonal, (1.0, 0.0), (1.0, 1.0)), None);
    let across = hit(diagonal, (3.0, 1.0), (-1.0, 1.0));
    assert_eq!(across, Some((0.5, Side::X)));
    // Rays through the end in the north-west that also pass through the cell.
    for direction in [(1.0, 0.5), (1.0, 0.0), (0.5, 1.0)] {
        let origin = (2.0 - direction.0, 1.0 - direction.1);
        assert_eq!(hit(diagonal, origin, direction).map(|(t, _)| t), Some(1.0), "{direction:?}");
    }
    let thin = "thin = \"brick\", at = \"east-west\"";
    assert_eq!(hit(thin, (0.0, 1.5), (1.0, 0.0)), None);
    assert_eq!(hit(thin, (2.0, 0.5), (0.0, 1.0)), Some((1.0, Side::Y)));
}

#[test]
fn rays_of_any_size_from_anywhere_end() {
    let world = map::parse_str(MAP).unwrap();
    for far in [1e9, 1e15, 1e99, 1e101, 1e300] {
        for scale in [5e-324, 1e-300, 1.0, 1e300] {
            for (x, y) in [(-far, 1.5), (-far, -far), (2.5, far), (far, 3.0)] {
                let way = DVec2::new(3.5 - x, 3.5 - y).normalize_or_zero() * scale;
                let Ok(ray) = Ray::new(DVec2::new(x, y), way) else { continue };
                if let Some(hit) = cast(&world, &ray) {
                    assert!(hit.t >= 0.0 && (0.0..=1.0).contains(&hit.u), "{hit:?}");
                }
            }
        }
    }
}
