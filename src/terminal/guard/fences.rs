//! Fences: queries that every terminal answers.

use std::time::{Duration, Instant};

/// The time that a terminal has to answer.
const TIMEOUT: Duration = Duration::from_secs(1);

/// The number of unanswered fences.
#[derive(Debug)]
pub(super) struct Fences {
    open: u32,
    last_sent: Instant,
    are_answered: bool,
}

impl Fences {
    pub(super) fn none() -> Self {
        Self { open: 0, last_sent: Instant::now(), are_answered: false }
    }

    pub(super) fn sent(&mut self) {
        self.open += 1;
        self.last_sent = Instant::now();
    }

    pub(super) fn answered(&mut self) {
        self.open = self.open.saturating_sub(1);
        self.are_answered = true;
    }

    /// Whether the terminal has ever answered a fence.
    pub(super) fn are_answered(&self) -> bool {
        self.are_answered
    }

    /// Whether a fence is unanswered.
    pub(super) fn are_open(&self) -> bool {
        self.open > 0
    }

    /// The remaining time to wait for an answer; `None` if no answer is expected any more.
    pub(super) fn time_left(&self) -> Option<Duration> {
        let left = TIMEOUT.checked_sub(self.last_sent.elapsed())?;
        self.are_open().then_some(left)
    }
}
