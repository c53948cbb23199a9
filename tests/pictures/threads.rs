//! Several threads draw the same frame as one, bit for bit, with the same counts.

use std::num::NonZero;
use std::path::PathBuf;

use cellcaster::map::{self, Level, builtin};
use cellcaster::render::{
    Frame, FrameSize, OneThreadReason, PixelAspect, Renderer, Surface, Threads,
};
use cellcaster::world::{Camera, Cell, FieldOfView, Opening, Pitch, World};

/// Large enough for seven threads, with a height that no tested number of threads divides.
const WIDTH: u32 = 2555;
const HEIGHT: u32 = 1441;

/// All levels, and all maps of the gallery with a grid, with doors ajar.
fn worlds() -> Vec<(String, World)> {
    let builtin =
        builtin::LEVELS.iter().map(|level| (level.name.to_owned(), level.world().unwrap()));
    let mut files: Vec<PathBuf> =
        std::fs::read_dir("maps/gallery").unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let gallery = files.into_iter().filter_map(|path| match map::load_level(&path).unwrap() {
        Level::Grid(world) => Some((path.display().to_string(), *world)),
        Level::Space(_) => None,
    });
    let mut worlds: Vec<_> = builtin.chain(gallery).collect();
    for (_, world) in &mut worlds {
        let (width, height) = (world.grid().width(), world.grid().height());
        for (column, row) in (0..width).flat_map(|column| (0..height).map(move |row| (column, row)))
        {
            world.set_opening(Cell { column, row }, Opening::new(0.4).unwrap());
        }
    }
    worlds
}

fn frame() -> Frame {
    Frame::new(FrameSize::new(WIDTH, HEIGHT).unwrap(), PixelAspect::SQUARE)
}

fn renderer(threads: usize) -> Renderer {
    let mut renderer = Renderer::new();
    renderer.set_threads(NonZero::new(threads).unwrap());
    renderer.keep_surfaces(true);
    renderer.set_time(0.3);
    renderer
}

/// The surfaces of some pixels, in rows at and between the edges of bands.
fn surfaces(renderer: &Renderer) -> Vec<Option<Surface>> {
    let columns = || (0..WIDTH).step_by(5);
    (0..HEIGHT)
        .flat_map(|y| columns().map(move |x| (x, y)))
        .map(|(x, y)| renderer.surface(x, y))
        .collect()
}

fn views(world: &World) -> [Camera; 2] {
    let ahead = world.start_camera(FieldOfView::default());
    let mut aside = ahead;
    aside.heading = ahead.heading.turned(2.0);
    aside.pitch = Pitch::from_degrees(-14.0).unwrap();
    [ahead, aside]
}

#[test]
fn any_number_of_threads_draws_the_same_frame() {
    for (name, world) in worlds() {
        for camera in views(&world) {
            let mut expected = frame();
            let mut alone = renderer(1);
            let explained = alone.explain(&world, &camera, &mut expected);
            assert_eq!(explained.threads, Threads::One(OneThreadReason::Only), "{name}");
            let surfaces_alone = surfaces(&alone);
            for count in [2, 3, 7] {
                let (mut drawn, mut several) = (frame(), renderer(count));
                let stats = several.explain(&world, &camera, &mut drawn).stats;
                assert!(drawn == expected, "{name}, {count} threads");
                assert_eq!(stats, explained.stats, "{name}, {count} threads");
                assert_eq!(several.next_change(), alone.next_change(), "{name}, {count} threads");
                assert!(surfaces(&several) == surfaces_alone, "{name}, {count} threads");
            }
        }
    }
}

#[test]
fn only_large_pictures_use_threads() {
    let world = &worlds()[0].1;
    let camera = world.start_camera(FieldOfView::default());
    let mut small = Frame::new(FrameSize::new(160, 90).unwrap(), PixelAspect::SQUARE);
    let threads = |frame: &mut Frame| renderer(7).explain(world, &camera, frame).threads;
    assert_eq!(threads(&mut small), Threads::One(OneThreadReason::Small));
    assert_eq!(threads(&mut frame()), Threads::Bands(NonZero::new(7).unwrap()));
}
