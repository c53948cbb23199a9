//! Distributions of durations.

use std::array;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// How many durations were at most as long as each of a few bounds.
#[derive(Debug)]
pub struct Histogram {
    /// The durations of each bucket; those of the last one are longer than every bound.
    buckets: [AtomicU64; BOUNDS.len() + 1],
    /// The sum in nanoseconds.
    nanoseconds: AtomicU64,
}

/// In microseconds. A frame takes a few hundred, a step of a room is one of 16,667, and above 50,000
/// a player feels the delay of a key.
pub(crate) const BOUNDS: [u64; 15] = [
    100, 250, 500, 1000, 2500, 5000, 10_000, 16_667, 25_000, 50_000, 100_000, 250_000, 500_000,
    1_000_000, 2_500_000,
];

/// What a histogram holds at one time.
pub(crate) struct Distribution {
    /// For each bound, and for no bound, the number of durations up to it.
    pub(crate) up_to: [u64; BOUNDS.len() + 1],
    /// In seconds.
    pub(crate) sum: f64,
}

impl Histogram {
    /// Adds a duration.
    pub fn add(&self, time: Duration) {
        // A microsecond that has begun counts, so that a bucket holds nothing above its bound.
        let microseconds = time.as_nanos().div_ceil(1000);
        let bucket = BOUNDS.partition_point(|&bound| u128::from(bound) < microseconds);
        self.buckets[bucket].fetch_add(1, Ordering::Relaxed);
        let nanoseconds = u64::try_from(time.as_nanos()).unwrap_or(u64::MAX);
        self.nanoseconds.fetch_add(nanoseconds, Ordering::Relaxed);
    }

    /// The number of durations, and their mean in seconds.
    #[cfg(test)]
    pub(crate) fn count_and_mean(&self) -> (u64, f64) {
        let Distribution { up_to, sum } = self.distribution();
        let count = up_to[BOUNDS.len()];
        (count, sum / count as f64)
    }

    pub(crate) fn distribution(&self) -> Distribution {
        let mut count = 0;
        let up_to = array::from_fn(|bucket| {
            count += self.buckets[bucket].load(Ordering::Relaxed);
            count
        });
        let sum = Duration::from_nanos(self.nanoseconds.load(Ordering::Relaxed)).as_secs_f64();
        Distribution { up_to, sum }
    }
}

impl Default for Histogram {
    /// No durations.
    fn default() -> Self {
        Self { buckets: array::from_fn(|_| AtomicU64::new(0)), nanoseconds: AtomicU64::new(0) }
    }
}
