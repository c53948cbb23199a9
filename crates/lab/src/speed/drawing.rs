//! The time of drawing at several sizes, with the classic loop and a fill for comparison.

use std::hint::black_box;
use std::num::{NonZero, NonZeroU32};
use std::time::{Duration, Instant};

use super::classic::{Classic, ClassicFloor};
use super::{pixel_aspect, plain_scene, textured_scene, walk};
use crate::report::{Diagram, Row, Table, Value, headings, median, seconds};
use cellcaster::render::{Frame, FrameSize, Renderer};
use cellcaster::world::{Camera, FieldOfView, World};

/// A level to draw.
struct Scene {
    name: &'static str,
    world: World,
    /// The classic loop's floors for this scene.
    floors: &'static [ClassicFloor],
}

/// The sizes of the pictures: in terminals from 80×24 to 320×100 cells, and a size for several
/// threads.
const SIZES: [FrameSize; 6] =
    [size(80, 48), size(120, 80), size(160, 90), size(200, 120), size(320, 200), size(1920, 1080)];

/// A size that is known to be valid.
pub(crate) const fn size(width: u32, height: u32) -> FrameSize {
    match (NonZeroU32::new(width), NonZeroU32::new(height)) {
        (Some(width), Some(height)) => FrameSize { width, height },
        _ => panic!("a picture has pixels"),
    }
}

/// The number of cameras along the walk.
const CAMERAS: usize = 64;
/// The stride from one camera to the next. It visits all cameras, and the cameras visited first are
/// spread over the whole walk.
const STRIDE: usize = 39;
/// The number of timings for each camera before the next one.
const TURNS: usize = 3;

/// Draws a scene with textured planes at each size and one with walls alone at the smallest size,
/// within about `time` in total.
///
/// For each camera, all renderers take turns, so that a busy machine slows all of them. A result is
/// the mean of the medians of all visited cameras.
pub(crate) fn measure_drawing(time: Duration) -> Table {
    let textured = &[ClassicFloor::ByColumn, ClassicFloor::ByScanline];
    let planes = Scene { name: "planes", world: textured_scene(), floors: textured };
    let walls = Scene { name: "walls", world: plain_scene(), floors: &[ClassicFloor::None] };
    let pictures = || SIZES.iter().map(|&size| (&planes, size)).chain([(&walls, SIZES[0])]);
    let all: f64 = pictures().map(|(scene, size)| share(scene, size)).sum();
    let rows = pictures()
        .flat_map(|(scene, size)| compare(scene, size, time.mul_f64(share(scene, size) / all)));
    Table {
        name: "drawing",
        title: "Nanoseconds a pixel of the renderer on one thread (ours), the loop that tutorials teach\n\
                (classic), a fill, and the renderer on its default number of threads (threaded)"
            .to_owned(),
        keys: ["scene", "renderer", "picture"],
        columns: headings(["pixels", "threads", "time, ns a pixel", "over ours"]),
        rows: rows.collect(),
        diagrams: vec![Diagram { columns: [0, 2], range: Diagram::ALL }],
    }
}

/// The weight of these pictures when the time is distributed. Large pictures take longer, but need
/// fewer samples.
fn share(scene: &Scene, size: FrameSize) -> f64 {
    let pixels = f64::from(size.width.get()) * f64::from(size.height.get());
    pixels.sqrt() * (1 + scene.floors.len()) as f64
}

/// The times of all renderers for one camera, in seconds.
#[derive(Clone, Default)]
struct Times {
    ours: Vec<f64>,
    by_threads: Vec<f64>,
    fill: Vec<f64>,
    /// One list for each of the scene's floors.
    classic: [Vec<f64>; 2],
}

/// Draws a scene with all renderers at one size. This takes about `time`.
fn compare(scene: &Scene, size: FrameSize, time: Duration) -> Vec<Row> {
    let Scene { world, floors, .. } = scene;
    let (width, height) = (size.width.get() as usize, size.height.get() as usize);
    let mut frame = Frame::new(size, pixel_aspect(size));
    let mut pixels = vec![0; width * height];
    let (mut single_threaded, mut multi_threaded) = (Renderer::new(), Renderer::new());
    single_threaded.set_threads(NonZero::<usize>::MIN);
    let start = world.start_camera(FieldOfView::default());
    let threads = multi_threaded.explain(world, &start, &mut frame).threads.count();
    let classic = Classic::new(world);
    // Draws `turns` times with each renderer, in turn.
    let mut take_turns = |camera: &Camera, turns: usize, times: &mut Times| {
        for turn in 0..turns {
            let draw = || single_threaded.render(world, camera, black_box(&mut frame));
            times.ours.push(seconds(draw));
            times.fill.push(seconds(|| black_box(&mut pixels).fill(turn as u32)));
            if threads > 1 {
                let draw = || multi_threaded.render(world, camera, black_box(&mut frame));
                times.by_threads.push(seconds(draw));
            }
            for (times, &floor) in times.classic.iter_mut().zip(*floors) {
                let pixels = black_box(&mut pixels);
                times.push(seconds(|| classic.draw(camera, floor, (width, height), pixels)));
            }
        }
    };
    let cameras = walk(world, CAMERAS);
    // The first draw fills the caches, and is not counted.
    take_turns(&cameras[0], 1, &mut Times::default());
    let mut times = vec![Times::default(); CAMERAS];
    let begun = Instant::now();
    for index in (0..).map(|index| index * STRIDE % CAMERAS) {
        take_turns(&cameras[index], TURNS, &mut times[index]);
        if begun.elapsed() >= time {
            break;
        }
    }
    rows(scene, size, threads, &times)
}

/// A row for each renderer.
fn rows(scene: &Scene, size: FrameSize, threads: usize, times: &[Times]) -> Vec<Row> {
    let mean = |of: &dyn Fn(&Times) -> &Vec<f64>| {
        let visited = times.iter().filter(|times| !times.ours.is_empty());
        mean_of_medians(visited.map(of))
    };
    let floors = 0..scene.floors.len();
    let classic = floors.map(|floor| mean(&|times| &times.classic[floor]));
    let (ours, fill) = (mean(&|times| &times.ours), mean(&|times| &times.fill));
    let mut renderers = vec![
        ("ours", 1, ours),
        ("classic", 1, classic.fold(f64::INFINITY, f64::min)),
        ("fill", 1, fill),
    ];
    if threads > 1 {
        renderers.push(("threaded", threads, mean(&|times| &times.by_threads)));
    }
    let picture = format!("{}x{}", size.width, size.height);
    let pixels = f64::from(size.width.get()) * f64::from(size.height.get());
    let row = |(name, threads, time): (&str, usize, f64)| {
        let figures = [time * 1e9 / pixels, time / ours].map(Value::Number);
        let counts = [Value::Count(pixels as u64), Value::Count(threads as u64)];
        let values = counts.into_iter().chain(figures).collect();
        Row::new([scene.name, name, &picture], values)
    };
    renderers.into_iter().map(row).collect()
}

fn mean_of_medians<'a>(lists: impl Iterator<Item = &'a Vec<f64>>) -> f64 {
    let medians: Vec<_> = lists.map(|times| median(times.clone())).collect();
    medians.iter().sum::<f64>() / medians.len() as f64
}
