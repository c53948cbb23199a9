//! The time of drawing at several sizes, with the classic loop and a fill for comparison.

use std::hint::black_box;
use std::num::{NonZero, NonZeroU32};
use std::time::{Duration, Instant};

use super::classic::{Classic, ClassicFloor};
use super::{pixel_aspect, plain_scene, textured_scene, walk};
use crate::report::{Diagram, Row, Table, Value, headings, median, seconds};
use cellcaster::render::{Frame, FrameSize, Renderer};
use cellcaster::world::{Camera, FieldOfView, World};

/// A scene.
#[derive(Clone, Copy)]
enum Scene {
    /// Walls, with a textured floor and ceiling.
    Planes,
    /// Walls, with one colour above and below them.
    Walls,
}

/// The sizes of the pictures: those of terminals, from 80×24 to 320×100 cells, then larger ones.
const SIZES: [FrameSize; 8] = [
    size(80, 48),
    size(120, 80),
    size(160, 90),
    size(200, 120),
    size(320, 200),
    size(640, 480),
    size(1920, 1080),
    size(3840, 2160),
];

/// A size that is known to be valid.
pub(crate) const fn size(width: u32, height: u32) -> FrameSize {
    match (NonZeroU32::new(width), NonZeroU32::new(height)) {
        (Some(width), Some(height)) => FrameSize { width, height },
        _ => panic!("a picture has pixels"),
    }
}

/// The number of cameras along the walk.
const CAMERAS: usize = 64;
/// The stride from one camera to the next. It visits all cameras, and any first few of them are
/// spread over the whole walk.
const STRIDE: usize = 39;
/// The number of timings for each camera before the next one.
const TURNS: usize = 3;

/// Draws each scene at each size, within about `time` altogether.
///
/// For each camera, all renderers take turns, so that a busy machine slows all of them. A result is
/// the mean, over the visited cameras, of the medians for each camera.
pub fn measure_drawing(time: Duration) -> Table {
    let scenes = [(Scene::Planes, textured_scene()), (Scene::Walls, plain_scene())];
    let pictures = || SIZES.iter().flat_map(|&size| scenes.iter().map(move |scene| (size, scene)));
    let all: f64 = pictures().map(|(size, (scene, _))| share(*scene, size)).sum();
    let rows = pictures().flat_map(|(size, (scene, world))| {
        let time = time.mul_f64(share(*scene, size) / all);
        Comparison::new(*scene, world, size).measure(time)
    });
    Table {
        name: "drawing",
        title: "Nanoseconds a pixel of the renderer on one thread (ours), beside the loop that tutorials\n\
                teach (classic) and a fill, and on the threads that the renderer uses by default"
            .to_owned(),
        keys: ["scene", "renderer", "picture"],
        columns: headings(["pixels", "threads", "time, ns a pixel", "over ours", "over fill"]),
        rows: rows.collect(),
        diagrams: vec![Diagram { columns: [0, 2], range: Diagram::ALL }],
    }
}

/// The weight of these pictures in the distribution of time. Large pictures take longer, but need
/// fewer samples.
fn share(scene: Scene, size: FrameSize) -> f64 {
    let pixels = f64::from(size.width.get()) * f64::from(size.height.get());
    pixels.sqrt() * (1 + scene.floors().len()) as f64
}

impl Scene {
    const fn name(self) -> &'static str {
        match self {
            Self::Planes => "planes",
            Self::Walls => "walls",
        }
    }

    /// The classic loop's floors for this scene.
    fn floors(self) -> &'static [ClassicFloor] {
        match self {
            Self::Planes => &[ClassicFloor::ByColumn, ClassicFloor::ByScanline],
            Self::Walls => &[ClassicFloor::None],
        }
    }
}

/// All renderers of a scene at one size, and their buffers.
struct Comparison<'a> {
    scene: Scene,
    world: &'a World,
    size: FrameSize,
    single_threaded: Renderer,
    multi_threaded: Renderer,
    threads: usize,
    classic: Classic,
    frame: Frame,
    pixels: Vec<u32>,
}

