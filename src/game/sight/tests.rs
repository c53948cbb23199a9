//! Lines of sight against an exact oracle, which clips the line against every cell with rationals.

use num_rational::BigRational;
use num_traits::{One, Zero};
use proptest::prelude::*;

use super::*;
use crate::map;

/// The tiles and things of all maps.
const LEGEND: &str = r##"
[tiles]
"#" = { wall = "#808080" }
"%" = { glass = "#80c0ff" }
"1" = { floor_height = 0.3, ceiling_height = 1.5 }
"h" = { floor_height = 0.9, ceiling_height = 2 }
"p" = { floor_height = -2 }
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

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

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
}
