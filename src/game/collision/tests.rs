//! Properties of collision, on random grids.

use std::f64::consts::TAU;
use std::ops::Range;

use glam::Vec2Swizzles;
use proptest::prelude::*;

use super::*;
use crate::world::Grid;

/// Solid cells that reach from the floor to the ceiling.
impl Obstacles for Grid {
    fn blocks(&self, column: i64, row: i64) -> bool {
        self.tile(column, row).is_none_or(|tile| self.is_solid_tile(tile))
    }
}

fn radius(cells: f64) -> Radius {
    Radius::new(cells).unwrap()
}

fn still_at(position: DVec2) -> MovingBody {
    MovingBody { position, velocity: DVec2::ZERO }
}

fn moved(grid: &Grid, from: DVec2, displacement: DVec2, radius: Radius) -> DVec2 {
    slide(&mut grid.clone(), still_at(from), displacement, radius).position
}

fn transposed(rows: &[&str]) -> Vec<String> {
    let columns = rows[0].len();
    (0..columns).map(|column| rows.iter().map(|row| &row[column..=column]).collect()).collect()
}

fn sketch<T: AsRef<str>>(rows: &[T]) -> Grid {
    Grid::sketch(&rows.iter().map(AsRef::as_ref).collect::<Vec<_>>()).unwrap()
}

/// A grid, and an open cell in it.
fn grid_and_start() -> impl Strategy<Value = (Grid, Cell)> {
    let size = (1..10_usize, 1..10_usize);
    size.prop_flat_map(|(width, height)| {
        let solid = prop::collection::vec(prop::bool::weighted(0.3), width * height);
        (Just(width), solid, 0..width * height)
    })
    .prop_map(|(width, mut solid, start)| {
        solid[start] = false;
        let character = |&solid| if solid { '#' } else { '.' };
        let rows: Vec<String> =
            solid.chunks(width).map(|row| row.iter().map(character).collect()).collect();
        let cell = Cell { column: (start % width) as u32, row: (start / width) as u32 };
        (sketch(&rows), cell)
    })
}

/// Displacements from a billionth of a cell to a million cells. Half of them are along an axis or a
/// diagonal.
fn displacement() -> impl Strategy<Value = DVec2> {
    let compass = (0..8).prop_map(|eighths| match eighths {
        0 => DVec2::X,
        1 => DVec2::ONE,
        2 => DVec2::Y,
        3 => DVec2::new(-1.0, 1.0),
        4 => -DVec2::X,
        5 => -DVec2::ONE,
        6 => -DVec2::Y,
        _ => DVec2::new(1.0, -1.0),
    });
    let angle = (0.0..TAU).prop_map(|angle| DVec2::new(libm::cos(angle), libm::sin(angle)));
    let length = prop_oneof![Just(0.25), Just(0.5), Just(1.0), power_of_ten()];
    (prop_oneof![compass, angle], length).prop_map(|(direction, length)| direction * length)
}

fn power_of_ten() -> impl Strategy<Value = f64> {
    (-9.0..6.0).prop_map(|exponent| libm::pow(10.0, exponent))
}

/// Half of the coordinates are multiples of a quarter, so that paths meet joints and corners
/// exactly.
fn point(x: Range<f64>, y: Range<f64>) -> impl Strategy<Value = DVec2> {
    let coordinate = |range: Range<f64>| {
        let quarters = range.clone().prop_map(|value| (4.0 * value).round() / 4.0);
        prop_oneof![range, quarters]
    };
    (coordinate(x), coordinate(y)).prop_map(|(x, y)| DVec2::new(x, y))
}

fn any_radius() -> impl Strategy<Value = Radius> {
    prop_oneof![Just(0.25), Just(0.5), 0.01..0.5].prop_map(radius)
}

/// The distance from a point on the map to the nearest solid cell; cells outside the map are solid.
fn clearance(grid: &Grid, point: DVec2) -> f64 {
    let (width, height) = (i64::from(grid.width()), i64::from(grid.height()));
    let cells = (-1..=height).flat_map(|row| (-1..=width).map(move |column| (column, row)));
    cells
        .filter(|&(column, row)| grid.blocks(column, row))
        .map(|(column, row)| {
            let low = DVec2::new(column as f64, row as f64);
            point.distance(point.clamp(low, low + DVec2::ONE))
        })
        .fold(f64::INFINITY, f64::min)
}

