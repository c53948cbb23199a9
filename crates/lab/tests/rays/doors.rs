//! The leaves of doors compared with rational arithmetic: whether a ray hits a leaf, at which
//! distance, and at which texture coordinate.

use cellcaster::cast::{Caster, Exact, Hit, Ray, Side};
use cellcaster::color::Rgb;
use cellcaster::map;
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{Camera, Cell, FieldOfView, Grid, Heading, Opening, World};
use cellcaster_lab::accuracy;
use glam::DVec2;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive};
use proptest::prelude::*;

const ROWS: [&str; 7] =
    ["#########", "#...#...#", "#...+...#", "#...#...#", "##+###+##", "#.......#", "#########"];

/// The doors of `ROWS`, each with the kind of line that contains its leaf.
const DOORS: [(Cell, Side); 3] = [
    (Cell { column: 4, row: 2 }, Side::X),
    (Cell { column: 2, row: 4 }, Side::Y),
    (Cell { column: 6, row: 4 }, Side::Y),
];

/// A world with doors, each with the open part `part`.
fn world(part: f64) -> World {
    let drawn = ROWS.join("\n").replacen("#...#...#", "#@..#...#", 1);
    let mut world = map::parse_str(&format!(
        "grid = '''\n{drawn}\n'''\ntiles = {{ '#'.wall = '#ff0000', '+'.door = '#00ff00' }}\n\
         things.'@'.start = 0"
    ))
    .unwrap();
    for (door, _) in DOORS {
        world.set_opening(door, Opening::new(part).unwrap());
    }
    world
}

/// A hit on a wall or on the leaf of a door.
#[derive(Clone, Debug, PartialEq, PartialOrd)]
struct Met {
    t: BigRational,
    is_wall: bool,
    cell: Cell,
    is_y_side: bool,
    u: Option<BigRational>,
}

/// The nearest hit on all leaves, and on the walls of the map without doors.
fn truth(ray: &Ray, part: f64) -> Option<Met> {
    let rows = ROWS.map(|row| row.replace('+', "."));
    let grid = Grid::sketch(&rows.each_ref().map(String::as_str)).unwrap();
    let leaves = DOORS.iter().filter_map(|&(cell, side)| leaf(ray, cell, side, part));
    leaves.chain(wall(&grid, ray)).min_by(|one, other| one.partial_cmp(other).unwrap())
}

fn wall(grid: &Grid, ray: &Ray) -> Option<Met> {
    let truth = accuracy::cast(grid, ray)?;
    let (origin, direction, index) = match truth.side {
        Side::X => (ray.origin().x, ray.direction().x, truth.cell.column),
        Side::Y => (ray.origin().y, ray.direction().y, truth.cell.row),
    };
    let line = f64::from(index) + if direction > 0.0 { 0.0 } else { 1.0 };
    let t = (exact(line) - exact(origin)) / exact(direction);
    let is_y_side = truth.side == Side::Y;
    Some(Met { t, is_wall: true, cell: truth.cell, is_y_side, u: None })
}

fn leaf(ray: &Ray, cell: Cell, side: Side, part: f64) -> Option<Met> {
    let (origin, direction) = (ray.origin(), ray.direction());
    let (column, row) = (f64::from(cell.column), f64::from(cell.row));
    let (line, start) = match side {
        Side::X => (column + 0.5, row),
        Side::Y => (row + 0.5, column),
    };
    let (across, along) = match side {
        Side::X => ((origin.x, direction.x), (origin.y, direction.y)),
        Side::Y => ((origin.y, direction.y), (origin.x, direction.x)),
    };
    if part >= 1.0 || across.1 == 0.0 {
        return None;
    }
    let t = (exact(line) - exact(across.0)) / exact(across.1);
    let place = exact(along.0) + &t * exact(along.1);
    let end = start + (1.0 - part);
    if t.is_negative() || place < exact(start) || place > exact(end) {
        return None;
    }
    let slid = place - exact(start) + exact(part);
    let is_seen_from_left = if side == Side::X { direction.x > 0.0 } else { direction.y < 0.0 };
    let u = if is_seen_from_left { slid } else { exact(1.0) - slid };
    Some(Met { t, is_wall: false, cell, is_y_side: side == Side::Y, u: Some(u) })
}

fn exact(number: f64) -> BigRational {
    BigRational::from_float(number).unwrap()
}

