//! A token bucket: a limit on a rate that allows bursts.

use std::time::Duration;

/// A token bucket. It starts full.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bucket {
    per_second: f64,
    most: f64,
    tokens: f64,
    filled: Duration,
}

impl Bucket {
    /// Creates a bucket that holds `most` tokens and refills at `per_second` tokens per second.
    pub(crate) fn new(per_second: f64, most: f64, now: Duration) -> Self {
        Self { per_second, most, tokens: most, filled: now }
    }

    /// Refills the bucket up to `now`, and returns the number of tokens.
    pub(crate) fn fill(&mut self, now: Duration) -> f64 {
        let added = now.saturating_sub(self.filled).as_secs_f64() * self.per_second;
        self.tokens = (self.tokens + added).min(self.most);
        self.filled = now;
        self.tokens
    }

    /// The time until the bucket holds `tokens`, if nobody takes any; zero if it holds them now.
    pub(crate) fn time_until(&self, tokens: f64) -> Duration {
        Duration::from_secs_f64((tokens - self.tokens).max(0.0) / self.per_second)
    }

    /// Takes tokens. The number of tokens may become negative.
    pub(crate) fn take(&mut self, tokens: f64) {
        self.tokens -= tokens;
    }

    /// Takes one token. Returns false if less than one is left.
    pub(crate) fn takes_one(&mut self, now: Duration) -> bool {
        let takes = self.fill(now) >= 1.0;
        if takes {
            self.take(1.0);
        }
        takes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_burst_passes_at_once_and_the_rest_at_the_rate() {
        let mut bucket = Bucket::new(200.0, 300.0, Duration::ZERO);
        let mut taken = |milliseconds| {
            let now = Duration::from_millis(milliseconds);
            (0..1000).filter(|_| bucket.takes_one(now)).count()
        };
        assert_eq!([1000, 1000, 1500, 1501, 60_000].map(&mut taken), [300, 0, 100, 0, 300]);
    }
}
