//! Drawing compared with the classic loop and with a fill, at eight sizes.
//!
//! `cargo bench --no-default-features --features lab --bench drawing` measures the drawing table of
//! `cellcaster bench` with more cameras and more repetitions. One thread draws. The last two
//! columns are the number of threads that the renderer uses for a picture of that size, and the
//! speed-up with them.

use std::time::Duration;

use cellcaster_lab::speed::{self, Scene};

/// The time for all measurements together.
const TIME: Duration = Duration::from_secs(100);

fn main() {
    // A test of the bench needs one short run.
    let is_test = std::env::args().any(|argument| argument == "--test");
    let time = if is_test { Duration::ZERO } else { TIME };
    println!(
        "| scene | size | ours, µs | ours, ns a pixel | times faster than the faster classic loop | times a fill | threads | times faster |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let rows = speed::measure_drawing(time);
    for scene in [Scene::Planes, Scene::Walls] {
        for row in rows.iter().filter(|row| row.scene == scene) {
            let name = match scene {
                Scene::Planes => "textured floor and ceiling",
                Scene::Walls => "walls only",
            };
            let (width, height) = (row.size.width.get(), row.size.height.get());
            println!(
                "| {name} | {width}x{height} | {:.1} | {:.2} | {:.2} | {:.1} | {} | {:.2} |",
                row.ours * f64::from(width * height) / 1000.0,
                row.ours,
                row.classic / row.ours,
                row.ours / row.fill,
                row.threads,
                row.ours / row.by_threads,
            );
        }
    }
}
