//! The growth of costs with the map. Counts the look-ups of rays, and measures no times.

use allocation_counter::measure;
use cellcaster::cast::{Caster, Exact, Ray};
use cellcaster::map;
use cellcaster::render::{Explanation, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{Cell, FieldOfView, Opening, World};
use glam::DVec2;

/// A square map with walls around it, and the cells that `drawn` returns.
fn square(side: u32, drawn: impl Fn(u32, u32) -> Option<char>) -> World {
    let is_edge = |place: u32| place == 0 || place == side - 1;
    let mut text = String::from("grid = '''\n");
    for row in 0..side {
        text.extend((0..side).map(|column| match drawn(column, row) {
            _ if is_edge(column) || is_edge(row) => '#',
            _ if (column, row) == (2, side / 2) => '@',
            drawn => drawn.unwrap_or('.'),
        }));
        text.push('\n');
    }
    text.push_str("'''\n[tiles]\n'#'.wall = 'brick'\n'+'.door = 'oak'\n\n");
    text.push_str("[things]\n'@'.start = 0\n");
    map::parse_str(&text).unwrap_or_else(|faults| panic!("{faults}"))
}

fn explained(world: &World) -> Explanation {
    let camera = world.start_camera(FieldOfView::default());
    let mut frame = Frame::new(FrameSize::new(160, 90).unwrap(), PixelAspect::SQUARE);
    Renderer::new().explain(world, &camera, &mut frame)
}

/// The bytes that stay allocated after reading a map of this side, and the bytes that its grid
/// reports.
fn bytes(side: u32) -> (i64, i64) {
    let mut world = None;
    let counted = measure(|| world = Some(square(side, |_, _| None)));
    (counted.bytes_current, world.unwrap().grid().bytes() as i64)
}

#[test]
fn a_grid_reports_the_bytes_of_a_large_map() {
    let ((small, told_of_small), (large, told_of_large)) = (bytes(64), bytes(1024));
    let (taken, told) = (large - small, told_of_large - told_of_small);
    assert!((taken - told).abs() * 100 <= told, "{taken} bytes, and not {told}");
    assert!(told_of_large < 5 * 1024 * 1024, "{told_of_large} bytes are too many");
}

#[test]
fn rays_among_rooms_go_line_by_line() {
    let rooms = square(66, |column, row| {
        (column % 8 == 0 && row % 8 != 4 || row % 8 == 0 && column % 8 != 4).then_some('#')
    });
    let walk = explained(&rooms).stats.walk;
    assert!(walk.looks < walk.cells);
}

#[test]
fn a_hall_16_times_as_wide_takes_at_most_3_times_the_lookups() {
    let [small, large] = [64, 1024].map(|side| explained(&square(side, |_, _| None)).stats.walk);
    assert!(large.cells > 10 * small.cells);
    assert!(large.looks <= 3 * small.looks, "{:?}", (small, large));
    assert!(small.looks < small.cells / 3);
}

/// There is one pillar in each block of 64 by 64 cells, and not in its middle.
#[test]
fn rays_on_a_plain_cross_a_dozen_cells_with_each_lookup() {
    let pillar = |column: u32, row: u32| {
        let moved = |by: u32| 16 + (column / 64 * 37 + row / 64 * 101 + by * 53) % 32;
        ((column % 64, row % 64) == (moved(0), moved(1))).then_some('#')
    };
    let walk = explained(&square(4096, pillar)).stats.walk;
    assert!(walk.cells > 1000 * walk.rays, "{walk:?}");
    assert!(walk.cells > 12 * walk.looks, "{walk:?}");
}

/// A door in a wall across a hall, at all distances from the start of a leap.
#[test]
fn no_ray_leaps_across_a_closing_door() {
    for side in [100, 1024] {
        no_ray_leaps_across_a_door(side);
    }
}

fn no_ray_leaps_across_a_door(side: u32) {
    let door = Cell { column: 50, row: side / 2 };
    let wall =
        |column, row| (column == door.column).then_some(if row == door.row { '+' } else { '#' });
    let mut world = square(side, wall);
    let walk = explained(&world).stats.walk;
    assert!(walk.looks < walk.cells, "{walk:?}");
    let hit = |world: &World, x: f64| {
        let middle = f64::from(side / 2) + 0.5;
        let ray = Ray::new(DVec2::new(x, middle), DVec2::X).unwrap();
        Exact.cast_through(world, &ray, &mut |_| ()).map(|hit| hit.cell.column)
    };
    let far = side - 1;
    let half = Opening::new(0.25).unwrap();
    for (opening, column) in [
        (Opening::CLOSED, door.column),
        (half, door.column),
        (Opening::OPEN, far),
        (half, door.column),
        (Opening::CLOSED, door.column),
        (Opening::OPEN, far),
    ] {
        world.set_opening(door, opening);
        for x in [1.5, 20.25, 48.5, 49.75] {
            assert_eq!(hit(&world, x), Some(column), "{opening:?} from {x}");
        }
        assert_eq!(hit(&world, 50.75), Some(far), "{opening:?}");
    }
}