/// Describes the error of `hit`, if there is one.
fn fault(truth: Option<&Met>, hit: Option<&Hit>) -> Option<String> {
    let is_right = match (truth, hit) {
        (None, None) => true,
        (Some(truth), Some(hit)) => {
            let error = (&truth.t - exact(hit.t)).abs().to_f64().unwrap();
            let u_error = truth.u.as_ref().map_or(0.0, |u| (u - exact(hit.u)).to_f64().unwrap());
            (truth.cell, truth.is_y_side) == (hit.cell, hit.side == Side::Y)
                && error <= 2.0 * f64::EPSILON * hit.t
                && u_error.abs() <= 1e-12
        }
        _ => false,
    };
    (!is_right).then(|| format!("{truth:?} is taken for {hit:?}"))
}

fn part() -> impl Strategy<Value = f64> {
    prop_oneof![prop::sample::select(vec![0.0, 0.25, 0.5, 1.0]), 0.0..=1.0]
}

/// Origins on open floor or in a door's cell, because a ray that starts in a wall has already
/// entered it.
fn origin() -> impl Strategy<Value = DVec2> {
    let cells = (0..).zip(ROWS).flat_map(|(row, line)| {
        let columns = (0..).zip(line.chars()).filter(|&(_, character)| character != '#');
        columns.map(move |(column, _)| DVec2::new(f64::from(column), f64::from(row)))
    });
    let within = || prop_oneof![(0..8).prop_map(|eighths| f64::from(eighths) / 8.0), 0.0..1.0];
    (prop::sample::select(cells.collect::<Vec<_>>()), within(), within())
        .prop_map(|(cell, x, y)| cell + DVec2::new(x, y))
}

/// Coordinates on a raster, which hits corners and edges, or anywhere.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![(0..=72).prop_map(|eighths| f64::from(eighths) / 8.0), 0.0..9.0]
}

/// A possible end of a door's leaf.
fn end(door: usize, part: f64, is_jamb: bool) -> DVec2 {
    let (Cell { column, row }, side) = DOORS[door];
    let (column, row) = (f64::from(column), f64::from(row));
    let along = if is_jamb { 0.0 } else { 1.0 - part };
    match side {
        Side::X => DVec2::new(column + 0.5, row + along),
        Side::Y => DVec2::new(column + along, row + 0.5),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn rays_through_doors_match_exact_arithmetic(
        part in part(),
        origin in origin(),
        target in (coordinate(), coordinate()),
        aimed in prop::option::of((0..DOORS.len(), any::<bool>())),
        nudge in -2_i32..=2,
    ) {
        let world = world(part);
        let mut target = aimed.map_or(target.into(), |(door, is_jamb)| end(door, part, is_jamb));
        for _ in 0..nudge.abs() {
            target.y = if nudge < 0 { target.y.next_down() } else { target.y.next_up() };
        }
        let ray = Ray::new(origin, target - origin);
        prop_assume!(ray.is_ok());
        let ray = ray.unwrap();
        let hit = Exact.cast_through(&world, &ray, &mut |_| {});
        prop_assert_eq!(fault(truth(&ray, part).as_ref(), hit.as_ref()), None, "{:?}", ray);
    }
}

#[test]
fn a_closed_door_is_a_recessed_wall() {
    let world = world(0.0);
    let camera = Camera::new(DVec2::new(2.5, 2.5), Heading::default(), FieldOfView::default());
    let mut renderer = Renderer::new();
    let mut frame = Frame::new(FrameSize::new(41, 41).unwrap(), PixelAspect::SQUARE);
    renderer.render(&world, &camera.unwrap(), &mut frame);
    let distances = renderer.distances();
    assert_eq!(distances[20], 2.0);
    assert_eq!(frame.pixel(20, 20), Rgb::new(0, 255, 0));
    // The jamb beside it is neither the door nor the wall. Then comes the wall, nearer by half a
    // cell.
    assert!(distances[0] < 2.0 && distances.iter().any(|distance| (1.5..2.0).contains(distance)));
    let colors: Vec<Rgb> = (0..41).map(|x| frame.pixel(x, 20)).collect();
    let is_jamb = |color: &&Rgb| ![Rgb::new(0, 255, 0), Rgb::new(255, 0, 0)].contains(color);
    assert!(colors.iter().any(|color| *color == Rgb::new(255, 0, 0)));
    assert!(colors.iter().filter(is_jamb).count() >= 2);
}

#[test]
fn an_open_door_is_floor() {
    let world = world(1.0);
    for (Cell { column, row }, _) in DOORS {
        assert!(!world.grid().is_solid(column.into(), row.into()));
    }
    let ray = Ray::new(DVec2::new(2.5, 2.5), DVec2::X).unwrap();
    let hit = Exact.cast(world.grid(), &ray).unwrap();
    assert_eq!((hit.cell, hit.t), (Cell { column: 8, row: 2 }, 5.5));
}
