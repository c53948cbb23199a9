//! Light and fog by channel, and the choice of mip levels.

use std::hint::black_box;

use super::Feature;
use cellcaster::color::Rgb;
use cellcaster::map::{self, TextureFileError, TextureFiles};
use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer, Surface};
use cellcaster::world::{Camera, FieldOfView, Fog, Heading, World};

const WIDTH: u32 = 160;
const HEIGHT: u32 = 90;
/// The directions from the start, in degrees.
const HEADINGS: [f64; 6] = [0.0, 33.0, 101.0, 170.0, 222.0, 295.0];

const ROOM: &str = "grid = '''\n############\n#..........#\n#...@......#\n#.......#..#\n#..........#\n\
                    #....#.....#\n#..........#\n############\n'''\n[things]\n'@' = { start = 0 }\n";

pub(crate) fn features() -> Vec<Feature> {
    let mut features: Vec<Feature> = ["light: red", "light: green", "light: blue"]
        .into_iter()
        .enumerate()
        .map(|(channel, name)| lit(name, channel, None))
        .collect();
    let fog = Fog::new(FOG, FOG_DISTANCE);
    features.extend(
        ["fog: red", "fog: green", "fog: blue"]
            .into_iter()
            .enumerate()
            .map(|(channel, name)| lit(name, channel, fog)),
    );
    features.push(mip_levels());
    features
}

const WALL: Rgb = Rgb::new(0xc8, 0x9a, 0x57);
const FLOOR: Rgb = Rgb::new(0x93, 0xb1, 0xe3);
const FOG: Rgb = Rgb::new(0x30, 0x48, 0x6b);
const FOG_DISTANCE: f64 = 4.0;
const LIGHT: f64 = 0.37;

struct Files;

/// A checker of black and white squares of as many texels as the file's name says.
impl TextureFiles for Files {
    fn read(&self, name: &str) -> Result<Vec<u8>, TextureFileError> {
        let square: u32 = name.trim_end_matches(".png").parse().unwrap_or(1);
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, SIDE, SIDE);
        encoder.set_color(png::ColorType::Grayscale);
        let places = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
        let texels: Vec<u8> = places
            .map(|(x, y)| if (x / square + y / square).is_multiple_of(2) { 0 } else { 255 })
            .collect();
        let written =
            encoder.write_header().and_then(|mut writer| writer.write_image_data(&texels));
        written.expect("writing to memory does not fail");
        Ok(bytes)
    }
}

fn parse(text: &str) -> World {
    map::parse(text, "room", &Files)
        .expect("the maps of this module are sound, and tests parse them")
}

fn cameras(world: &World) -> Vec<Camera> {
    let start = world.start_camera(FieldOfView::default());
    let turned = |degrees| {
        let mut camera = start;
        camera.heading = Heading::from_degrees(degrees)?;
        Some(camera)
    };
    HEADINGS.into_iter().filter_map(turned).collect()
}

fn frame() -> Frame {
    let size = FrameSize::new(WIDTH, HEIGHT).expect("a picture has pixels");
    Frame::new(size, PixelAspect::SQUARE)
}

fn drawing(world: World, cameras: Vec<Camera>) -> Box<dyn FnMut()> {
    let (mut renderer, mut frame) = (Renderer::new(), frame());
    Box::new(move || {
        for camera in &cameras {
            renderer.render(&world, black_box(camera), &mut frame);
        }
    })
}

/// The error of one channel of walls and floors: the definition in real numbers is
/// `own · light · clearness + fog · (1 − clearness)`, where the light of a y-side is halved.
fn lit(name: &'static str, channel: usize, fog: Option<Fog>) -> Feature {
    let fog_text = fog.map_or(String::new(), |fog| {
        format!("fog = {{ color = '{}', distance = {FOG_DISTANCE} }}\n", fog.color)
    });
    let world = parse(&format!(
        "floor = '{FLOOR}'\nceiling = '{FLOOR}'\nlight = {LIGHT}\n{fog_text}{ROOM}[tiles]\n'#' = {{ wall = '{WALL}' }}\n"
    ));
    let cameras = cameras(&world);
    let mut errors = Vec::new();
    let (mut renderer, mut frame) = (Renderer::new(), frame());
    renderer.keep_surfaces(true);
    for camera in &cameras {
        renderer.render(&world, camera, &mut frame);
        for (x, y) in (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y))) {
            let (own, share, distance) = match renderer.surface(x, y) {
                Some(Surface::WallX) => (WALL, 1.0, renderer.columns()[x as usize].distance),
                Some(Surface::WallY) => (WALL, 0.5, renderer.columns()[x as usize].distance),
                _ => (FLOOR, 1.0, distance_of_row(camera, y)),
            };
            let clearness = fog.map_or(1.0, |fog| fog.clearness(distance));
            let [own, fog] = [own, FOG].map(|color| f64::from(color.channels()[channel]));
            let expected = own * LIGHT * share * clearness + fog * (1.0 - clearness);
            errors.push((f64::from(frame.pixel(x, y).channels()[channel]) - expected).abs());
        }
    }
    let work = Some(drawing(world, cameras));
    let cases = errors.len();
    Feature { name, figure: "channel of a pixel", unit: "of 255", cases, wrong: 0, errors, work }
}

