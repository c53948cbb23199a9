//! Pictures with heights, mirrors, sprites, light, fog and mip levels. Each is compared with
//! another method that finds the same pixels.
//!
//! Heights are compared with the 3-D caster, which treats each cell as a box and shares no code
//! with them. A mirror is compared with a copy of the room behind it, built in reverse. A sprite is
//! a rectangle on the plane through its place that faces the camera. Light and fog are compared with
//! their definition in real numbers.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::hint::black_box;

use glam::{DVec2, DVec3};

use super::{Feature, Outcome};
use cellcaster::color::Rgb;
use cellcaster::map::{self, TextureFileError, TextureFiles};
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer, Surface};
use cellcaster::rng::SplitMix64;
use cellcaster::space::{Block, Body, BodyShape, Ray, Scene, SolidTexture};
use cellcaster::world::{Camera, FieldOfView, Fog, Heading, World};

/// The width and the height of the pictures.
const WIDTH: u32 = 160;
const HEIGHT: u32 = 90;
/// The number of pictures with heights, mirrors and sprites.
const PICTURES: usize = 12;
/// The directions of the other pictures, in degrees.
const HEADINGS: [f64; 6] = [0.0, 33.0, 101.0, 170.0, 222.0, 295.0];

pub(crate) fn features(seed: u64) -> Vec<Feature> {
    vec![
        heights(seed),
        mirrors(seed),
        sprites(seed),
        lit("light", None),
        lit("fog", Fog::new(FOG, FOG_DISTANCE)),
        mip_levels(),
    ]
}

/// The texture files of the maps.
struct Files;

/// The number of texels along each side of a texture.
const SIDE: u32 = 64;

/// A file is a checker of black and white squares. Its name is the number of texels of a square;
/// without a number, it is all white.
impl TextureFiles for Files {
    fn read(&self, name: &str) -> Result<Vec<u8>, TextureFileError> {
        let square: Option<u32> = name.trim_end_matches(".png").parse().ok();
        let is_white =
            |(x, y): (u32, u32)| square.is_none_or(|it| !(x / it + y / it).is_multiple_of(2));
        let places = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
        let texels: Vec<u8> = places.map(|place| if is_white(place) { 255 } else { 0 }).collect();
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, SIDE, SIDE);
        encoder.set_color(png::ColorType::Grayscale);
        let written =
            encoder.write_header().and_then(|mut writer| writer.write_image_data(&texels));
        written.expect("writing to memory does not fail");
        Ok(bytes)
    }
}

fn parse(text: &str) -> World {
    map::parse(text, "scene", &Files)
        .expect("the maps of this module are sound, and tests parse them")
}

/// A picture of a camera, with the renderer that drew it.
struct Picture<'a> {
    /// The number among the pictures of the feature.
    index: usize,
    camera: &'a Camera,
    frame: Frame,
    renderer: Renderer,
}

impl<'a> Picture<'a> {
    fn new(world: &World, index: usize, camera: &'a Camera) -> Self {
        let (mut frame, mut renderer) = (frame(), Renderer::new());
        renderer.keep_surfaces(true);
        renderer.render(world, camera, &mut frame);
        Self { index, camera, frame, renderer }
    }

    /// The distance of the wall in a column of pixels.
    fn distance(&self, x: u32) -> f64 {
        self.renderer.distances()[x as usize]
    }
}

fn frame() -> Frame {
    let size = FrameSize::new(WIDTH, HEIGHT).expect("a picture has pixels");
    Frame::new(size, PixelAspect::SQUARE)
}

/// A feature whose cases are pixels. `outcome` compares each pixel of each picture, or skips it.
fn feature(
    (name, figure, unit): (&'static str, &'static str, &'static str),
    world: World,
    cameras: Vec<Camera>,
    mut outcome: impl FnMut(&Picture, (u32, u32)) -> Option<Outcome>,
) -> Feature {
    let mut outcomes = Vec::new();
    for (index, camera) in cameras.iter().enumerate() {
        let picture = Picture::new(&world, index, camera);
        let places = (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y)));
        outcomes.extend(places.filter_map(|place| outcome(&picture, place)));
    }
    let (mut renderer, mut frame) = (Renderer::new(), frame());
    let work = move || {
        for camera in &cameras {
            renderer.render(&world, black_box(camera), &mut frame);
        }
    };
    Feature { name, figure, unit, outcomes, work: Box::new(work) }
}

const COLOR: &str = "colour of a pixel";

