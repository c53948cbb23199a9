//! Lines of sight against an exact oracle, which clips the line against every cell with rationals.

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use proptest::prelude::*;

use super::*;
use crate::map;
use crate::world::{Outline, Shape, TileKind};

/// The tiles and things of all maps.
const LEGEND: &str = r##"
[tiles]
"#" = { wall = "#808080" }
"%" = { glass = "#80c0ff" }
"1" = { floor_height = 0.3, ceiling_height = 1.5 }
"h" = { floor_height = 0.9, ceiling_height = 2 }
"p" = { floor_height = -2 }
"o" = { pillar = "#808080", radius = 0.5 }
"i" = { pillar = "#808080", radius = 0.25, height = 0.5 }
"-" = { thin = "#808080", at = "east-west" }
"n" = { thin = "#808080", at = "north", height = 0.5 }
"/" = { diagonal = "#808080", from = "north-east", height = 0.75 }
[things]
"@" = { start = 0 }
"##;

type Exact = BigRational;

fn exact(value: f64) -> Exact {
    Exact::from_float(value).unwrap()
}

/// The open interval of parameters in 0..1 for which a line from `from` by `way` is inside
/// `low..high`; `None` if it never is.
fn inside(from: &Exact, way: &Exact, low: &Exact, high: &Exact) -> Option<(Exact, Exact)> {
    if way.is_zero() {
        return (low < from && from < high).then(|| (Exact::zero(), Exact::one()));
    }
    let (one, other) = ((low - from) / way, (high - from) / way);
    let (first, last) = if one < other { (one, other) } else { (other, one) };
    let (first, last) = (first.max(Exact::zero()), last.min(Exact::one()));
    (first < last).then_some((first, last))
}

/// The depth of the line inside solids: the largest distance of its height from all gaps of a cell,
/// over all cells that it passes. It is at most 0 if the line is free.
fn depth(world: &World, from: Point, to: Point) -> f64 {
    let grid = world.grid();
    let start = [from.position.x, from.position.y].map(exact);
    let way = [to.position.x, to.position.y].map(exact);
    let way = [&way[0] - &start[0], &way[1] - &start[1]];
    let mut deepest = f64::NEG_INFINITY;
    for (column, row) in (0..grid.height()).flat_map(|row| (0..grid.width()).map(move |c| (c, row)))
    {
        let (x, y) = (f64::from(column), f64::from(row));
        let across = inside(&start[0], &way[0], &exact(x), &exact(x + 1.0));
        let down = inside(&start[1], &way[1], &exact(y), &exact(y + 1.0));
        let (Some(across), Some(down)) = (across, down) else { continue };
        let (first, last) = (across.0.max(down.0), across.1.min(down.1));
        if first >= last {
            continue;
        }
        let height = |t: &Exact| exact(from.height) + (exact(to.height) - exact(from.height)) * t;
        let (one, other) = (height(&first), height(&last));
        let (low, high) = if one < other { (one, other) } else { (other, one) };
        let tile = world.tile(grid.tile(column.into(), row.into()).unwrap());
        let outside = |gap: Gap| {
            let below = exact(gap.bottom) - &low;
            let above = if gap.top.is_finite() { &high - exact(gap.top) } else { exact(-1e9) };
            let most = below.max(above);
            num_traits::ToPrimitive::to_f64(&most).unwrap()
        };
        deepest = deepest.max(tile.gaps().map(outside).fold(f64::INFINITY, f64::min));
    }
    deepest
}

fn perp_dot(one: &[Exact; 2], other: &[Exact; 2]) -> Exact {
    &one[0] * &other[1] - &one[1] * &other[0]
}

/// Whether the line meets a shape where it is at most as high as the shape. A line along a thin wall passes it.
fn meets_a_shape(world: &World, from: Point, to: Point) -> bool {
    let grid = world.grid();
    let cells = (0..grid.height())
        .flat_map(|row| (0..grid.width()).map(move |column| Cell { column, row }));
    cells.into_iter().any(|cell| {
        let tile = world.tile(grid.tile_in(cell).unwrap());
        let TileKind::Shape(Shape { outline, .. }) = tile.kind else { return false };
        let rise = exact(to.height) - exact(from.height);
        let above = exact(from.height) - exact(tile.top_of_what_stands());
        let range = match (above.is_positive(), (&above + &rise).is_positive()) {
            (false, false) => [Exact::zero(), Exact::one()],
            (true, true) => return false,
            (false, true) => [Exact::zero(), -above / rise],
            (true, false) => [-above / rise, Exact::one()],
        };
        let start = from.position.to_array().map(exact);
        let way = [0, 1].map(|axis| exact(to.position[axis]) - &start[axis]);
        let offset = |t: &Exact, place: DVec2| {
            let place = place.to_array().map(exact);
            [0, 1].map(|axis| &start[axis] + &way[axis] * t - &place[axis])
        };
        match outline {
            Outline::Pillar(radius) => {
                let is_inside = |t: &Exact| {
                    let [x, y] = offset(t, cell.center());
                    &x * &x + &y * &y <= exact(radius.cells()) * exact(radius.cells())
                };
                let [x, y] = offset(&Exact::zero(), cell.center());
                let square = &way[0] * &way[0] + &way[1] * &way[1];
                let nearest = (!square.is_zero()).then(|| -(x * &way[0] + y * &way[1]) / square);
                let nearest = nearest.filter(|t| range[0] < *t && *t < range[1]);
                range.iter().chain(&nearest).any(is_inside)
            }
            Outline::Line(line) => {
                let extent = line.stretch().to_array().map(exact);
                let sides = range.map(|t| perp_dot(&extent, &offset(&t, line.start(cell))));
                let ends = [line.start(cell), line.start(cell) + line.stretch()];
                let ends = ends.map(|end| perp_dot(&way, &offset(&Exact::zero(), end)));
                let are_apart = |[one, other]: [Exact; 2]| (one * other).is_positive();
                !perp_dot(&way, &extent).is_zero() && !are_apart(sides) && !are_apart(ends)
            }
        }
    })
}

