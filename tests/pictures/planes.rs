//! Floor and ceiling compared with geometry: the colour of every pixel is computed from the camera
//! alone, except near the edges of texels, tiles and walls.

use crate::geometry::camera;
use cellcaster::cast::{Caster, Exact, Ray};
use cellcaster::color::Rgb;
use cellcaster::map;
use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{
    Camera, Ceiling, Cell, Covering, FieldOfView, Light, Opening, Paint, Pattern, Pitch, World,
};
use glam::DVec2;
use proptest::prelude::*;

const MAP: &str = r##"
floor   = { checker = ["tile", "#203040"], scale = 1.5 }
ceiling = { stripes = ["moss", "marble"] }
grid = '''
#########
#.......#
#.,,..%.#
@.,,....#
#....d..#
#.......#
#########
'''
[tiles]
"#" = { wall = "#ff00ff" }
"%" = { wall = "#ff00ff" }
"," = { floor = { texture = "wood", scale = 0.7 }, ceiling = "#405060" }
"d" = { light = 0.5 }
[things]
"@" = { start = 0 }
"##;

/// Points closer than this to an edge, in cells or texels, are not compared.
const DOUBTFUL: f64 = 1e-5;

/// The colour of `covering` at a point of the map; `None` near an edge.
fn color(world: &World, covering: Covering, point: DVec2) -> Option<Rgb> {
    let place = point / covering.scale.cells();
    let piece = place.floor();
    let share = place - piece;
    let paint = match covering.pattern {
        Pattern::Plain(paint) => paint,
        Pattern::Checker(paints) => paints[(piece.x + piece.y).rem_euclid(2.0) as usize],
        Pattern::Stripes(paints) => paints[piece.y.rem_euclid(2.0) as usize],
    };
    if near_a_line(place) {
        return None;
    }
    match paint {
        Paint::Color(color) => Some(color),
        Paint::Texture(id) => {
            let texture = world.texture(id);
            let size = DVec2::new(f64::from(texture.width()), f64::from(texture.height()));
            let texel = share * size;
            (!near_a_line(texel)).then(|| texture.column(share.x)[texel.y as usize])
        }
    }
}

fn near_a_line(place: DVec2) -> bool {
    (place - place.round()).abs().min_element() < DOUBTFUL
}

/// The colour of the pixel `(x, y)` if it shows floor or ceiling. `None` if it shows anything else,
/// and near an edge.
fn expected(world: &World, camera: &Camera, frame: &Frame, x: u32, y: u32) -> Option<Rgb> {
    let (width, height) = (f64::from(frame.width()), f64::from(frame.height()));
    let half_width = camera.field_of_view.half_width();
    let focal = width / 2.0 / half_width / frame.pixel_aspect().height_over_width();
    let horizon = height / 2.0 + (camera.pitch.slope() * focal).round();
    let below = f64::from(y) + 0.5 - horizon;
    let to_plane = if below > 0.0 { camera.eye() } else { 1.0 - camera.eye() };
    let distance = to_plane * focal / below.abs();
    let across = (f64::from(x) + 0.5) * 2.0 / width - 1.0;
    let direction = camera.direction() + camera.plane() * across;
    let hit = Exact.cast(world.grid(), &Ray::new(camera.position(), direction).unwrap());
    if below == 0.0 || hit.is_none_or(|hit| distance > hit.t * (1.0 - DOUBTFUL)) {
        return None;
    }
    let point = camera.position() + direction * distance;
    if near_a_line(point) || point.min_element() < 0.0 {
        return None;
    }
    let tile = world.grid().tile(point.x as i64, point.y as i64)?;
    let tile = world.tile(tile);
    let covering = match tile.ceiling {
        _ if below > 0.0 => tile.floor,
        Ceiling::Covered(covering) => covering,
        Ceiling::Sky => return None,
    };
    let color = color(world, covering, point)?;
    Some(if tile.light == Light::new(0.5) { color.halved() } else { color })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_pixel_shows_the_texel_at_its_centre(
        position in (1.0..8.0, 1.0..6.0),
        degrees in prop_oneof![0.0..360.0, (0..8).prop_map(|eighth| 45.0 * f64::from(eighth))],
        field_of_view in 30.0..=120.0,
        size in (1_u32..120, 1_u32..120),
        aspect in prop_oneof![Just(1.0), Just(2.0), 0.3..4.0],
        eye in prop_oneof![Just(0.5), 0.02..0.98],
        pitch in prop_oneof![Just(0.0), -30.0..=30.0],
    ) {
        let world = map::parse_str(MAP).unwrap();
        let camera = camera(position, degrees, field_of_view);
        let camera = camera.with_eye(eye).unwrap().with_pitch(Pitch::from_degrees(pitch).unwrap());
        let size = FrameSize::new(size.0, size.1).unwrap();
        let mut frame = Frame::new(size, PixelAspect::new(aspect).unwrap());
        let mut renderer = Renderer::new();
        renderer.set_filter(Filter::Nearest);
        renderer.render(&world, &camera, &mut frame);
        for (x, y) in (0..frame.width()).flat_map(|x| (0..frame.height()).map(move |y| (x, y))) {
            if let Some(color) = expected(&world, &camera, &frame, x, y) {
                prop_assert_eq!(frame.pixel(x, y), color, "at ({}, {})", x, y);
            }
        }
    }
}

