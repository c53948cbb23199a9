//! The area filter: the mean light of nine samples in each pixel.

use std::fs;
use std::num::NonZero;

use cellcaster::color::Rgb;
use cellcaster::map;
use cellcaster::map::builtin;
use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{Camera, FieldOfView, Pitch, World};

const SIDE: u32 = 3;

fn frame_of(world: &World, camera: &Camera, (width, height): (u32, u32), filter: Filter) -> Frame {
    let size = FrameSize::new(width, height).unwrap();
    let mut frame = Frame::new(size, PixelAspect::SQUARE);
    let mut renderer = Renderer::new();
    renderer.set_filter(filter);
    renderer.render(world, camera, &mut frame);
    frame
}

fn linear(channel: u8) -> f64 {
    let signal = f64::from(channel) / 255.0;
    if signal <= 0.040_45 { signal / 12.92 } else { ((signal + 0.055) / 1.055).powf(2.4) }
}

fn encoded(light: f64) -> f64 {
    255.0 * if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

/// The mean light of the pixels of `frame` that are samples of pixel `(x, y)`.
fn mean(frame: &Frame, x: u32, y: u32) -> [f64; 3] {
    let mut light = [0.0; 3];
    for (column, row) in (0..SIDE * SIDE).map(|sample| (sample % SIDE, sample / SIDE)) {
        let sample = frame.pixel(SIDE * x + column, SIDE * y + row);
        for (sum, channel) in light.iter_mut().zip(sample.channels()) {
            *sum += linear(channel) / f64::from(SIDE * SIDE);
        }
    }
    light.map(encoded)
}

/// The maps of the gallery that have a grid.
fn gallery() -> impl Iterator<Item = World> {
    let files = fs::read_dir("maps/gallery").unwrap().map(|entry| entry.unwrap().path());
    files.filter_map(|file| map::load(&file).ok())
}

#[test]
fn a_pixel_shows_the_mean_light_of_nine_samples() {
    let levels = builtin::LEVELS.iter().map(|level| level.world().unwrap());
    for world in levels.chain(gallery()) {
        let (width, height) = (53, 30);
        let camera = world.start_camera(FieldOfView::default());
        let frame = frame_of(&world, &camera, (width, height), Filter::Area);
        let samples = frame_of(&world, &camera, (SIDE * width, SIDE * height), Filter::Mip);
        for (x, y) in (0..width * height).map(|pixel| (pixel % width, pixel / width)) {
            let shown = frame.pixel(x, y).channels().map(f64::from);
            for (shown, expected) in shown.into_iter().zip(mean(&samples, x, y)) {
                assert!((shown - expected).abs() < 0.6, "{shown} at ({x}, {y}), not {expected}");
            }
        }
    }
}

#[test]
fn surfaces_and_distances_are_those_of_the_middles_of_pixels() {
    for level in builtin::LEVELS {
        let world = level.world().unwrap();
        let camera = world.start_camera(FieldOfView::default());
        let [pixels, samples] = [(1, Filter::Area), (SIDE, Filter::Mip)].map(|(side, filter)| {
            let size = FrameSize::new(53 * side, 30 * side).unwrap();
            let mut renderer = Renderer::new();
            renderer.set_filter(filter);
            renderer.keep_surfaces(true);
            renderer.render(&world, &camera, &mut Frame::new(size, PixelAspect::SQUARE));
            renderer
        });
        let middle = |pixel: u32| SIDE * pixel + SIDE / 2;
        for (x, y) in (0..53 * 30).map(|pixel| (pixel % 53, pixel / 53)) {
            assert_eq!(pixels.surface(x, y), samples.surface(middle(x), middle(y)));
        }
        assert_eq!(pixels.surface(53, 0), None);
        let distances = samples.distances().iter().skip(1).step_by(3);
        assert!(pixels.distances().iter().eq(distances), "{}", level.name);
    }
}

#[test]
fn looking_up_moves_the_picture_by_whole_pixels() {
    let world = builtin::LEVELS[0].world().unwrap();
    let mut camera = world.start_camera(FieldOfView::default());
    camera.heading = camera.heading.turned(0.7);
    let level = frame_of(&world, &camera, (80, 48), Filter::Area);
    for degrees in [-7.0, 3.0, 11.0] {
        let camera = camera.with_pitch(Pitch::from_degrees(degrees).unwrap());
        let shown = frame_of(&world, &camera, (80, 48), Filter::Area);
        let focal_length = 40.0 / camera.field_of_view.half_width();
        let rows = (f64::to_radians(degrees).tan() * focal_length).round() as i64;
        for row in (0..48).filter(|row| (0..48).contains(&(row - rows))) {
            assert!(shown.row(row as u32).eq(level.row((row - rows) as u32)), "{degrees}: {row}");
        }
    }
}

#[test]
fn several_threads_draw_the_same_areas() {
    for level in ["museum", "citadel"] {
        let world = map::load(format!("tests/maps/{level}.toml").as_ref()).unwrap();
        let camera = world.start_camera(FieldOfView::default());
        let mut frames = [1, 2, 3].map(|threads| {
            let mut frame = Frame::new(FrameSize::new(803, 601).unwrap(), PixelAspect::SQUARE);
            let mut renderer = Renderer::new();
            renderer.set_threads(NonZero::new(threads).unwrap());
            renderer.set_filter(Filter::Area);
            renderer.render(&world, &camera, &mut frame);
            frame
        });
        let [one, others @ ..] = &mut frames;
        assert!(others.iter().all(|other| other == one), "{level}");
    }
}

#[test]
fn only_area_filtering_smooths_edges() {
    let [wall, plane] = [Rgb::new(0xe0, 0x80, 0x30), Rgb::new(0x20, 0x40, 0xc0)];
    let world = map::parse_str(&format!(
        "floor = '{plane}'\nceiling = '{plane}'\n\
         grid = '''\n#######\n#@....#\n#..o..#\n#######\n'''\n\
         tiles.'#'.wall = '{wall}'\n\
         tiles.o = {{ pillar = '{wall}', height = 0.4 }}\n\
         things.'@'.start = 20\n"
    ));
    let world = world.unwrap();
    let camera = world.start_camera(FieldOfView::default());
    let colors = |filter| {
        let frame = frame_of(&world, &camera, (60, 40), filter);
        let mut colors: Vec<_> = frame.rows().flatten().copied().collect();
        colors.sort_unstable_by_key(|color| color.channels());
        colors.dedup();
        colors.len()
    };
    let [mip, nearest, area] = [Filter::Mip, Filter::Nearest, Filter::Area].map(colors);
    assert_eq!(mip, nearest);
    assert!(area > mip + 20, "{mip} {area}");
}
