//! A bar on standard error, while somebody waits there.

use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// What is done within this shows no bar.
const PATIENCE: Duration = Duration::from_secs(1);
const WIDTH: usize = 40;

/// A bar that shows how much is done.
pub(super) struct Progress {
    start: Instant,
    is_watched: bool,
    shown: Option<usize>,
}

impl Progress {
    pub(super) fn new() -> Self {
        Self { start: Instant::now(), is_watched: io::stderr().is_terminal(), shown: None }
    }

    /// Shows that `share` is done, from 0 to 1, if it is time for that.
    pub(super) fn show(&mut self, share: f64) {
        let filled = (share * WIDTH as f64) as usize;
        if self.is_watched && self.start.elapsed() > PATIENCE && self.shown != Some(filled) {
            let (done, to_do) = ("#".repeat(filled), ".".repeat(WIDTH.saturating_sub(filled)));
            // Nobody is served by an end because of a bar that can't be drawn.
            let _ = write!(io::stderr(), "\r[{done}{to_do}]");
            self.shown = Some(filled);
        }
    }

    /// Takes the bar away.
    pub(super) fn finish(self) {
        if self.shown.is_some() {
            let _ = write!(io::stderr(), "\r{}\r", " ".repeat(WIDTH + 2));
        }
    }
}