fn focal_length(camera: &Camera) -> f64 {
    f64::from(WIDTH) / 2.0 / camera.field_of_view.half_width()
}

/// The distance of the floor or the ceiling in a row of pixels, for an eye in the middle.
fn distance_of_row(camera: &Camera, y: u32) -> f64 {
    let below = (f64::from(y) + 0.5 - f64::from(HEIGHT) / 2.0).abs();
    focal_length(camera) * 0.5 / below
}

/// The texels along each side of the textures for mip levels.
const SIDE: u32 = 64;
/// The sizes of the squares of the checkers. One of `n` texels is grey from level log₂ 2n on.
const SQUARES: [u32; 4] = [1, 2, 4, 8];

/// The mip level of each pixel of a wall, read off pictures with four checkers, and compared with
/// the logarithm to base 4 of the texels that the pixel covers. Half a level is the least that a
/// choice of one level can have in the worst case.
fn mip_levels() -> Feature {
    let worlds = SQUARES.map(|square| {
        parse(&format!("floor = '#000000'\nceiling = '#000000'\n{ROOM}[tiles]\n'#' = {{ wall = '{square}.png' }}\n"))
    });
    let cameras = cameras(&worlds[0]);
    let mut errors = Vec::new();
    let mut wrong = 0;
    let mut renderer = Renderer::new();
    renderer.set_filter(Filter::Mip);
    renderer.keep_surfaces(true);
    let mut frames = [(); 4].map(|()| frame());
    for camera in &cameras {
        for (world, frame) in worlds.iter().zip(&mut frames) {
            renderer.render(world, camera, frame);
        }
        for (x, y) in (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y))) {
            let Some(side @ (Surface::WallX | Surface::WallY)) = renderer.surface(x, y) else {
                continue;
            };
            let distance = renderer.columns()[x as usize].distance;
            let level = frames.iter().filter(|frame| is_grey(frame.pixel(x, y))).count();
            let ideal = ideal_level(camera, x, distance, side);
            // Beyond the last checker, levels look alike.
            if ideal < SQUARES.len() as f64 {
                let error = (level as f64 - ideal).abs();
                wrong += usize::from(error > 0.5 + 1e-9);
                errors.push(error);
            }
        }
    }
    let cases = errors.len();
    let [world, ..] = worlds;
    let work = Some(drawing(world, cameras));
    Feature {
        name: "mip choice",
        figure: "level of a pixel of a wall",
        unit: "levels",
        cases,
        wrong,
        errors,
        work,
    }
}

/// Neither black nor white, in half light or in full light.
fn is_grey(color: Rgb) -> bool {
    ![0, 127, 128, 255].contains(&color.red())
}

/// The logarithm to base 4 of the texels that a pixel of a wall covers, at least 0.
fn ideal_level(camera: &Camera, x: u32, distance: f64, side: Surface) -> f64 {
    let share = 2.0 * (f64::from(x) + 0.5) / f64::from(WIDTH) - 1.0;
    let ray = camera.direction() + camera.plane() * share;
    let step = camera.plane() * 2.0 / f64::from(WIDTH);
    // The wall point is origin + t · ray, where t keeps one coordinate; the derivative of the other
    // one by the column of pixels.
    let along = match side {
        Surface::WallX => distance * (step.y - ray.y * step.x / ray.x),
        _ => distance * (step.x - ray.x * step.y / ray.y),
    };
    let down = distance / focal_length(camera);
    let texels = (along * down).abs() * f64::from(SIDE * SIDE);
    (libm::log2(texels) / 2.0).max(0.0)
}
