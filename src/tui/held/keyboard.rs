//! A simulated keyboard at a terminal that reports no releases: the bytes that it sends.

use std::time::Duration;

/// A keyboard. One key repeats at a time: the one pressed last, until it is released.
#[derive(Clone, Debug)]
pub(crate) struct Keyboard<K> {
    delay: Duration,
    interval: Duration,
    repeats: Option<(K, Duration)>,
}

impl<K: Copy + Eq> Keyboard<K> {
    /// A keyboard that repeats after `delay`, `per_second` times a second.
    pub(crate) fn new(delay: Duration, per_second: u32) -> Self {
        Self { delay, interval: Duration::from_secs(1) / per_second, repeats: None }
    }

    /// Presses a key at `now`, and returns its byte.
    pub(crate) fn press(&mut self, key: K, now: Duration) -> K {
        self.repeats = Some((key, now + self.delay));
        key
    }

    /// Releases a key.
    pub(crate) fn release(&mut self, key: K) {
        self.repeats = self.repeats.filter(|&(other, _)| other != key);
    }

    /// The next byte due at or before `now`, and its time.
    pub(crate) fn next_byte(&mut self, now: Duration) -> Option<(K, Duration)> {
        let (key, due) = self.repeats.filter(|&(_, due)| due <= now)?;
        self.repeats = Some((key, due + self.interval));
        Some((key, due))
    }
}
