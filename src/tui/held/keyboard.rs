//! A keyboard at a terminal that reports no releases, as far as its bytes go.

use std::time::Duration;

/// One key repeats at a time: the one that was pressed last, until it is released.
#[derive(Clone, Debug)]
pub(crate) struct Keyboard<K> {
    delay: Duration,
    interval: Duration,
    repeats: Option<(K, Duration)>,
}

impl<K: Copy + Eq> Keyboard<K> {
    /// A keyboard that repeats after `delay`, and then so many times a second.
    pub(crate) fn new(delay: Duration, per_second: u32) -> Self {
        Self { delay, interval: Duration::from_secs(1) / per_second, repeats: None }
    }

    /// A key goes down at `now`, and sends its byte.
    pub(crate) fn press(&mut self, key: K, now: Duration) -> K {
        self.repeats = Some((key, now + self.delay));
        key
    }

    /// A key goes up.
    pub(crate) fn release(&mut self, key: K) {
        self.repeats = self.repeats.filter(|&(other, _)| other != key);
    }

    /// The next byte that is due at or before `now`, and when it is.
    pub(crate) fn next_byte(&mut self, now: Duration) -> Option<(K, Duration)> {
        let (key, due) = self.repeats.filter(|&(_, due)| due <= now)?;
        self.repeats = Some((key, due + self.interval));
        Some((key, due))
    }
}
