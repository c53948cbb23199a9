//! Drawing compared with the classic loop and with a fill, at five sizes.
//!
//! `cargo bench --no-default-features --features lab --bench drawing` measures what the table of
//! drawing in `cellcaster bench` has, from more cameras and more often. One thread draws; the last
//! two columns are the number of threads that the renderer uses for a picture of that size, and how
//! many times faster that is.

use std::time::Duration;

use cellcaster::lab::speed::{self, Scene};

/// For all of them together.
const TIME: Duration = Duration::from_secs(100);

fn main() {
    // Asked for a test of the bench, once is enough.
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
