//! A progress bar on standard error, if that is a terminal.

use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// The time before the bar appears.
const DELAY: Duration = Duration::from_secs(1);
const WIDTH: usize = 40;

/// A progress bar.
pub(crate) struct Progress {
    start: Instant,
    is_watched: bool,
    shown: Option<usize>,
}

impl Progress {
    pub(crate) fn new() -> Self {
        Self { start: Instant::now(), is_watched: io::stderr().is_terminal(), shown: None }
    }

    /// Shows the completed fraction, from 0 to 1, if it is time to draw.
    pub(crate) fn show(&mut self, share: f64) {
        let filled = (share * WIDTH as f64) as usize;
        if self.is_watched && self.start.elapsed() > DELAY && self.shown != Some(filled) {
            let (done, to_do) = ("#".repeat(filled), ".".repeat(WIDTH.saturating_sub(filled)));
            // A bar that cannot be drawn is no reason to end the program.
            let _ = write!(io::stderr(), "\r[{done}{to_do}]");
            self.shown = Some(filled);
        }
    }

    /// Removes the bar.
    pub(crate) fn finish(self) {
        if self.shown.is_some() {
            let _ = write!(io::stderr(), "\r{}\r", " ".repeat(WIDTH + 2));
        }
    }
}