/// Most pixels are compared, so the property above is meaningful.
#[test]
fn most_pixels_are_certain() {
    let world = map::parse_str(MAP).unwrap();
    let camera = world.start_camera(FieldOfView::default());
    let frame = Frame::new(FrameSize::new(80, 48).unwrap(), PixelAspect::SQUARE);
    let certain = (0..80)
        .flat_map(|x| (0..48).map(move |y| (x, y)))
        .filter(|&(x, y)| expected(&world, &camera, &frame, x, y).is_some())
        .count();
    assert!(certain > 80 * 48 / 2, "{certain}");
}

/// From the middle of a cell, some pixels show exactly the line between floor and wall.
#[test]
fn the_foot_of_a_wall_is_as_dark_as_the_floor_in_front() {
    const ROOM: &str = r##"
light = 0.5
floor = "#ffffff"
ceiling = "#ffffff"
grid = """
########
#......#
#......#
#@.....#
#......#
########
"""
tiles."#".wall = "#000000"
things."@".start = 0
"##;
    let world = map::parse_str(ROOM).unwrap();
    let camera = world.start_camera(FieldOfView::default());
    let mut frame = Frame::new(FrameSize::new(80, 48).unwrap(), PixelAspect::SQUARE);
    Renderer::new().render(&world, &camera, &mut frame);
    let brightest = frame.rows().flatten().map(|pixel| pixel.red()).max().unwrap();
    assert!((120..=128).contains(&brightest), "{brightest}");
}

/// The floor and the ceiling of a cell in the middle of a corridor are visible.
#[test]
fn floor_and_ceiling_show_around_a_door_glass_or_mask() {
    const FLOOR: Rgb = Rgb::new(200, 10, 10);
    const CEILING: Rgb = Rgb::new(10, 10, 200);
    for tile in ["door = \"oak\"", "glass = \"#808080\", opacity = 0.0", "mask = \"fence\""] {
        for uneven in ["", "ceiling_height = 1.5\n"] {
            let text = format!(
                "{uneven}grid = '''\n#######\n#@.+..#\n#######\n'''\n[tiles]\n\
                 \"#\" = {{ wall = \"brick\" }}\n\
                 \"+\" = {{ {tile}, floor = \"{FLOOR}\", ceiling = \"{CEILING}\" }}\n\
                 [things]\n\"@\" = {{ start = 0 }}\n"
            );
            let mut world = map::parse_str(&text).unwrap_or_else(|faults| panic!("{faults}"));
            world.set_opening(Cell { column: 3, row: 1 }, Opening::OPEN);
            let size = FrameSize::new(80, 60).unwrap();
            let mut frame = Frame::new(size, PixelAspect::SQUARE);
            let camera = world.start_camera(FieldOfView::default());
            Renderer::new().render(&world, &camera, &mut frame);
            for color in [FLOOR, CEILING] {
                assert!(frame.rows().flatten().any(|&pixel| pixel == color), "{tile}, {color}");
            }
        }
    }
}