/// Cameras between `low` and `high`, with an eye height from 0.6 to 2.2, which `at_eye` changes.
fn cameras(low: DVec2, high: DVec2, seed: u64, at_eye: fn(f64) -> f64) -> Vec<Camera> {
    let mut random = SplitMix64::new(seed);
    let mut camera = || {
        let position = DVec2::new(random.between(low.x, high.x), random.between(low.y, high.y));
        let heading = Heading::default().turned(random.between(0.0, TAU));
        let eye = at_eye(random.between(0.6, 2.2));
        Camera::new(position, heading, FieldOfView::default())?.with_eye(eye)
    };
    std::iter::repeat_with(&mut camera).flatten().take(PICTURES).collect()
}

/// Cameras that turn at the start of `world`.
fn cameras_at_start(world: &World) -> Vec<Camera> {
    let start = world.start_camera(FieldOfView::default());
    let headings = HEADINGS.into_iter().filter_map(Heading::from_degrees);
    let turned = |heading| {
        let mut camera = start;
        camera.heading = heading;
        camera
    };
    headings.map(turned).collect()
}

fn focal_length(camera: &Camera) -> f64 {
    f64::from(WIDTH) / 2.0 / camera.field_of_view.half_width()
}

/// The direction through the centre of a column of pixels.
fn ray_of_column(camera: &Camera, x: u32) -> DVec2 {
    let share = 2.0 * (f64::from(x) + 0.5) / f64::from(WIDTH) - 1.0;
    camera.direction() + camera.plane() * share
}

/// The direction through the centre of a pixel, scaled to a distance of 1 to the picture plane.
fn direction(camera: &Camera, (x, y): (u32, u32)) -> DVec3 {
    let up = (f64::from(HEIGHT) / 2.0 - (f64::from(y) + 0.5)) / focal_length(camera);
    ray_of_column(camera, x).extend(up)
}

/// The characters of the tiles with heights, with the height of each and the colours of its top and
/// of its sides.
const TILES: [(char, f64, u32, u32); 5] = [
    ('.', 0.0, 0x20_40_60, 0x20_40_60),
    ('a', 0.25, 0xc0_80_40, 0x80_40_20),
    ('b', 0.5, 0x40_c0_80, 0x20_80_40),
    ('c', 1.25, 0x80_40_c0, 0x40_20_80),
    ('#', 3.0, 0x60_60_a0, 0x60_60_a0),
];
const HEIGHTS: [&str; 8] = [
    "##########",
    "#....a...#",
    "#.b..ab..#",
    "#..c....c#",
    "#.aa..c..#",
    "#.ab.....#",
    "#@..c.aab#",
    "##########",
];

fn heights(seed: u64) -> Feature {
    let mut text =
        "floor = '#204060'\nceiling = 'sky'\nsky = { gradient = ['#010203', '#010203'] }\n\
                    ceiling_height = 3\ngrid = '''\n"
            .to_owned();
    text += &HEIGHTS.join("\n");
    text += "\n'''\n[tiles]\n'#' = { wall = '#6060a0' }\n";
    for (character, height, top, side) in &TILES[1..4] {
        // Writing to a string cannot fail.
        _ = writeln!(
            text,
            "{character} = {{ floor = '#{top:06x}', floor_height = {height}, riser = '#{side:06x}' }}"
        );
    }
    text += "[things]\n'@' = { start = 0 }\n";
    let tile_at = |column: usize, row: usize| {
        let character = HEIGHTS[row].as_bytes()[column] as char;
        TILES.iter().find(|tile| tile.0 == character).unwrap_or(&TILES[0])
    };
    let places: Vec<(usize, usize)> = (0..HEIGHTS.len())
        .flat_map(|row| (0..HEIGHTS[0].len()).map(move |column| (column, row)))
        .collect();
    let texture = SolidTexture::Plain(Rgb::WHITE);
    let bodies = places.iter().filter_map(|&(column, row)| {
        let corner = DVec3::new(column as f64, row as f64, -1.0);
        let height = tile_at(column, row).1 + 1.0;
        let block = Block::new(corner, corner + DVec3::new(1.0, 1.0, height))?;
        Some(Body { shape: BodyShape::Block(block), texture })
    });
    let scene = Scene { bodies: bodies.collect(), ..Scene::default() };
    // The eyes are above the highest floor and below the top of the walls.
    let cameras = cameras(DVec2::splat(1.1), DVec2::new(8.9, 6.9), seed, |eye| eye + 0.7);
    let title = ("heights", COLOR, "");
    feature(title, parse(&text), cameras, |Picture { camera, frame, .. }, (x, y)| {
        let ray = Ray::new(camera.position().extend(camera.eye()), direction(camera, (x, y)));
        let expected = match scene.cast(&ray) {
            None => Rgb::new(1, 2, 3),
            Some(hit) => {
                let (column, row) = places[hit.body];
                let &(_, _, top, side) = tile_at(column, row);
                if hit.normal.z.abs() > 0.5 {
                    rgb(top)
                } else if hit.normal.x.abs() > 0.5 {
                    rgb(side)
                } else {
                    rgb(side).halved()
                }
            }
        };
        Some((frame.pixel(x, y) != expected, None))
    })
}