/// The cells that are connected to `start` through their sides.
fn reachable(grid: &Grid, start: (i64, i64)) -> Vec<(i64, i64)> {
    let mut found = vec![start];
    let mut next = 0;
    while let Some(&(column, row)) = found.get(next) {
        for cell in [(column - 1, row), (column + 1, row), (column, row - 1), (column, row + 1)] {
            if !grid.blocks(cell.0, cell.1) && !found.contains(&cell) {
                found.push(cell);
            }
        }
        next += 1;
    }
    found
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn a_body_never_enters_or_crosses_a_wall(
        (grid, start) in grid_and_start(),
        radius in any_radius(),
        displacements in prop::collection::vec(displacement(), 1..40),
    ) {
        let mut position = start.center();
        let reachable = reachable(&grid, cell_of(position));
        for displacement in displacements {
            position = moved(&grid, position, displacement, radius);
            prop_assert!(is_clear(&grid, position, radius), "{position}");
            prop_assert!(clearance(&grid, position) >= radius.0 * (1.0 - 1e-15));
            prop_assert!(reachable.contains(&cell_of(position)), "{position}");
        }
    }

    #[test]
    fn the_path_to_a_contact_is_clear_and_ends_at_a_wall(
        (grid, start) in grid_and_start(),
        radius in any_radius(),
        detour in displacement(),
        displacement in displacement(),
    ) {
        let from = moved(&grid, start.center(), detour, radius);
        let path = StraightPath::new(from, displacement).unwrap();
        let contact = first_contact(&grid, path, radius);
        let end = contact.map_or(from + displacement, |contact| contact.position);
        for part in 0..=100 {
            let point = from.lerp(end, f64::from(part) / 100.0);
            prop_assert!(clearance(&grid, point) >= radius.0 - 1e-9, "{point}");
        }
        if let Some(contact) = contact {
            prop_assert!(clearance(&grid, end) <= radius.0 + 1e-6, "{end}");
            prop_assert!(displacement.dot(contact.normal) < 0.0);
            let wall = end - contact.normal * (radius.0 + 1e-5);
            // At the very end of a face, rounding may put the probe one ulp beside it.
            prop_assert!(clearance(&grid, wall) < 1e-9, "nothing solid at {wall}");
        }
    }

    #[test]
    fn sliding_never_adds_speed(
        (mut grid, start) in grid_and_start(),
        displacement in displacement(),
        velocity in displacement(),
    ) {
        let body = MovingBody { position: start.center(), velocity };
        let after = slide(&mut grid, body, displacement, radius(0.25));
        prop_assert!(after.velocity.length() <= velocity.length() * (1.0 + 1e-12));
    }

    #[test]
    fn joints_do_not_catch(
        from in point(0.5..39.5, 1.25..1.75),
        displacement in prop_oneof![point(-50.0..50.0, 1.0..9.0), point(-50.0..50.0, -9.0..-1.0)],
    ) {
        let rows = ["#".repeat(40), ".".repeat(40), "#".repeat(40)];
        let rows = rows.each_ref().map(String::as_str);
        let target = (from + displacement).clamp(DVec2::new(0.25, 1.25), DVec2::new(39.75, 1.75));

        let along = moved(&sketch(&rows), from, displacement, radius(0.25));
        let across = sketch(&transposed(&rows));
        let down = moved(&across, from.yx(), displacement.yx(), radius(0.25)).yx();
        for end in [along, down] {
            prop_assert!((end.x - target.x).abs() < 1e-9, "{end}, not {target}");
            prop_assert_eq!(end.y, target.y);
        }
    }

    #[test]
    fn a_corner_is_walked_around(offset in 0.001..0.249, stride in 0.001..0.3) {
        let rows = [".........", ".........", "....#....", ".........", "........."];
        let across = sketch(&transposed(&rows));
        let grid = sketch(&rows);
        for from in [DVec2::new(2.5, 2.0 - offset), DVec2::new(2.5, 3.0 + offset)] {
            let (mut along, mut down) = (from, from.yx());
            for _ in 0..(8.0 / stride) as usize {
                along = moved(&grid, along, DVec2::new(stride, 0.0), radius(0.25));
                down = moved(&across, down, DVec2::new(0.0, stride), radius(0.25));
            }
            prop_assert!(along.x > 5.0, "caught at {along}");
            prop_assert!(down.y > 5.0, "caught at {down}");
        }
    }

    #[test]
    fn a_corner_holds_without_jitter(
        from in (0.25..1.75, 0.25..1.75),
        push in (0.001..1.0, 0.001..1.0),
        radius in any_radius(),
    ) {
        let mut grid = sketch(&["..", ".."]);
        let from = DVec2::new(from.0, from.1).clamp(DVec2::splat(0.5), DVec2::splat(1.5));
        let push = DVec2::new(push.0, push.1);
        let cornered = moved(&grid, from, push * 1e4, radius);
        let held = slide(&mut grid, MovingBody { position: cornered, velocity: push }, push, radius);
        prop_assert!(cornered.distance(DVec2::splat(2.0 - radius.0)) < 1e-12);
        prop_assert!(held.position.distance(cornered) < 1e-12);
        prop_assert_eq!(held.velocity, DVec2::ZERO);
        prop_assert_eq!(slide(&mut grid, held, push, radius), held);
    }
}

