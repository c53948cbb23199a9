//! The mip levels of walls. Everything else of a picture is compared by `crates/certify`.

use std::hint::black_box;

use super::Feature;
use cellcaster::color::Rgb;
use cellcaster::map::{self, TextureFileError, TextureFiles};
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer, Surface};
use cellcaster::world::{Camera, FieldOfView, Heading, World};

/// The width and the height of the pictures.
const WIDTH: u32 = 160;
const HEIGHT: u32 = 90;
/// The directions of the pictures, in degrees.
const HEADINGS: [f64; 6] = [0.0, 33.0, 101.0, 170.0, 222.0, 295.0];

/// The texture files of the maps.
struct Files;

/// The number of texels along each side of a texture.
const SIDE: u32 = 64;

/// A file is a checker of black and white squares. Its name is the number of texels of a square.
impl TextureFiles for Files {
    fn read(&self, name: &str) -> Result<Vec<u8>, TextureFileError> {
        let square: u32 = name.trim_end_matches(".png").parse().unwrap_or(1);
        let is_white = |(x, y): (u32, u32)| !(x / square + y / square).is_multiple_of(2);
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

const ROOM: &str = "grid = '''\n############\n#..........#\n#...@......#\n#.......#..#\n#..........#\n\
                    #....#.....#\n#..........#\n############\n'''\n[things]\n'@' = { start = 0 }\n";
/// The sizes of the checkers' squares. A checker with squares of `n` texels is grey from level log₂
/// 2n on.
const SQUARES: [u32; 4] = [1, 2, 4, 8];

/// The mip level of each pixel of a wall. It is read off pictures with four checkers, and compared
/// with the logarithm to base 4 of the number of texels that the pixel covers. With a single level
/// for a pixel, an error of half a level cannot be avoided in the worst case.
pub(crate) fn mip_levels() -> Feature {
    let worlds = SQUARES.map(|square| {
        let text = format!("floor = '#000000'\nceiling = '#000000'\n{ROOM}[tiles]\n'#' = {{ wall = '{square}.png' }}\n");
        map::parse(&text, "room", &Files).expect("the map is sound, and a test parses it")
    });
    let turned = |heading| {
        let mut camera = worlds[0].start_camera(FieldOfView::default());
        camera.heading = heading;
        camera
    };
    let cameras: Vec<Camera> =
        HEADINGS.into_iter().filter_map(Heading::from_degrees).map(turned).collect();
    let mut renderer = Renderer::new();
    renderer.keep_surfaces(true);
    let mut outcomes = Vec::new();
    for camera in &cameras {
        let frames = worlds.each_ref().map(|world| draw(&mut renderer, world, camera));
        for (x, y) in (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y))) {
            let Some(side @ (Surface::WallX | Surface::WallY)) = renderer.surface(x, y) else {
                continue;
            };
            let level = frames.iter().filter(|frame| is_grey(frame.pixel(x, y))).count();
            let ideal = ideal_level(camera, x, renderer.distances()[x as usize], side);
            // Beyond the last checker, levels look the same.
            if ideal < SQUARES.len() as f64 {
                let error = (level as f64 - ideal).abs();
                outcomes.push((error > 0.5 + 1e-9, Some(error)));
            }
        }
    }
    let [world, ..] = worlds;
    let work = move || {
        for camera in &cameras {
            draw(&mut renderer, &world, black_box(camera));
        }
    };
    let (name, figure, unit) = ("mip choice", "level of a pixel of a wall", "levels");
    Feature { name, figure, unit, outcomes, work: Box::new(work) }
}

fn draw(renderer: &mut Renderer, world: &World, camera: &Camera) -> Frame {
    let size = FrameSize::new(WIDTH, HEIGHT).expect("a picture has pixels");
    let mut frame = Frame::new(size, PixelAspect::SQUARE);
    renderer.render(world, camera, &mut frame);
    frame
}

/// Returns whether `color` is neither black nor white, in half light or in full light.
fn is_grey(color: Rgb) -> bool {
    ![0, 127, 128, 255].contains(&color.red())
}

/// The logarithm to base 4 of the number of texels that a pixel of a wall covers, at least 0.
fn ideal_level(camera: &Camera, x: u32, distance: f64, side: Surface) -> f64 {
    let share = 2.0 * (f64::from(x) + 0.5) / f64::from(WIDTH) - 1.0;
    let ray = camera.direction() + camera.plane() * share;
    let step = camera.plane() * 2.0 / f64::from(WIDTH);
    // The wall point is origin + t · ray, where t keeps one coordinate constant. `along` is the
    // derivative of the other coordinate by the column of pixels.
    let along = match side {
        Surface::WallX => distance * (step.y - ray.y * step.x / ray.x),
        _ => distance * (step.x - ray.x * step.y / ray.y),
    };
    let down = distance * camera.field_of_view.half_width() * 2.0 / f64::from(WIDTH);
    let texels = (along * down).abs() * f64::from(SIDE * SIDE);
    (libm::log2(texels) / 2.0).max(0.0)
}
