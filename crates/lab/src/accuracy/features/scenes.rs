//! Pictures with heights, mirrors and sprites, each compared with another way to find the same
//! pixels.
//!
//! Heights are compared with the 3-D caster, to which each cell is a box, and which shares no code
//! with them. A mirror is compared with a copy of the room behind it, built in reverse. A sprite is a
//! rectangle on the plane through its place that faces the camera.

use std::fmt::Write as _;
use std::hint::black_box;

use glam::{DVec2, DVec3};

use super::Feature;
use cellcaster::color::Rgb;
use cellcaster::map::{self, TextureFileError, TextureFiles};
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer, Surface};
use cellcaster::rng::SplitMix64;
use cellcaster::space::{Block, Body, Ray, Scene, Shape, SolidTexture};
use cellcaster::world::{Camera, FieldOfView, Heading, World};

/// The width and the height of the pictures.
const WIDTH: u32 = 160;
const HEIGHT: u32 = 90;
/// The number of pictures of each feature.
const PICTURES: usize = 12;

pub(crate) fn features(seed: u64) -> Vec<Feature> {
    vec![heights(seed), mirrors(seed), sprites(seed)]
}

/// A file of one white texel.
struct Dot;

impl TextureFiles for Dot {
    fn read(&self, _: &str) -> Result<Vec<u8>, TextureFileError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
        encoder.set_color(png::ColorType::Rgb);
        let written =
            encoder.write_header().and_then(|mut writer| writer.write_image_data(&[255; 3]));
        written.expect("writing to memory does not fail");
        Ok(bytes)
    }
}

fn parse(text: &str) -> World {
    map::parse(text, "scene", &Dot)
        .expect("the maps of this module are sound, and tests parse them")
}

fn draw(world: &World, camera: &Camera) -> (Frame, Renderer) {
    let size = FrameSize::new(WIDTH, HEIGHT).expect("a picture has pixels");
    let mut frame = Frame::new(size, PixelAspect::SQUARE);
    let mut renderer = Renderer::new();
    renderer.keep_surfaces(true);
    renderer.render(world, camera, &mut frame);
    (frame, renderer)
}

/// A feature whose pixels are right or wrong: `is_wrong` decides for each pixel of each picture, or
/// leaves it out.
fn feature(
    name: &'static str,
    world: World,
    cameras: Vec<Camera>,
    mut is_wrong: impl FnMut(&Frame, &Renderer, usize, (u32, u32)) -> Option<bool>,
) -> Feature {
    let (mut cases, mut wrong) = (0, 0);
    for (index, camera) in cameras.iter().enumerate() {
        let (frame, renderer) = draw(&world, camera);
        for place in (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y))) {
            if let Some(is_wrong) = is_wrong(&frame, &renderer, index, place) {
                cases += 1;
                wrong += usize::from(is_wrong);
            }
        }
    }
    let size = FrameSize::new(WIDTH, HEIGHT).expect("a picture has pixels");
    let (mut renderer, mut frame) = (Renderer::new(), Frame::new(size, PixelAspect::SQUARE));
    let work = move || {
        for camera in &cameras {
            renderer.render(&world, black_box(camera), &mut frame);
        }
    };
    let work: Option<Box<dyn FnMut()>> = Some(Box::new(work));
    Feature { name, figure: "colour of a pixel", unit: "", cases, wrong, errors: Vec::new(), work }
}

/// Cameras within `low` and `high`, with an eye from 0.6 to 2.2.
fn cameras(low: DVec2, high: DVec2, seed: u64) -> Vec<Camera> {
    let mut random = SplitMix64::new(seed);
    let mut camera = || {
        let position = DVec2::new(random.between(low.x, high.x), random.between(low.y, high.y));
        let heading = Heading::default().turned(random.between(0.0, std::f64::consts::TAU));
        let eye = random.between(0.6, 2.2);
        Camera::new(position, heading, FieldOfView::default())?.with_eye(eye)
    };
    std::iter::repeat_with(&mut camera).flatten().take(PICTURES).collect()
}

/// The direction through the centre of a pixel, with a distance of 1 to the plane of the picture.
fn direction(camera: &Camera, (x, y): (u32, u32)) -> DVec3 {
    let share = 2.0 * (f64::from(x) + 0.5) / f64::from(WIDTH) - 1.0;
    let focal_length = f64::from(WIDTH) / 2.0 / camera.field_of_view.half_width();
    let up = (f64::from(HEIGHT) / 2.0 - (f64::from(y) + 0.5)) / focal_length;
    (camera.direction() + camera.plane() * share).extend(up)
}

