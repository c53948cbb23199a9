//! Moving windows, and the pictures of them.

use proptest::prelude::*;

use super::*;
use crate::generate::{Extent, Generator};
use crate::render::{Frame, FrameSize, PixelAspect, Renderer};
use crate::world::{Camera, FieldOfView};

fn generator() -> impl Strategy<Value = Generator> {
    prop::sample::select(&Generator::ALL)
}

fn site() -> impl Strategy<Value = Site> {
    let place = || {
        prop_oneof![
            -200_i64..200,
            999_999_900..1_000_000_100_i64,
            -1_000_000_100..-999_999_900_i64,
            any::<i64>(),
            Just(i64::MIN),
            Just(i64::MAX),
        ]
    };
    (place(), place()).prop_map(|(column, row)| Site { column, row })
}

fn opened(generator: Generator, seed: u64, site: Site) -> (Window, World) {
    let level = generator.level(seed, Extent::Endless).unwrap();
    Window::open(level, site).unwrap()
}

fn picture(world: &World, camera: &Camera) -> Frame {
    let mut frame = Frame::new(FrameSize::new(60, 40).unwrap(), PixelAspect::SQUARE);
    Renderer::new().render(world, camera, &mut frame);
    frame
}

fn start_cell(world: &World) -> (u32, u32) {
    (world.start().cell.column, world.start().cell.row)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn the_start_is_in_the_middle(generator in generator(), seed: u64, site in site()) {
        let (window, world) = opened(generator, seed, site);
        let (column, row) = start_cell(&world);
        prop_assert!(MIDDLE.contains(&column) && MIDDLE.contains(&row));
        prop_assert_eq!(window.site(world.start().cell).chunk().0, site.chunk().0);
    }

    #[test]
    fn a_window_shows_the_same_whatever_its_path(
        generator in generator(),
        seed: u64,
        site in site(),
        ways in prop::collection::vec((70_u32..122, 70_u32..122), 1..4),
    ) {
        let (mut window, mut world) = opened(generator, seed, site);
        for (column, row) in ways {
            window.follow(&mut world, Cell { column, row });
        }
        let mut fresh = window.clone();
        fresh.chunks =
            every_chunk(window.first).map(|(_, index)| window.level.chunk(index)).collect();
        let mut afresh = window.level.tileset().world();
        fresh.draw(&mut afresh, |_| world.start());
        prop_assert!(world == afresh);
    }

    #[test]
    fn moving_a_window_changes_no_picture(
        generator in generator(),
        seed: u64,
        site in site(),
        degrees in 0.0..360.0,
        offset in (0.3..0.7, 0.3..0.7),
    ) {
        let (mut window, mut world) = opened(generator, seed, site);
        let cell = world.start().cell;
        let position = cell.center() - 0.5 + DVec2::from(offset);
        let heading = Heading::from_degrees(degrees).unwrap();
        let camera = |position: DVec2, world: &World| {
            let camera = Camera::new(position, heading, FieldOfView::default()).unwrap();
            let floor = world.floor_at(Cell::at(position));
            camera.with_eye(floor + Camera::STANDING).unwrap()
        };
        let before = picture(&world, &camera(position, &world));
        // A player in this other cell makes the window move.
        let elsewhere = Cell {
            column: if cell.column < CENTER.column { MIDDLE.start - 1 } else { MIDDLE.end },
            row: cell.row,
        };
        let shift = window.follow(&mut world, elsewhere).unwrap();
        let moved = shift.position(position);
        prop_assert_eq!(moved - position, DVec2::new(shift.columns as f64, shift.rows as f64));
        let after = picture(&world, &camera(moved, &world));
        prop_assert!(before.rows().eq(after.rows()));
    }
}

#[test]
fn the_start_is_never_in_a_door() {
    let level = Generator::Office.level(7, Extent::Endless).unwrap();
    let home = level.chunk(ChunkIndex::default());
    let cells = (0..CHUNK_SIDE).flat_map(|row| (0..CHUNK_SIDE).map(move |column| (column, row)));
    let doors: Vec<_> =
        cells.filter(|&(column, row)| matches!(home.get(column, row), b'+' | b'=')).collect();
    assert!(!doors.is_empty());
    for (column, row) in doors {
        let door = Site { column: column as i64, row: row as i64 };
        assert_eq!(level.start_near(door), level.start_near(Site::default()));
    }
}

#[test]
fn a_finite_level_has_nothing_outside() {
    let level = Generator::Maze.level(7, Extent::new(64, 64).unwrap()).unwrap();
    for (column, row) in [(-1, 5), (5, -40), (200, 5), (i64::MAX, i64::MIN)] {
        assert_eq!(Window::open(level.clone(), Site { column, row }), None);
    }
}