fn rows() -> impl Strategy<Value = String> {
    let tile = prop_oneof![
        6 => Just('.'), 4 => Just('#'), 1 => Just('1'), 1 => Just('h'), 1 => Just('p'), 1 => Just('%')
    ];
    prop::collection::vec(tile, 64).prop_map(|mut tiles| {
        tiles[0] = '@';
        let rows: Vec<String> = tiles.chunks(8).map(|row| row.iter().collect()).collect();
        rows.join("\n")
    })
}

/// Half of the coordinates are multiples of a quarter, so that lines meet corners and edges.
fn coordinate() -> impl Strategy<Value = f64> {
    let any = 0.01..7.99_f64;
    prop_oneof![any.clone(), any.prop_map(|value| (value * 4.0).round() / 4.0)]
}

fn point() -> impl Strategy<Value = Point> {
    let height = prop_oneof![0.0..1.0, -2.0..1.5, Just(0.5)];
    (coordinate(), coordinate(), height)
        .prop_map(|(x, y, height)| Point { position: DVec2::new(x, y), height })
}

const SHAPES: &[char] = &['.', '.', '.', '.', 'o', 'i', '-', 'n', '/'];

/// Many lines end on a thin wall or touch its end.
fn place(cells: i32) -> impl Strategy<Value = f64> {
    let quarters = (0..=4 * cells).prop_map(|quarters| f64::from(quarters) / 4.0);
    let ulps = (quarters.clone(), -3..4_i32)
        .prop_map(|(place, ulps)| place + f64::from(ulps) * f64::EPSILON);
    prop_oneof![quarters, ulps, 0.0..f64::from(cells)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn a_line_of_sight_never_passes_anything_solid(rows in rows(), from in point(), to in point()) {
        const ROUNDING: f64 = 1e-9;
        let world = map::parse_str(&format!("ceiling = \"#202028\"\ngrid = '''\n{rows}\n'''\n{LEGEND}")).unwrap();
        let depth = depth(&world, from, to);
        let sees = is_in_sight(&world, &[], from, to);
        if depth > ROUNDING {
            prop_assert!(!sees, "{depth} inside");
        }
        // On edges and corners, the line may use either adjacent cell. Elsewhere both results must
        // agree.
        let is_off_edges = |at: DVec2| at.x.fract() != 0.0 && at.y.fract() != 0.0;
        let way = to.position - from.position;
        let is_generic = [from.position, to.position].into_iter().all(is_off_edges)
            && (0..9).all(|x| (0..9).all(|y| {
                let corner = DVec2::new(f64::from(x), f64::from(y));
                (corner - from.position).perp_dot(way).abs() > 1e-9
            }));
        if depth < -ROUNDING && is_generic {
            prop_assert!(sees, "{depth} outside");
        }
    }

    #[test]
    fn a_line_of_sight_ends_at_the_first_shape_that_it_meets(
        tiles in prop::collection::vec(prop::sample::select(SHAPES), 8),
        ends in prop::array::uniform2((place(4), place(2), prop_oneof![Just(0.5), 0.01..0.99])),
    ) {
        let row = |tiles: &[char]| format!(".{}.", tiles.iter().collect::<String>());
        let rows: Vec<String> = tiles.chunks(4).map(row).collect();
        let grid = format!("@.....\n{}\n......", rows.join("\n"));
        let map = format!("ceiling = \"#202028\"\ngrid = '''\n{grid}\n'''\n{LEGEND}");
        let world = map::parse_str(&map).unwrap();
        let [from, to] = ends.map(|(x, y, height)| Point { position: DVec2::new(x + 1.0, y + 1.0), height });
        let is_met = meets_a_shape(&world, from, to);
        prop_assert_eq!(is_in_sight(&world, &[], from, to), !is_met);
    }
}
