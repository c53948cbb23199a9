//! The measured scenes: the maps of the gallery, as seen from their starts.

use cellcaster::map::{self, Level};
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{Camera, FieldOfView, World};

/// The map with which all others are compared.
pub(crate) const FLAT: &str = "flat";

/// The sizes of the pictures in pixels: those of half blocks at 160x45 and 400x120 cells.
pub(crate) fn sizes() -> [FrameSize; 2] {
    [(160, 90), (400, 240)]
        .map(|(width, height)| FrameSize::new(width, height).expect("none of these is zero"))
}

/// The name of a size.
pub(crate) fn name_of(size: FrameSize) -> String {
    format!("{}x{}", size.width, size.height)
}

/// A map of the gallery, and the view from its start.
pub(crate) struct Scene {
    pub(crate) name: String,
    pub(crate) world: World,
    pub(crate) camera: Camera,
}

/// All maps of the gallery by name, the flat one first.
pub(crate) fn scenes() -> Vec<Scene> {
    let files = std::fs::read_dir("maps/gallery").expect("the benches run in the package's folder");
    let paths = files.map(|file| file.expect("the gallery can be read").path());
    let mut scenes: Vec<Scene> = paths
        .filter_map(|path| {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let level = map::load_level(&path).unwrap_or_else(|faults| panic!("{faults}"));
            // Maps of bodies have their own bench.
            let Level::Grid(world) = level else { return None };
            let camera = world.start_camera(FieldOfView::default());
            Some(Scene { name, world: *world, camera })
        })
        .collect();
    scenes.sort_by(|one, other| {
        (one.name != FLAT, &one.name).cmp(&(other.name != FLAT, &other.name))
    });
    scenes
}

/// A renderer and its frame.
pub(crate) struct Drawing {
    renderer: Renderer,
    frame: Frame,
}

impl Drawing {
    /// For pictures of this size, on square pixels.
    pub(crate) fn new(size: FrameSize) -> Self {
        Self { renderer: Renderer::new(), frame: Frame::new(size, PixelAspect::SQUARE) }
    }

    /// Draws `scene`.
    pub(crate) fn draw(&mut self, scene: &Scene) -> &Frame {
        self.renderer.render(&scene.world, &scene.camera, &mut self.frame);
        &self.frame
    }
}
