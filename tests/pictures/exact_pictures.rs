//! Pictures compared with exact geometry: every pixel of a map with plain colours is computed again
//! in rational arithmetic, from the camera alone, by testing all faces of all walls.

mod geometry;

use std::path::Path;

use crate::geometry::camera;
use cellcaster::color::Rgb;
use cellcaster::map;
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{Camera, FieldOfView, Heading};
use glam::DVec2;
use proptest::prelude::*;

use geometry::Geometry;

const MAP: &str = r##"
floor   = "#102030"
ceiling = "#405060"
sky     = { gradient = ["#87b5d9", "#87b5d9"] }
grid = '''
aaabbbc
b.....c
a..d..a
@.....a
c.dc..b
b.....b
aa.accc
'''
[tiles]
"a" = { wall = "#ff0102" }
"b" = { wall = "#03fe04" }
"c" = { wall = "#0506fd" }
"d" = { wall = "#fcfb07" }
[things]
"@" = { start = 0 }
"##;

const FLOOR: Rgb = Rgb::new(0x10, 0x20, 0x30);
const CEILING: Rgb = Rgb::new(0x40, 0x50, 0x60);

/// The same map with floors of different brightness, and a wall with a brightness of its own.
fn lit_map() -> String {
    let cells = MAP
        .replace("b.....c\na..d", "be..f.c\na.fd")
        .replace("c.dc..b\nb.....b", "cedc.eb\nbf..ffb");
    let d = r##""d" = { wall = "#fcfb07" }"##;
    let lit = "\"e\" = { light = 0.2 }\n\"f\" = { light = 0.9 }\n\"d\" = { wall = \"#fcfb07\", light = 0.7 }";
    assert!(cells.contains(d));
    cells.replace(d, lit).replace("floor   =", "light = 0.5\nfloor   =")
}

/// Pixels whose centres are closer than this to an edge, in pixels, are not compared.
const DOUBTFUL: f64 = 1e-6;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn every_pixel_is_where_geometry_says(
        position in (0.0..7.0, 0.0..7.0),
        degrees in prop_oneof![0.0..360.0, (0..8).prop_map(|eighth| 45.0 * f64::from(eighth))],
        field_of_view in prop_oneof![8 => 30.0..=120.0, 1 => Just(0.001), 1 => Just(179.9)],
        size in (1_u32..24, 1_u32..24),
        aspect in prop_oneof![Just(1.0), Just(2.0), 0.3..4.0],
    ) {
        let world = map::parse_str(MAP).unwrap();
        let camera = camera(position, degrees, field_of_view);
        let pixel_aspect = PixelAspect::new(aspect).unwrap();
        let mut frame = Frame::new(FrameSize::new(size.0, size.1).unwrap(), pixel_aspect);
        Renderer::new().render(&world, &camera, &mut frame);

        let geometry = Geometry::new(&world, &camera, &frame);
        for (x, y) in (0..size.0).flat_map(|x| (0..size.1).map(move |y| (x, y))) {
            if let Some(color) = geometry.color(x, y) {
                prop_assert_eq!(frame.pixel(x, y), color, "at ({}, {})", x, y);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Along a wall, the light is interpolated between the middles of the cells in front of it.
    #[test]
    fn every_pixel_of_a_wall_is_as_bright_as_geometry_says(
        position in (1.1..5.9, 1.1..5.9),
        degrees in 0.0..360.0,
        size in (1_u32..24, 1_u32..12),
    ) {
        let world = map::parse_str(&lit_map()).unwrap();
        let heading = Heading::from_degrees(degrees).unwrap();
        let camera = Camera::new(position.into(), heading, FieldOfView::default()).unwrap();
        let mut frame = Frame::new(FrameSize::new(size.0, size.1).unwrap(), PixelAspect::SQUARE);
        Renderer::new().render(&world, &camera, &mut frame);
        let geometry = Geometry::new(&world, &camera, &frame);
        for (x, y) in (0..size.0).flat_map(|x| (0..size.1).map(move |y| (x, y))) {
            if let Some(color) = geometry.lit_color(x, y) {
                prop_assert_eq!(frame.pixel(x, y), color, "at ({}, {})", x, y);
            }
        }
    }
}

#[test]
fn a_huge_picture_is_as_exact_as_a_small_one() {
    let world = map::parse_str(MAP).unwrap();
    let heading = Heading::from_degrees(33.0).unwrap();
    let camera = Camera::new(DVec2::new(1.7, 2.4), heading, FieldOfView::default()).unwrap();
    let mut frame = Frame::new(FrameSize::new(4000, 2000).unwrap(), PixelAspect::SQUARE);
    Renderer::new().render(&world, &camera, &mut frame);
    let geometry = Geometry::new(&world, &camera, &frame);
    let mut compared = 0;
    for (x, y) in (0..4000).step_by(97).flat_map(|x| (0..2000).step_by(211).map(move |y| (x, y))) {
        if let Some(color) = geometry.color(x, y) {
            assert_eq!(frame.pixel(x, y), color, "at ({x}, {y})");
            compared += 1;
        }
    }
    assert!(compared > 400);
}

#[test]
fn a_very_close_wall_shows_the_texels_at_eye_height() {
    // The texture has 64 rows, and the red channel of each row is its number. The wall's face is at
    // x = 0.
    let world = map::load(Path::new("tests/maps/nose.toml")).unwrap();
    let mut frame = Frame::new(FrameSize::new(40, 24).unwrap(), PixelAspect::SQUARE);
    for gap in [1e-12, 1e-30, 1e-300, 5e-324] {
        let position = DVec2::new(-gap, 0.5);
        let camera = Camera::new(position, Heading::default(), FieldOfView::default()).unwrap();
        Renderer::new().render(&world, &camera, &mut frame);
        for (y, row) in frame.rows().enumerate() {
            let texel = if y < 12 { 31 } else { 32 };
            assert!(row.iter().all(|pixel| pixel.red() == texel), "row {y}, {gap} from the wall");
        }
    }
}

#[test]
fn a_distance_of_zero_is_never_negative() {
    let world = map::load(Path::new("maps/gallery/stripes.toml")).unwrap();
    let mut frame = Frame::new(FrameSize::new(64, 40).unwrap(), PixelAspect::SQUARE);
    let mut renderer = Renderer::new();
    for degrees in [135.0, 180.0, 225.0, 270.0] {
        let heading = Heading::from_degrees(degrees).unwrap();
        let position = DVec2::new(1.0, -0.0);
        let camera = Camera::new(position, heading, FieldOfView::default()).unwrap();
        renderer.render(&world, &camera, &mut frame);
        let distances = renderer.distances();
        assert!(distances.contains(&0.0));
        assert!(distances.iter().all(|distance| distance.is_sign_positive()), "{degrees}");
    }
}
