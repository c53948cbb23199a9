//! How long drawing takes, at several sizes, beside the classic loop and a fill.

use std::hint::black_box;
use std::num::{NonZero, NonZeroU32};
use std::time::{Duration, Instant};

use super::{Classic, ClassicFloor, fill, pixel_aspect, plain_scene, textured_scene, walk};
use crate::render::{Frame, FrameSize, Renderer};
use crate::world::{Camera, FieldOfView, World};

/// What was measured of one scene at one size, in nanoseconds a pixel.
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

/// Cameras along the walk.
const CAMERAS: usize = 64;
/// From each of them to the one that is next: however few have their turn, they are from all of the
/// walk, and in the end all have.
const STRIDE: usize = 39;
/// How often everything is timed from a camera before it is the turn of the next one.
const TURNS: usize = 3;

/// Draws each scene at each size, and takes about so long altogether.
///
/// From a camera all draw in turns, so that a machine that is busy slows all of them down. Of each
/// camera's times the median counts, and of those the mean over the cameras that had their turn.
pub fn measure_drawing(time: Duration) -> Vec<DrawingRow> {
    let scenes = [(Scene::Planes, textured_scene()), (Scene::Walls, plain_scene())];
    let rows = || SIZES.iter().flat_map(|&size| scenes.iter().map(move |scene| (size, scene)));
    let all: f64 = rows().map(|(size, (scene, _))| share(*scene, size)).sum();
    let measured = rows().map(|(size, (scene, world))| {
        let time = time.mul_f64(share(*scene, size) / all);
        Contest::new(*scene, world, size).measure(time)
    });
    measured.collect()
}

/// How much of the time should be spent on such pictures, in parts of whatever it is: large ones take
/// longer, but fewer of them are enough.
fn share(scene: Scene, size: FrameSize) -> f64 {
    let pixels = f64::from(size.width.get()) * f64::from(size.height.get());
    pixels.sqrt() * (1 + scene.floors().len()) as f64
}

impl Scene {
    /// How the classic loop may draw its floor.
    fn floors(self) -> &'static [ClassicFloor] {
        match self {
            Self::Planes => &[ClassicFloor::ByColumn, ClassicFloor::ByScanline],
            Self::Walls => &[ClassicFloor::None],
        }
    }
}

/// All who draw a scene at one size, and what they draw on.
struct Contest<'a> {
    scene: Scene,
    world: &'a World,
    size: FrameSize,
    alone: Renderer,
    together: Renderer,
    threads: usize,
    classic: Classic,
    frame: Frame,
    pixels: Vec<u32>,
}

/// What everyone took from one camera, in seconds.
#[derive(Clone, Default)]
struct Times {
    ours: Vec<f64>,
    by_threads: Vec<f64>,
    fill: Vec<f64>,
    /// With each of the scene's floors.
    classic: [Vec<f64>; 2],
}

impl<'a> Contest<'a> {
    fn new(scene: Scene, world: &'a World, size: FrameSize) -> Self {
        let mut frame = Frame::new(size, pixel_aspect(size));
        let (mut alone, mut together) = (Renderer::new(), Renderer::new());
        alone.set_threads(NonZero::<usize>::MIN);
        let start = world.start_camera(FieldOfView::default());
        let threads = together.explain(world, &start, &mut frame).threads.count();
        let pixels = vec![0; frame.width() as usize * frame.height() as usize];
        let classic = Classic::new(world);
        Self { scene, world, size, alone, together, threads, classic, frame, pixels }
    }

    fn measure(mut self, time: Duration) -> DrawingRow {
        let cameras = walk(self.world, CAMERAS);
        // The first of all fetches everything.
        self.take_turns(&cameras[0], 1, &mut Times::default());
        let mut times = vec![Times::default(); CAMERAS];
        let begun = Instant::now();
        for index in (0..).map(|index| index * STRIDE % CAMERAS) {
            self.take_turns(&cameras[index], TURNS, &mut times[index]);
            if begun.elapsed() >= time {
                break;
            }
        }
        self.row(&times)
    }

    /// Has everyone draw from `camera` so often, one after the other.
    fn take_turns(&mut self, camera: &Camera, turns: usize, times: &mut Times) {
        let Self { scene, world, size, alone, together, threads, classic, frame, pixels } = self;
        let size = (size.width.get() as usize, size.height.get() as usize);
        for turn in 0..turns {
            times.ours.push(seconds(|| alone.render(world, camera, black_box(frame))));
            times.fill.push(seconds(|| fill(black_box(pixels), turn as u32)));
            if *threads > 1 {
                let draw = || together.render(world, camera, black_box(frame));
                times.by_threads.push(seconds(draw));
            }
            for (times, &floor) in times.classic.iter_mut().zip(scene.floors()) {
                times.push(seconds(|| classic.draw(camera, floor, size, black_box(pixels))));
            }
        }
    }

    /// What comes of the times from all cameras.
    fn row(&self, times: &[Times]) -> DrawingRow {
        let Self { scene, size, threads, .. } = *self;
        let seen = || times.iter().filter(|times| !times.ours.is_empty());
        let a_pixel = 1e9 / self.pixels.len() as f64;
        let ours = a_pixel * mean_of_medians(seen().map(|times| &times.ours));
        let by_threads = a_pixel * mean_of_medians(seen().map(|times| &times.by_threads));
        let with_floor = |floor| mean_of_medians(seen().map(|times: &Times| &times.classic[floor]));
        let classic = (0..scene.floors().len()).map(with_floor).fold(f64::INFINITY, f64::min);
        DrawingRow {
            scene,
            size,
            ours,
            threads,
            by_threads: if threads > 1 { by_threads } else { ours },
            classic: a_pixel * classic,
            fill: a_pixel * mean_of_medians(seen().map(|times| &times.fill)),
        }
    }
}

fn mean_of_medians<'a>(lists: impl Iterator<Item = &'a Vec<f64>>) -> f64 {
    let medians: Vec<_> = lists.map(|times| median(times.clone())).collect();
    medians.iter().sum::<f64>() / medians.len() as f64
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
