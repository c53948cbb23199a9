//! The measured scenes: the maps of the gallery, seen from their starts.

use cellcaster::map::{self, Level};
use cellcaster::render::{Frame, FrameSize, Options, PixelAspect, Renderable, Renderer};
use cellcaster::space;
use cellcaster::world::{Camera, FieldOfView, World};

const GALLERY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../maps/gallery");

/// The map with which all others are compared.
pub(crate) const FLAT: &str = "flat";

/// The sizes of the pictures in pixels, for half blocks in 160x45 and 400x120 cells.
pub(crate) fn sizes() -> [FrameSize; 2] {
    [(160, 90), (400, 240)]
        .map(|(width, height)| FrameSize::new(width, height).expect("none of these is zero"))
}

/// The name of a size.
pub(crate) fn name_of(size: FrameSize) -> String {
    format!("{}x{}", size.width, size.height)
}

/// A map of the gallery.
pub(crate) struct Scene {
    pub(crate) name: String,
    pub(crate) level: Level,
}

/// All maps of the gallery by name, the flat one first.
pub(crate) fn scenes() -> Vec<Scene> {
    let files = std::fs::read_dir(GALLERY).expect("the folder of the gallery");
    let paths = files.map(|file| file.expect("the gallery can be read").path());
    let mut scenes: Vec<Scene> = paths
        .map(|path| {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let level = map::load_level(&path).unwrap_or_else(|faults| panic!("{faults}"));
            Scene { name, level }
        })
        .collect();
    scenes.sort_by(|one, other| {
        (one.name != FLAT, &one.name).cmp(&(other.name != FLAT, &other.name))
    });
    scenes
}

/// The grid of the flat map, and its start, for the baseline.
pub(crate) fn flat(scene: &Scene) -> (&World, Camera) {
    let Level::Grid(world) = &scene.level else { panic!("{} is a grid", scene.name) };
    (world, world.start_camera(FieldOfView::default()))
}

/// A frame of one size, drawn by the renderers of grids and of bodies.
pub(crate) struct Drawing {
    of_grids: Renderer,
    of_bodies: space::Renderer,
    frame: Frame,
}

impl Drawing {
    /// Creates a frame of this size, with square pixels.
    pub(crate) fn new(size: FrameSize) -> Self {
        Self {
            of_grids: Renderer::default(),
            of_bodies: space::Renderer::default(),
            frame: Frame::new(size, PixelAspect::SQUARE),
        }
    }

    /// Draws the view from the start of `scene`.
    pub(crate) fn draw(&mut self, scene: &Scene) -> &Frame {
        let Self { of_grids, of_bodies, frame } = self;
        match &scene.level {
            Level::Grid(world) => draw(&**world, of_grids, frame),
            Level::Space(bodies) => draw(bodies, of_bodies, frame),
        }
        frame
    }
}

fn draw<S: Renderable>(scene: &S, renderer: &mut S::Renderer, frame: &mut Frame) {
    let camera = scene.start_camera(FieldOfView::default());
    scene.render(&camera, Options::default(), renderer, frame);
}
