//! Fences: queries that every terminal answers.

use std::time::Duration;

/// The time that a terminal has to answer, if it never has.
const TIMEOUT: Duration = Duration::from_secs(1);
/// The time that a terminal has which has answered before, and so will again. A shell would print an
/// answer that comes later.
const TIMEOUT_AFTER_ANSWER: Duration = Duration::from_secs(5);

/// The number of unanswered fences.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Fences {
    open: u32,
    last_sent: Duration,
    are_answered: bool,
}

impl Fences {
    pub(crate) fn sent(&mut self, now: Duration) {
        self.open += 1;
        self.last_sent = now;
    }

    pub(crate) fn answered(&mut self) {
        self.open = self.open.saturating_sub(1);
        self.are_answered = true;
    }

    /// Expects no answer any more.
    pub(crate) fn forget(&mut self) {
        self.open = 0;
    }

    /// Whether the terminal has ever answered a fence.
    pub(crate) fn are_answered(&self) -> bool {
        self.are_answered
    }

    /// Whether a fence is unanswered.
    pub(crate) fn are_open(&self) -> bool {
        self.open > 0
    }

    /// The remaining time to wait for an answer; `None` if no answer is expected any more.
    pub(crate) fn time_left(&self, now: Duration) -> Option<Duration> {
        let timeout = if self.are_answered { TIMEOUT_AFTER_ANSWER } else { TIMEOUT };
        let left = timeout.checked_sub(now.saturating_sub(self.last_sent))?;
        self.are_open().then_some(left)
    }
}
