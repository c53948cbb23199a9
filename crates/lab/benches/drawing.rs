//! Compares drawing with the classic loop and with a fill, at six sizes.
//!
//! `cargo bench -p cellcaster-lab --bench drawing` measures the drawing table of `cellcaster-lab bench`
//! with more cameras and more repetitions, and writes it as Markdown.

use std::time::Duration;

use cellcaster_lab::report::markdown;
use cellcaster_lab::speed::measure_drawing;

/// The time for all measurements together.
const TIME: Duration = Duration::from_secs(100);

fn main() {
    // A test of the bench needs only one short run.
    let is_test = std::env::args().any(|argument| argument == "--test");
    print!("{}", markdown(&measure_drawing(if is_test { Duration::ZERO } else { TIME })));
}