/// The characters of the tiles with heights, the height of each, the colour of its top, and that of
/// its sides.
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
    // Above the highest floor, and below the top of the walls.
    const RAISED: f64 = 0.7;
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
        Some(Body { shape: Shape::Block(block), texture })
    });
    let scene = Scene { bodies: bodies.collect(), ..Scene::default() };
    let cameras: Vec<Camera> = cameras(DVec2::splat(1.1), DVec2::new(8.9, 6.9), seed)
        .into_iter()
        .filter_map(|camera| camera.with_eye(camera.eye() + RAISED))
        .collect();
    let own = cameras.clone();
    feature("heights", parse(&text), cameras, move |frame, _, picture, (x, y)| {
        let camera = &own[picture];
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
        Some(frame.pixel(x, y) != expected)
    })
}

fn rgb(color: u32) -> Rgb {
    let [_, red, green, blue] = color.to_be_bytes();
    Rgb::new(red, green, blue)
}

fn mirrors(seed: u64) -> Feature {
    const ROOM: [&str; 6] = ["######", "#..a..", "#.b..c", "#...a.", "#c.b..", "######"];
    let map = |rows: Vec<String>| {
        parse(&format!(
            "floor = '#604830'\nceiling = '#506070'\ngrid = '''\n{}\n'''\n[tiles]\n\
             '#' = {{ wall = '#a07040' }}\na = {{ wall = '#40a070', height = 0.5 }}\n\
             b = {{ floor = '#c0c040' }}\nc = {{ wall = '#7040a0' }}\n\
             M = {{ mirror = '#204060', opacity = 0 }}\n[things]\n'@' = {{ start = 0 }}\n",
            rows.join("\n")
        ))
    };
    let start = |mut rows: Vec<String>| {
        rows[1].replace_range(1..2, "@");
        rows
    };
    let reflected = map(start(ROOM.iter().map(|row| format!("{row}M")).collect()));
    let straight = map(start(
        ROOM.iter().map(|row| format!("{row}{}", row.chars().rev().collect::<String>())).collect(),
    ));
    let cameras: Vec<Camera> = cameras(DVec2::new(1.1, 1.1), DVec2::new(1.9, 3.9), seed)
        .into_iter()
        .filter_map(|camera| camera.with_eye(camera.eye() / 4.0 + 0.1))
        .collect();
    let copies: Vec<Frame> = cameras.iter().map(|camera| draw(&straight, camera).0).collect();
    feature("mirrors", reflected, cameras, move |frame, renderer, picture, (x, y)| {
        // The player has an image in one of them only.
        let is_player = renderer.surface(x, y) == Some(Surface::Thing);
        (!is_player).then(|| frame.pixel(x, y) != copies[picture].pixel(x, y))
    })
}

fn sprites(seed: u64) -> Feature {
    const SIDE: f64 = 0.625;
    let places = [(3.5, 2.5), (6.5, 5.5), (2.5, 6.5), (7.5, 1.5)].map(DVec2::from);
    let world = parse(
        "floor = '#204060'\nceiling = '#406080'\ngrid = '''\n##########\n#@.....s.#\n#..s.....#\n#........#\n\
         #........#\n#.....s..#\n#.s......#\n#........#\n##########\n'''\n[tiles]\n\
         '#' = { wall = '#804020' }\n[things]\n'@' = { start = 0 }\n\
         s = { sprite = 'dot.png', height = 0.625, blocks = false }\n",
    );
    let cameras: Vec<Camera> = cameras(DVec2::new(1.1, 1.1), DVec2::new(8.9, 7.9), seed)
        .into_iter()
        .filter_map(|camera| camera.with_eye(camera.eye() / 4.0 + 0.1))
        .collect();
    let own = cameras.clone();
    feature("sprites", world, cameras, move |frame, _, picture, (x, y)| {
        let camera = &own[picture];
        let ray = direction(camera, (x, y));
        // No wall is before a sprite of this room, and its plane is at one distance everywhere.
        let is_on = |place: &DVec2| {
            let way = place - camera.position();
            let depth = way.dot(camera.direction());
            let point = ray * depth;
            let aside = (point.truncate() - way).dot(camera.direction().perp());
            let height = camera.eye() + point.z;
            depth > 0.0 && aside.abs() < SIDE / 2.0 && (0.0..SIDE).contains(&height)
        };
        let expected = places.iter().any(is_on);
        Some((frame.pixel(x, y) == Rgb::WHITE) != expected)
    })
}
