//! How long drawing takes, at several sizes, beside the classic loop and a fill.

use std::hint::black_box;
use std::num::{NonZero, NonZeroU32};
use std::time::{Duration, Instant};

use super::{Classic, ClassicFloor, fill, pixel_aspect, plain_scene, textured_scene, walk};
use crate::render::{Frame, FrameSize, Renderer};
use crate::world::{Camera, World};

/// What was measured of one scene at one size: the medians of all frames, in nanoseconds a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawingRow {
    /// What is drawn.
    pub scene: Scene,
    /// The size of the picture.
    pub size: FrameSize,
    /// What we take, one thread.
    pub ours: f64,
    /// How many threads we draw such a picture with, left to ourselves.
    pub threads: usize,
    /// What we take with those.
    pub by_threads: f64,
    /// What the classic loop takes: the faster one of two, where there is a floor to draw.
    pub classic: f64,
    /// What it takes to set every pixel.
    pub fill: f64,
}

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scene {
    /// Walls, and textures on the floor and the ceiling.
    Planes,
    /// Walls, and one colour above and below them.
    Walls,
}

/// The sizes of the pictures.
pub const SIZES: [FrameSize; 5] =
    [size(160, 90), size(320, 200), size(640, 480), size(1920, 1080), size(3840, 2160)];

/// The size of a picture that is known to have pixels.
pub(super) const fn size(width: u32, height: u32) -> FrameSize {
    match (NonZeroU32::new(width), NonZeroU32::new(height)) {
        (Some(width), Some(height)) => FrameSize { width, height },
        _ => panic!("a picture has pixels"),
    }
}

/// Cameras along the walk, one a picture.
const CAMERAS: usize = 32;
/// From one of them to the next that is used, so that a few are spread over all of the walk.
const STRIDE: usize = 13;
/// How often everything is timed at least.
const FEWEST_TURNS: u32 = 3;

/// Draws each scene at each size, and takes about so long altogether.
pub fn measure_drawing(time: Duration) -> Vec<DrawingRow> {
    let scenes = [(Scene::Planes, textured_scene()), (Scene::Walls, plain_scene())];
    let share = time / (SIZES.len() * scenes.len()) as u32;
    let rows = SIZES.iter().flat_map(|&size| scenes.iter().map(move |scene| (size, scene)));
    rows.map(|(size, (scene, world))| measure(*scene, world, size, share)).collect()
}

/// All of them take their turns one after the other, so that a machine that is busy slows all of them
/// down.
fn measure(scene: Scene, world: &World, size: FrameSize, time: Duration) -> DrawingRow {
    let (width, height) = (size.width.get(), size.height.get());
    let mut frame = Frame::new(size, pixel_aspect(size));
    let mut pixels = vec![0; width as usize * height as usize];
    let (mut alone, mut together) = (Renderer::new(), Renderer::new());
    alone.set_threads(NonZero::<usize>::MIN);
    let classic = Classic::new(world);
    let floors = match scene {
        Scene::Planes => &[ClassicFloor::ByColumn, ClassicFloor::ByScanline][..],
        Scene::Walls => &[ClassicFloor::None],
    };
    let mut times = Times::of_floors(floors.len());
    let cameras = walk(world, CAMERAS);
    let threads = together.explain(world, &cameras[0], &mut frame).plan.threads.count();
    let begun = Instant::now();
    for (turn, camera) in (0..).zip(cameras.iter().cycle().step_by(STRIDE)) {
        if turn > FEWEST_TURNS && begun.elapsed() >= time {
            break;
        }
        times.ours.push(seconds(|| alone.render(world, camera, black_box(&mut frame))));
        times.fill.push(seconds(|| fill(black_box(&mut pixels), turn)));
        if threads > 1 {
            let by_threads = seconds(|| together.render(world, camera, black_box(&mut frame)));
            times.by_threads.push(by_threads);
        }
        for (&floor, times) in floors.iter().zip(&mut times.classic) {
            times.push(seconds(|| draw_classic(&classic, camera, floor, size, &mut pixels)));
        }
        if turn == 0 {
            // The first of all fetches everything.
            times.clear();
        }
    }
    let a_pixel = 1e9 / (f64::from(width) * f64::from(height));
    let classic = times.classic.into_iter().map(median).fold(f64::INFINITY, f64::min);
    let (ours, fill) = (median(times.ours), median(times.fill));
    let by_threads = if threads > 1 { median(times.by_threads) } else { ours };
    let [ours, by_threads, classic, fill] =
        [ours, by_threads, classic, fill].map(|seconds| seconds * a_pixel);
    DrawingRow { scene, size, ours, threads, by_threads, classic, fill }
}

fn draw_classic(
    classic: &Classic,
    camera: &Camera,
    floor: ClassicFloor,
    size: FrameSize,
    pixels: &mut [u32],
) {
    let size = (size.width.get() as usize, size.height.get() as usize);
    classic.draw(camera, floor, size, black_box(pixels));
}

/// In seconds, turn by turn.
struct Times {
    ours: Vec<f64>,
    by_threads: Vec<f64>,
    classic: Vec<Vec<f64>>,
    fill: Vec<f64>,
}

impl Times {
    /// None yet, of a scene whose floor is drawn in so many ways by the classic loop.
    fn of_floors(count: usize) -> Self {
        let none = Vec::new;
        Self { ours: none(), by_threads: none(), classic: vec![none(); count], fill: none() }
    }

    fn clear(&mut self) {
        self.ours.clear();
        self.by_threads.clear();
        self.classic.iter_mut().for_each(Vec::clear);
        self.fill.clear();
    }
}

/// How long `work` takes, in seconds.
pub(super) fn seconds(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

/// The median of `values`; 0 of none.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or_default()
}
