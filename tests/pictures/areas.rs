//! The area filter: the share of each pixel that a wall covers, compared with many rays for each
//! column of pixels.

use std::num::NonZero;

use cellcaster::cast::{Caster, Exact, Hit, Ray, Side};
use cellcaster::color::Rgb;
use cellcaster::map;
use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{Camera, FieldOfView, Heading, World};
use proptest::prelude::*;

const WIDTH: u32 = 60;
const HEIGHT: u32 = 40;
/// The number of rays for each column of pixels.
const RAYS: u32 = 1024;

const WALL: Rgb = Rgb::new(0xe0, 0x80, 0x30);
const PLANE: Rgb = Rgb::new(0x20, 0x40, 0xc0);

fn world() -> World {
    let text = format!(
        "floor = '{PLANE}'\nceiling = '{PLANE}'\n\
         grid = '''\n\
         ##########\n\
         #........#\n\
         #..##....#\n\
         #........#\n\
         #......#.#\n\
         #.#......#\n\
         #.@...#..#\n\
         #........#\n\
         ##########\n\
         '''\n\
         tiles.'#'.wall = '{WALL}'\nthings.'@'.start = 0\n"
    );
    map::parse_str(&text).unwrap()
}

fn frame_of(world: &World, camera: &Camera, filter: Filter) -> Frame {
    let size = FrameSize::new(WIDTH, HEIGHT).unwrap();
    let mut frame = Frame::new(size, PixelAspect::SQUARE);
    let mut renderer = Renderer::new();
    renderer.set_filter(filter);
    renderer.render(world, camera, &mut frame);
    frame
}

/// The hit `place` columns from the left edge of the picture.
fn hit(world: &World, camera: &Camera, place: f64) -> Hit {
    let across = 2.0 * place / f64::from(WIDTH) - 1.0;
    let direction = camera.direction() + camera.plane() * across;
    Exact.cast(world.grid(), &Ray::new(camera.position(), direction).unwrap()).unwrap()
}

fn is_one_face(one: &Hit, other: &Hit) -> bool {
    let line = |hit: &Hit| match hit.side {
        Side::X => (hit.side, hit.cell.column),
        Side::Y => (hit.side, hit.cell.row),
    };
    line(one) == line(other)
}

fn linear(channel: u8) -> f64 {
    let signal = f64::from(channel) / 255.0;
    if signal <= 0.040_45 { signal / 12.92 } else { ((signal + 0.055) / 1.055).powf(2.4) }
}

fn encoded(light: f64) -> f64 {
    255.0 * if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

/// The colours of a column of pixels, computed from many rays. `None` if the column shows a wall
/// that neither its own ray nor a ray of a neighbouring column hits.
fn column(world: &World, camera: &Camera, x: u32) -> Option<Vec<[f64; 3]>> {
    let middle = f64::from(x) + 0.5;
    let known = [middle - 1.0, middle, middle + 1.0]
        .map(|place| place.clamp(0.5, f64::from(WIDTH) - 0.5))
        .map(|place| hit(world, camera, place));
    let mut light = vec![[0.0; 3]; HEIGHT as usize];
    let focal_length = f64::from(WIDTH) / 2.0 / camera.field_of_view.half_width();
    for ray in 0..RAYS {
        let part = (f64::from(ray) + 0.5) / f64::from(RAYS);
        let hit = hit(world, camera, f64::from(x) + part);
        let beside = if part < 0.5 { &known[0] } else { &known[2] };
        if !is_one_face(&hit, beside) && !is_one_face(&hit, &known[1]) {
            return None;
        }
        let half = 0.5 * focal_length / hit.t;
        let (top, bottom) = (f64::from(HEIGHT) / 2.0 - half, f64::from(HEIGHT) / 2.0 + half);
        let wall = if hit.side == Side::Y { WALL.halved() } else { WALL };
        for (row, light) in (0..HEIGHT).map(f64::from).zip(&mut light) {
            let share = (bottom.min(row + 1.0) - top.max(row)).max(0.0);
            for (light, (wall, plane)) in
                light.iter_mut().zip(wall.channels().into_iter().zip(PLANE.channels()))
            {
                let sum = share * linear(wall) + (1.0 - share) * linear(plane);
                *light += sum / f64::from(RAYS);
            }
        }
    }
    Some(light.into_iter().map(|light| light.map(encoded)).collect())
}

/// Compares a frame by areas with many rays; returns the number of compared columns.
fn compare(world: &World, camera: &Camera) -> u32 {
    let frame = frame_of(world, camera, Filter::Area);
    let mut compared = 0;
    for x in 0..WIDTH {
        let Some(expected) = column(world, camera, x) else { continue };
        compared += 1;
        for (y, expected) in (0..HEIGHT).zip(expected) {
            for (shown, expected) in frame.pixel(x, y).channels().into_iter().zip(expected) {
                let off = (f64::from(shown) - expected).abs();
                assert!(off <= 2.0, "({x}, {y}) is off by {off}");
            }
        }
    }
    compared
}

/// Before, the end of a wall that recedes steeply within a column was taken for the start of the wall behind it.
#[test]
fn a_wall_at_a_grazing_angle_covers_its_part_of_a_column() {
    let heading = Heading::from_degrees(162.181_363_700_201_2).unwrap();
    let position = (8.634_150_278_886_262, 1.965_502_565_830_958_4).into();
    let camera = Camera::new(position, heading, FieldOfView::default()).unwrap();
    assert!(compare(&world(), &camera) > WIDTH * 9 / 10);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_pixel_mixes_the_light_of_the_walls_that_cover_it(
        position in (1.1..8.9, 1.1..7.9),
        degrees in 0.0..360.0,
    ) {
        let world = world();
        prop_assume!(!world.grid().is_solid(position.0 as i64, position.1 as i64));
        let heading = Heading::from_degrees(degrees).unwrap();
        let camera = Camera::new(position.into(), heading, FieldOfView::default()).unwrap();
        let compared = compare(&world, &camera);
        prop_assert!(compared > WIDTH * 9 / 10, "{compared} columns");
    }
}

#[test]
fn several_threads_draw_the_same_areas() {
    for level in ["museum", "citadel"] {
        let world = map::load(format!("tests/maps/{level}.toml").as_ref()).unwrap();
        let camera = world.start_camera(FieldOfView::default());
        let mut frames = [1, 2, 3].map(|threads| {
            let mut frame = Frame::new(FrameSize::new(2003, 1201).unwrap(), PixelAspect::SQUARE);
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
fn only_area_filtering_smooths_wall_ends() {
    let world = world();
    let camera = Camera::new(
        (2.3, 3.4).into(),
        Heading::from_degrees(20.0).unwrap(),
        FieldOfView::default(),
    );
    let plain = [WALL, WALL.halved(), PLANE];
    let mixed = |filter| {
        let frame = frame_of(&world, &camera.unwrap(), filter);
        frame.rows().flatten().filter(|pixel| !plain.contains(pixel)).count()
    };
    assert_eq!((mixed(Filter::Mip), mixed(Filter::Nearest)), (0, 0));
    assert!(mixed(Filter::Area) > WIDTH as usize);
}