#[test]
fn a_body_fits_through_a_gap_of_its_exact_width() {
    let grid =
        sketch(&["#######", "#.....#", "###.###", "#.....#", "###.###", "#.....#", "#######"]);
    let widest = radius(0.5);
    let mut position = DVec2::new(1.5, 1.5);
    let walk = [
        (DVec2::new(2.0, 0.0), DVec2::new(3.5, 1.5)),
        (DVec2::new(0.0, 2.0), DVec2::new(3.5, 3.5)),
        (DVec2::new(-1e6, 0.0), DVec2::new(1.5, 3.5)),
        (DVec2::new(1e6, 7.0), DVec2::new(5.5, 3.5)),
        (DVec2::new(-2.0, 0.0), DVec2::new(3.5, 3.5)),
        (DVec2::new(0.0, 1e6), DVec2::new(3.5, 5.5)),
        (DVec2::new(0.0, -1e6), DVec2::new(3.5, 1.5)),
    ];
    for (displacement, target) in walk {
        position = moved(&grid, position, displacement, widest);
        assert_eq!(position, target);
    }
}

#[test]
fn touching_a_wall_or_the_map_edge_is_clear() {
    let grid = sketch(&["..#"]);
    let quarter = radius(0.25);
    assert!(is_clear(&grid, DVec2::new(1.75, 0.5), quarter));
    assert!(!is_clear(&grid, DVec2::new(1.75_f64.next_up(), 0.5), quarter));
    assert!(is_clear(&grid, DVec2::new(0.25, 0.25), quarter));
    assert!(!is_clear(&grid, DVec2::new(0.25, 0.25_f64.next_down()), quarter));
    assert!(!is_clear(&grid, DVec2::new(2.5, 0.5), quarter));
    assert!(!is_clear(&grid, DVec2::new(-7.0, 0.5), quarter));
}

#[test]
fn a_radius_is_at_most_half_a_cell() {
    for cells in [0.0, -0.25, 0.5_f64.next_up(), f64::NAN, f64::INFINITY] {
        assert_eq!(Radius::new(cells), None, "{cells}");
    }
}

#[test]
fn a_wall_joint_is_not_a_corner() {
    let felt = |rows: &[&str]| {
        let grid = Grid::sketch(rows).unwrap();
        let room = OpenCell { obstacles: &grid, column: 1, row: 1, radius: Radius(0.25) };
        let path = StraightPath::new(DVec2::new(1.5, 1.5), DVec2::new(-1.0, -1.0)).unwrap();
        room.corner_events(path).count()
    };
    assert_eq!(felt(&["#..", "...", "..."]), 1);
    assert_eq!(felt(&["##.", "...", "..."]), 0);
    assert_eq!(felt(&["#..", "#..", "..."]), 0);
    assert_eq!(felt(&[".#.", "#..", "..."]), 0);
}

/// Shapes: pillars, and walls along diagonals.
mod shapes {
    use std::f64::consts::TAU;

    use proptest::prelude::*;

    use super::*;
    use crate::world::PillarRadius;

    const SIDE: u32 = 7;

    /// A closed room with shapes in some of its cells.
    #[derive(Clone, Debug)]
    struct Room(Vec<Option<Outline>>);

    impl Obstacles for Room {
        fn blocks(&self, column: i64, row: i64) -> bool {
            let inside = 0..i64::from(SIDE);
            !inside.contains(&column) || !inside.contains(&row)
        }

        fn outline(&self, cell: Cell) -> Option<Outline> {
            let index = cell.row * SIDE + cell.column;
            self.0.get(index as usize).copied().flatten().filter(|_| cell.column < SIDE)
        }
    }

    impl Room {
        fn empty() -> Self {
            Self(vec![None; (SIDE * SIDE) as usize])
        }

        fn with(mut self, column: u32, row: u32, outline: Outline) -> Self {
            self.0[(row * SIDE + column) as usize] = Some(outline);
            self
        }