fn rgb(color: u32) -> Rgb {
    let [_, red, green, blue] = color.to_be_bytes();
    Rgb::new(red, green, blue)
}

fn mirrors(seed: u64) -> Feature {
    const ROOM: [&str; 6] = ["######", "#@.a..", "#.b..c", "#...a.", "#c.b..", "######"];
    let map = |rows: [String; 6]| {
        parse(&format!(
            "floor = '#604830'\nceiling = '#506070'\ngrid = '''\n{}\n'''\n[tiles]\n\
             '#' = {{ wall = '#a07040' }}\na = {{ wall = '#40a070', height = 0.5 }}\n\
             b = {{ floor = '#c0c040' }}\nc = {{ wall = '#7040a0' }}\n\
             M = {{ mirror = '#204060', opacity = 0 }}\n[things]\n'@' = {{ start = 0 }}\n",
            rows.join("\n")
        ))
    };
    let reflected = map(ROOM.map(|row| format!("{row}M")));
    let copied = |row: &str| row.chars().rev().collect::<String>().replace('@', ".");
    let straight = map(ROOM.map(|row| format!("{row}{}", copied(row))));
    let (low, high) = (DVec2::new(1.1, 1.1), DVec2::new(1.9, 3.9));
    let cameras = cameras(low, high, seed, |eye| eye / 4.0 + 0.1);
    let copies: Vec<Frame> =
        cameras.iter().map(|camera| Picture::new(&straight, 0, camera).frame).collect();
    feature(("mirrors", COLOR, ""), reflected, cameras, |picture, (x, y)| {
        // The player's image appears in only one of the two pictures.
        let is_player = picture.renderer.surface(x, y) == Some(Surface::Thing);
        let copy = copies[picture.index].pixel(x, y);
        (!is_player).then(|| (picture.frame.pixel(x, y) != copy, None))
    })
}

fn sprites(seed: u64) -> Feature {
    const SIDE: f64 = 0.625;
    let places = [(3.5, 2.5), (6.5, 5.5), (2.5, 6.5), (7.5, 1.5)].map(DVec2::from);
    let world = parse(
        "floor = '#204060'\nceiling = '#406080'\ngrid = '''\n##########\n#@.....s.#\n#..s.....#\n#........#\n\
         #........#\n#.....s..#\n#.s......#\n#........#\n##########\n'''\n[tiles]\n\
         '#' = { wall = '#804020' }\n[things]\n'@' = { start = 0 }\n\
         s = { sprite = 'white.png', height = 0.625, blocks = false }\n",
    );
    let (low, high) = (DVec2::new(1.1, 1.1), DVec2::new(8.9, 7.9));
    let cameras = cameras(low, high, seed, |eye| eye / 4.0 + 0.1);
    let title = ("sprites", COLOR, "");
    feature(title, world, cameras, |Picture { camera, frame, .. }, (x, y)| {
        let ray = direction(camera, (x, y));
        // In this room, no wall is in front of a sprite, and the sprite's plane has the same
        // distance everywhere.
        let is_on = |place: &DVec2| {
            let way = place - camera.position();
            let depth = way.dot(camera.direction());
            let point = ray * depth;
            let aside = (point.truncate() - way).dot(camera.direction().perp());
            let height = camera.eye() + point.z;
            depth > 0.0 && aside.abs() < SIDE / 2.0 && (0.0..SIDE).contains(&height)
        };
        let expected = places.iter().any(is_on);
        Some(((frame.pixel(x, y) == Rgb::WHITE) != expected, None))
    })
}

/// The room with light, fog and mip levels.
const ROOM: &str = "grid = '''\n############\n#..........#\n#...@......#\n#.......#..#\n#..........#\n\
                    #....#.....#\n#..........#\n############\n'''\n[things]\n'@' = { start = 0 }\n";
const WALL: Rgb = Rgb::new(0xc8, 0x9a, 0x57);
const FLOOR: Rgb = Rgb::new(0x93, 0xb1, 0xe3);
const FOG: Rgb = Rgb::new(0x30, 0x48, 0x6b);
const FOG_DISTANCE: f64 = 4.0;
const LIGHT: f64 = 0.37;

