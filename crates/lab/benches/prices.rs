//! The price list: the time of a frame of each map of the gallery, as a multiple of the flat map's
//! time.
//!
//! `cargo bench -p cellcaster-lab --bench prices` prints the table, and with `-- --update PAGE`
//! writes it into a page. All maps take turns and are compared within a turn, and the result of a
//! turn is its median frame. A busy machine slows all maps equally, or interrupts only a few of the
//! frames. The table shows the median turn, with the quartiles in brackets.

use std::fmt::Write;
use std::fs;
use std::hint::black_box;
use std::time::Instant;

use cellcaster::render::FrameSize;

#[path = "frame/baseline.rs"]
mod baseline;
#[path = "frame/gallery.rs"]
mod gallery;

use baseline::Baseline;
use gallery::{Drawing, Scene, flat, name_of, scenes, sizes};

/// The number of turns.
const TURNS: usize = 101;
/// The minimum number of pixels drawn in a turn.
const PIXELS_IN_A_TURN: u32 = 1_000_000;

/// A subject of the comparison: a scene, drawn by the renderer or by the baseline.
struct Row {
    name: String,
    /// For each size, the ratio to the flat scene in each turn.
    ratios: [Vec<f64>; 2],
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    // A test of the bench needs only one turn.
    let turns = if arguments.iter().any(|argument| argument == "--test") { 1 } else { TURNS };
    let scenes = scenes();
    let names = ["flat, before"].into_iter().chain(scenes.iter().map(|scene| scene.name.as_str()));
    let mut rows: Vec<Row> =
        names.map(|name| Row { name: name.to_owned(), ratios: [Vec::new(), Vec::new()] }).collect();
    let mut flat_nanoseconds = [0.0; 2];
    for (index, size) in sizes().into_iter().enumerate() {
        let mut flat_times = Vec::with_capacity(turns);
        for _ in 0..turns {
            let times = turn(&scenes, size);
            let flat = times[1];
            flat_times.push(flat);
            for (row, time) in rows.iter_mut().zip(times) {
                row.ratios[index].push(time / flat);
            }
        }
        flat_nanoseconds[index] = quartiles(flat_times)[1];
    }
    let table = table(rows, flat_nanoseconds);
    match arguments.iter().position(|argument| argument == "--update") {
        Some(place) => update(arguments.get(place + 1).expect("--update needs a page"), &table),
        None => print!("{table}"),
    }
}

/// Replaces the table in the page at `path`, which is relative to the folder of the package.
fn update(path: &str, table: &str) {
    const BEGIN: &str = "<!-- prices -->";
    let page = fs::read_to_string(path).expect("the page can be read");
    let parts = page.split_once(BEGIN).zip(page.split_once("<!-- end -->"));
    let ((before, _), (_, after)) = parts.expect("the page has a place for the table");
    let page = format!("{before}{BEGIN}\n\n{table}\n<!-- end -->{after}");
    fs::write(path, page).expect("the page can be written");
}

/// The times, in nanoseconds, of a frame of the flat scene by the baseline, and of a frame of each
/// scene.
fn turn(scenes: &[Scene], size: FrameSize) -> Vec<f64> {
    let frames = PIXELS_IN_A_TURN.div_ceil(size.width.get() * size.height.get());
    let (world, camera) = flat(&scenes[0]);
    let mut baseline = Baseline::new(size);
    let mut drawing = Drawing::new(size);
    let mut times = vec![time(frames, || {
        baseline.render(world, black_box(&camera));
        black_box(baseline.pixels());
    })];
    times.extend(scenes.iter().map(|scene| {
        time(frames, || {
            black_box(drawing.draw(black_box(scene)));
        })
    }));
    times
}

/// The median time of this number of `frames` in nanoseconds, after one frame that is not counted.
fn time(frames: u32, mut draw: impl FnMut()) -> f64 {
    draw();
    let times = (0..frames).map(|_| {
        let start = Instant::now();
        draw();
        start.elapsed().as_secs_f64() * 1e9
    });
    quartiles(times.collect())[1]
}

fn quartiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    let last = values.len() - 1;
    [0.25, 0.5, 0.75].map(|share| values[(share * last as f64).round() as usize])
}

fn table(rows: Vec<Row>, flat_nanoseconds: [f64; 2]) -> String {
    let [small, large] = sizes().map(name_of);
    let mut table = format!("| map | {small} | {large} |\n|---|---|---|\n");
    for Row { name, ratios } in rows {
        let [small, large] = ratios.map(|ratios| {
            let [lower, median, upper] = quartiles(ratios);
            format!("{median:.2} ({lower:.2}–{upper:.2})")
        });
        writeln!(table, "| {name} | {small} | {large} |").expect("a text can be written");
    }
    let [small, large] = flat_nanoseconds.map(|nanoseconds| nanoseconds / 1000.0);
    table + &format!("| *flat, microseconds a frame* | {small:.1} | {large:.1} |\n")
}