        fn clearance(&self, point: DVec2) -> f64 {
            let cells = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| Cell { column, row }));
            let distances =
                cells.filter_map(|cell| Some(self.outline(cell)?.distance(cell, point)));
            distances.fold(f64::INFINITY, f64::min)
        }
    }

    fn any_outline() -> impl Strategy<Value = Outline> {
        let pillar = prop_oneof![Just(0.5), 0.01..0.5]
            .prop_map(|radius| Outline::Pillar(PillarRadius::new(radius).unwrap()));
        prop_oneof![pillar, prop::sample::select(&Line::ALL[..]).prop_map(Outline::Line)]
    }

    /// A room with shapes, and a position in it at which a circle is clear.
    fn any_room(radius: Radius) -> impl Strategy<Value = (Room, DVec2)> {
        let shapes = prop::collection::vec(
            prop::option::weighted(0.4, any_outline()),
            (SIDE * SIDE) as usize,
        );
        let place = (0.25..6.75, 0.25..6.75).prop_map(DVec2::from);
        (shapes.prop_map(Room), place)
            .prop_filter("it stands clear", move |(room, place)| is_clear(room, *place, radius))
    }

    fn displacement() -> impl Strategy<Value = DVec2> {
        let eighth = (0..8).prop_map(|eighths| f64::from(eighths) / 8.0);
        let angle = prop_oneof![eighth, 0.0..1.0].prop_map(|turns| turns * TAU);
        (angle, -9.0..3.0).prop_map(|(angle, exponent)| {
            DVec2::new(libm::cos(angle), libm::sin(angle)) * libm::pow(10.0, exponent)
        })
    }

    const QUARTER: Radius = Radius::new(0.25).unwrap();

    fn moved(room: &Room, position: DVec2, displacement: DVec2) -> DVec2 {
        let body = MovingBody { position, velocity: DVec2::ZERO };
        slide(&mut room.clone(), body, displacement, QUARTER).position
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn a_body_never_enters_or_crosses_a_shape(
            (room, start) in any_room(QUARTER),
            displacements in prop::collection::vec(displacement(), 1..30),
        ) {
            let mut position = start;
            for displacement in displacements {
                let after = moved(&room, position, displacement);
                prop_assert!(is_clear(&room, after, QUARTER), "{after}");
                if displacement.length() < 0.1 {
                    // The path there is nearly straight.
                    for part in 0..10 {
                        let point = position.lerp(after, f64::from(part) / 10.0);
                        prop_assert!(room.clearance(point) > 0.2, "through something at {point}");
                    }
                }
                position = after;
            }
        }

        #[test]
        fn sliding_never_adds_speed(
            (room, start) in any_room(QUARTER),
            displacement in displacement(),
            velocity in displacement(),
        ) {
            let body = MovingBody { position: start, velocity };
            let after = slide(&mut room.clone(), body, displacement, QUARTER);
            prop_assert!(after.velocity.length() <= velocity.length() * (1.0 + 1e-12));
        }

        #[test]
        fn a_pillar_is_walked_around(
            offset in 0.001..0.7,
            radius in 0.05..0.5,
            stride in 0.001..0.3,
        ) {
            prop_assume!(offset < radius + 0.25);
            let pillar = Outline::Pillar(PillarRadius::new(radius).unwrap());
            let room = Room::empty().with(3, 3, pillar);
            for side in [-1.0, 1.0] {
                let mut position = DVec2::new(1.5, 3.5 + side * offset);
                for _ in 0..(16.0 / stride) as usize {
                    position = moved(&room, position, DVec2::new(stride, 0.0));
                }
                prop_assert!(position.x > 6.0, "caught at {position}");
            }
        }

        /// A wall of diagonals has joints, and doubles cannot represent positions on its sides.
        #[test]
        fn sliding_along_a_diagonal_does_not_catch(
            x in 0.3..1.5,
            stride in 0.001_f64..0.2,
            push in 0.0..1.0,
        ) {
            let room = (0..SIDE).fold(Room::empty(), |room, index| {
                room.with(index, index, Outline::Line(Line::FromNorthWest))
            });
            let mut position = DVec2::new(x, 5.0);
            // First to the wall, and then along it while pushing into it.
            for _ in 0..(9.0 / stride) as usize {
                position = moved(&room, position, DVec2::new(0.0, -stride));
            }
            let way = DVec2::new(1.0, 1.0 - push) * stride;
            let steps = 200;
            let along = DVec2::ONE.normalize();
            for _ in 0..steps {
                let before = position;
                position = moved(&room, position, way);
                if position.x > 5.9 {
                    break;
                }
                let gone = (position - before).dot(along);
                prop_assert!((gone - way.dot(along)).abs() < 1e-8, "caught at {position}");
            }
        }
    }

    #[test]
    fn a_pillar_as_wide_as_its_cell_leaves_no_gap_beside_a_wall() {
        let widest = Outline::Pillar(PillarRadius::new(0.5).unwrap());
        let room = Room::empty().with(3, 0, widest);
        let end = moved(&room, DVec2::new(1.5, 0.25), DVec2::new(50.0, 0.0));
        assert!(end.x < 3.5 && room.clearance(end) >= 0.25, "{end}");
        let beside = moved(&room, DVec2::new(1.5, 1.5), DVec2::new(50.0, 0.0));
        assert_eq!(beside.x, 6.75);
    }
}