/// The largest error of the three channels of walls and floors. The definition in real numbers is
/// `own · light · clearness + fog · (1 − clearness)`, in which the light of a y-side is halved.
fn lit(name: &'static str, fog: Option<Fog>) -> Feature {
    let fog_text = fog.map_or(String::new(), |fog| {
        format!("fog = {{ color = '{}', distance = {FOG_DISTANCE} }}\n", fog.color)
    });
    let world = parse(&format!(
        "floor = '{FLOOR}'\nceiling = '{FLOOR}'\nlight = {LIGHT}\n{fog_text}{ROOM}[tiles]\n'#' = {{ wall = '{WALL}' }}\n"
    ));
    let cameras = cameras_at_start(&world);
    feature((name, "worst channel of a pixel", "of 255"), world, cameras, |picture, (x, y)| {
        let (own, share, distance) = match picture.renderer.surface(x, y) {
            Some(Surface::WallX) => (WALL, 1.0, picture.distance(x)),
            Some(Surface::WallY) => (WALL, 0.5, picture.distance(x)),
            _ => (FLOOR, 1.0, distance_of_row(picture.camera, y)),
        };
        let clearness = fog.map_or(1.0, |fog| fog.clearness(distance));
        let shown = picture.frame.pixel(x, y);
        let error = |channel: usize| {
            let [own, fog, shown] =
                [own, FOG, shown].map(|color| f64::from(color.channels()[channel]));
            let expected = own * LIGHT * share * clearness + fog * (1.0 - clearness);
            (shown - expected).abs()
        };
        Some((false, (0..3).map(error).reduce(f64::max)))
    })
}

/// The distance of the floor or the ceiling in a row of pixels, for an eye halfway between them.
fn distance_of_row(camera: &Camera, y: u32) -> f64 {
    let below = (f64::from(y) + 0.5 - f64::from(HEIGHT) / 2.0).abs();
    focal_length(camera) * 0.5 / below
}

/// The sizes of the checkers' squares. A checker with squares of `n` texels is grey from level log₂
/// 2n on.
const SQUARES: [u32; 4] = [1, 2, 4, 8];

/// The mip level of each pixel of a wall. It is read off pictures with four checkers, and compared
/// with the logarithm to base 4 of the number of texels that the pixel covers. With a single level
/// for a pixel, an error of half a level cannot be avoided in the worst case.
fn mip_levels() -> Feature {
    let worlds = SQUARES.map(|square| {
        parse(&format!("floor = '#000000'\nceiling = '#000000'\n{ROOM}[tiles]\n'#' = {{ wall = '{square}.png' }}\n"))
    });
    let cameras = cameras_at_start(&worlds[0]);
    let frames = |camera| worlds.each_ref().map(|world| Picture::new(world, 0, camera).frame);
    let frames: Vec<[Frame; 4]> = cameras.iter().map(frames).collect();
    let [world, ..] = worlds;
    let title = ("mip choice", "level of a pixel of a wall", "levels");
    feature(title, world, cameras, |picture, (x, y)| {
        let Some(side @ (Surface::WallX | Surface::WallY)) = picture.renderer.surface(x, y) else {
            return None;
        };
        let frames = frames[picture.index].iter();
        let level = frames.filter(|frame| is_grey(frame.pixel(x, y))).count();
        let error = |ideal: f64| (level as f64 - ideal).abs();
        // Beyond the last checker, levels look the same.
        let ideal = ideal_level(picture.camera, x, picture.distance(x), side);
        (ideal < SQUARES.len() as f64).then(|| (error(ideal) > 0.5 + 1e-9, Some(error(ideal))))
    })
}

/// Returns whether `color` is neither black nor white, in half light or in full light.
fn is_grey(color: Rgb) -> bool {
    ![0, 127, 128, 255].contains(&color.red())
}

/// The logarithm to base 4 of the number of texels that a pixel of a wall covers, at least 0.
fn ideal_level(camera: &Camera, x: u32, distance: f64, side: Surface) -> f64 {
    let ray = ray_of_column(camera, x);
    let step = camera.plane() * 2.0 / f64::from(WIDTH);
    // The wall point is origin + t · ray, where t keeps one coordinate constant. `along` is the
    // derivative of the other coordinate by the column of pixels.
    let along = match side {
        Surface::WallX => distance * (step.y - ray.y * step.x / ray.x),
        _ => distance * (step.x - ray.x * step.y / ray.y),
    };
    let down = distance / focal_length(camera);
    let texels = (along * down).abs() * f64::from(SIDE * SIDE);
    (libm::log2(texels) / 2.0).max(0.0)
}