/// The times of all renderers for one camera, in seconds.
#[derive(Clone, Default)]
struct Times {
    ours: Vec<f64>,
    by_threads: Vec<f64>,
    fill: Vec<f64>,
    /// For each of the scene's floors.
    classic: [Vec<f64>; 2],
}

impl<'a> Comparison<'a> {
    fn new(scene: Scene, world: &'a World, size: FrameSize) -> Self {
        let mut frame = Frame::new(size, pixel_aspect(size));
        let (mut single_threaded, mut multi_threaded) = (Renderer::new(), Renderer::new());
        single_threaded.set_threads(NonZero::<usize>::MIN);
        let start = world.start_camera(FieldOfView::default());
        let threads = multi_threaded.explain(world, &start, &mut frame).threads.count();
        let pixels = vec![0; frame.width() as usize * frame.height() as usize];
        let classic = Classic::new(world);
        Self {
            scene,
            world,
            size,
            single_threaded,
            multi_threaded,
            threads,
            classic,
            frame,
            pixels,
        }
    }

    fn measure(mut self, time: Duration) -> Vec<Row> {
        let cameras = walk(self.world, CAMERAS);
        // The first draw loads caches, and is not counted.
        self.take_turns(&cameras[0], 1, &mut Times::default());
        let mut times = vec![Times::default(); CAMERAS];
        let begun = Instant::now();
        for index in (0..).map(|index| index * STRIDE % CAMERAS) {
            self.take_turns(&cameras[index], TURNS, &mut times[index]);
            if begun.elapsed() >= time {
                break;
            }
        }
        self.rows(&times)
    }

    /// Draws `turns` times with each renderer from `camera`, in turns.
    fn take_turns(&mut self, camera: &Camera, turns: usize, times: &mut Times) {
        let Self {
            scene,
            world,
            size,
            single_threaded,
            multi_threaded,
            threads,
            classic,
            frame,
            pixels,
        } = self;
        let size = (size.width.get() as usize, size.height.get() as usize);
        for turn in 0..turns {
            times.ours.push(seconds(|| single_threaded.render(world, camera, black_box(frame))));
            times.fill.push(seconds(|| black_box(&mut *pixels).fill(turn as u32)));
            if *threads > 1 {
                let draw = || multi_threaded.render(world, camera, black_box(frame));
                times.by_threads.push(seconds(draw));
            }
            for (times, &floor) in times.classic.iter_mut().zip(scene.floors()) {
                times.push(seconds(|| classic.draw(camera, floor, size, black_box(pixels))));
            }
        }
    }

    /// A row for each renderer.
    fn rows(&self, times: &[Times]) -> Vec<Row> {
        let Self { scene, size, threads, .. } = *self;
        let mean = |of: &dyn Fn(&Times) -> &Vec<f64>| {
            let visited = times.iter().filter(|times| !times.ours.is_empty());
            mean_of_medians(visited.map(of))
        };
        let floors = 0..scene.floors().len();
        let classic = floors.map(|floor| mean(&|times| &times.classic[floor]));
        let (ours, fill) = (mean(&|times| &times.ours), mean(&|times| &times.fill));
        let mut renderers = vec![
            ("ours", 1, ours),
            ("classic", 1, classic.fold(f64::INFINITY, f64::min)),
            ("fill", 1, fill),
        ];
        if threads > 1 {
            renderers.push(("by threads", threads, mean(&|times| &times.by_threads)));
        }
        let picture = format!("{}x{}", size.width, size.height);
        let pixels = self.pixels.len() as f64;
        let row = |(name, threads, time): (&str, usize, f64)| {
            let figures = [time * 1e9 / pixels, time / ours, time / fill].map(Value::Number);
            let counts = [Value::Count(pixels as u64), Value::Count(threads as u64)];
            let values = counts.into_iter().chain(figures).collect();
            Row::new([scene.name(), name, &picture], values)
        };
        renderers.into_iter().map(row).collect()
    }
}

fn mean_of_medians<'a>(lists: impl Iterator<Item = &'a Vec<f64>>) -> f64 {
    let medians: Vec<_> = lists.map(|times| median(times.clone())).collect();
    medians.iter().sum::<f64>() / medians.len() as f64
}
