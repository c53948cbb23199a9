//! Our drawing beside the classic loop and a fill, at five sizes.
//!
//! `cargo bench --no-default-features --features speed --bench drawing` writes the table of
//! `PERFORMANCE.md`. From each camera of a walk all draw one after the other, so that a machine that
//! is busy with something else slows all of them down; of each camera's times the median counts, and
//! a time in the table is the mean of those. One thread draws, but for the last two columns: they tell
//! with how many threads a picture of that size is drawn here, and how many times faster that is.

use std::hint::black_box;
use std::num::NonZero;
use std::time::Instant;

use cellcaster::render::{Frame, FrameSize, Renderer};
use cellcaster::speed::{self, Classic, ClassicFloor, SIZES};
use cellcaster::world::{Camera, World};

/// Cameras along the walk, one a picture.
const CAMERAS: usize = 64;
/// Pictures with more pixels are drawn from fewer of them.
const LARGE: u32 = 1_000_000;
const CAMERAS_OF_LARGE: usize = 16;
/// How often each camera has its turn.
const TURNS: usize = 15;

/// What is drawn, and how the classic loop may draw it.
struct Scene {
    name: &'static str,
    world: World,
    floors: &'static [ClassicFloor],
}

/// Nanoseconds a picture.
struct Times {
    ours: f64,
    /// By as many threads as the machine has, where there are enough pixels.
    by_threads: f64,
    threads: usize,
    /// In the order of the scene's floors.
    classic: Vec<f64>,
    fill: f64,
}

fn main() {
    // Asked for a test of the bench, once is enough.
    let turns = if std::env::args().any(|argument| argument == "--test") { 1 } else { TURNS };
    let scenes = [
        Scene {
            name: "textured floor and ceiling",
            world: speed::textured_scene(),
            floors: &[ClassicFloor::ByColumn, ClassicFloor::ByScanline],
        },
        Scene { name: "walls only", world: speed::plain_scene(), floors: &[ClassicFloor::None] },
    ];
    println!(
        "| scene | size | ours, µs | ours, ns a pixel | times faster than the faster classic loop | times a fill | threads | times faster |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for scene in &scenes {
        for size in SIZES {
            let (width, height) = (size.width.get(), size.height.get());
            let Times { ours, by_threads, threads, classic, fill } = measure(scene, size, turns);
            let faster = classic.into_iter().fold(f64::INFINITY, f64::min);
            println!(
                "| {} | {width}x{height} | {:.1} | {:.2} | {:.2} | {:.1} | {threads} | {:.2} |",
                scene.name,
                ours / 1000.0,
                ours / f64::from(width * height),
                faster / ours,
                ours / fill,
                ours / by_threads,
            );
        }
    }
}

fn measure(scene: &Scene, size: FrameSize, turns: usize) -> Times {
    let Scene { world, floors, .. } = scene;
    let (width, height) = (size.width.get(), size.height.get());
    let of_the_walk = if width * height > LARGE { CAMERAS_OF_LARGE } else { CAMERAS };
    let cameras: Vec<Camera> =
        speed::walk(world, CAMERAS).into_iter().step_by(CAMERAS / of_the_walk).collect();
    let (mut alone, mut together) = (Renderer::new(), Renderer::new());
    alone.set_threads(NonZero::<usize>::MIN);
    let classic = Classic::new(world);
    let mut frame = Frame::new(size, speed::pixel_aspect(size));
    let mut pixels = vec![0; (width * height) as usize];

    let threads = together.explain(world, &cameras[0], &mut frame).plan.threads.count();
    // Of each camera: ours by one thread, the fill, ours by several, and the classic loop with each of
    // the floors.
    let mut times = vec![vec![Vec::with_capacity(turns); 3 + floors.len()]; cameras.len()];
    for turn in 0..turns {
        for (camera, times) in cameras.iter().zip(&mut times) {
            times[0].push(time(|| alone.render(world, camera, black_box(&mut frame))));
            times[1].push(time(|| speed::fill(black_box(&mut pixels), turn as u32)));
            if threads > 1 {
                times[2].push(time(|| together.render(world, camera, black_box(&mut frame))));
            }
            for (times, &floor) in times[3..].iter_mut().zip(*floors) {
                let size = (width as usize, height as usize);
                times.push(time(|| classic.draw(camera, floor, size, black_box(&mut pixels))));
            }
        }
    }
    let mut mean = |drawn: usize| {
        times.iter_mut().map(|times| median(&mut times[drawn])).sum::<f64>() / cameras.len() as f64
    };
    Times {
        ours: mean(0),
        fill: mean(1),
        by_threads: mean(if threads > 1 { 2 } else { 0 }),
        threads,
        classic: (3..3 + floors.len()).map(mean).collect(),
    }
}

/// Nanoseconds that something takes.
fn time(draw: impl FnOnce()) -> f64 {
    let start = Instant::now();
    draw();
    start.elapsed().as_secs_f64() * 1e9
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
