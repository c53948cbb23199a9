//! Measurements of how busy the server is, and the frame rate that follows from them.
//!
//! The governor decides how many frames a second each session gets when processor time is short.
//!
//! Frame rates drop evenly before anything else waits: rooms keep their 60 steps a second, and the
//! answer to a key comes with the next frame. A decision lowers the rate by a fifth. The rate rises by
//! one frame a second after [`CALM`] decisions with time to spare, so that it does not oscillate.
//!
//! Rejected: a rate for each session. The latest visitor would get the worst picture.

#[cfg(test)]
mod simulated;

use std::num::NonZero;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::available_parallelism;
use std::time::Duration;

#[cfg(test)]
pub(crate) use self::simulated::{Work, Worker};
use crate::lock::locked;
use crate::metrics::{Metrics, cpu_time};

/// Measurements from all rooms and sessions.
#[derive(Debug)]
pub(crate) struct Load {
    pub(crate) metrics: Arc<Metrics>,
    /// The sum of the delays of all steps since the last sample, in microseconds.
    lateness: AtomicU64,
    /// The number of steps since the last sample.
    steps: AtomicU64,
    /// The least time between two frames, in microseconds.
    frame_time: AtomicU64,
    /// The processor time of this process at the last sample.
    used: Mutex<Duration>,
    /// The number of processors that this process may use.
    processors: f64,
    /// The clock of this process's processor time.
    clock: fn() -> Duration,
    #[cfg(test)]
    worker: Worker,
}

impl Load {
    /// Creates a load without measurements. It also records them in `metrics`.
    pub(crate) fn new(metrics: Arc<Metrics>) -> Self {
        let processors = available_parallelism().map_or(1, NonZero::get) as f64;
        // If the processor time is unknown, only late steps lower the frame rate.
        Self::with(metrics, processors, || cpu_time().unwrap_or_default())
    }

    fn with(metrics: Arc<Metrics>, processors: f64, clock: fn() -> Duration) -> Self {
        let used = Mutex::new(clock());
        let [lateness, steps] = [const { AtomicU64::new(0) }; 2];
        let frame_time = AtomicU64::new(33_333);
        Self {
            metrics,
            lateness,
            steps,
            frame_time,
            used,
            processors,
            clock,
            #[cfg(test)]
            worker: Worker::default(),
        }
    }

    /// Records by how much a step of a room was late.
    pub(crate) fn note_lateness(&self, lateness: Duration) {
        self.lateness.fetch_add(micros(lateness), Ordering::Relaxed);
        self.steps.fetch_add(1, Ordering::Relaxed);
        self.metrics.step_lateness.observe(lateness);
    }

    /// The measurements since the last call, which was `time` ago.
    pub(crate) fn sample(&self, time: Duration) -> Sample {
        let steps = self.steps.swap(0, Ordering::Relaxed).max(1);
        let lateness = Duration::from_micros(self.lateness.swap(0, Ordering::Relaxed) / steps);
        let now = (self.clock)();
        let used = locked(&self.used, |used| now.saturating_sub(std::mem::replace(used, now)));
        let available = (time + lateness).as_secs_f64() * self.processors;
        Sample { busy: used.as_secs_f64() / available, lateness }
    }

    /// The least time between two frames of a session.
    pub(crate) fn frame_time(&self) -> Duration {
        Duration::from_micros(self.frame_time.load(Ordering::Relaxed))
    }

    pub(crate) fn set_frame_time(&self, time: Duration) {
        self.frame_time.store(micros(time), Ordering::Relaxed);
    }
}

fn micros(time: Duration) -> u64 {
    u64::try_from(time.as_micros()).unwrap_or(u64::MAX)
}

/// Measurements since the last decision.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Sample {
    /// The share of the available processor time that was used, from 0 to 1.
    pub(crate) busy: f64,
    /// The mean delay of the steps of rooms.
    pub(crate) lateness: Duration,
}

/// The state of the policy for the frame rate.
#[derive(Clone, Debug)]
pub(crate) struct Governor {
    /// The rate in frames a second; [`f64::INFINITY`] for no limit.
    rate: f64,
    /// The number of consecutive decisions with time to spare.
    calm: u32,
}

/// The lowest rate, in frames a second.
const MIN: f64 = 5.0;
/// The busy share at which the rate drops.
const BUSY: f64 = 0.9;
/// The busy share below which the rate may rise.
const SPARE: f64 = 0.75;
/// The mean delay of steps at which the rate drops: one step. Rejected: the longest delay. If other
/// programs use the machine, some step is late in each quarter of a second.
const LATE: Duration = Duration::from_micros(16_667);
/// The number of decisions with time to spare after which the rate rises: a second.
const CALM: u32 = 4;

impl Governor {
    /// A governor without a limit.
    pub(crate) fn new() -> Self {
        Self { rate: f64::INFINITY, calm: 0 }
    }

    /// The least time between two frames of a session. `most` is the configured limit in frames a
    /// second.
    pub(crate) fn decide(&mut self, sample: Sample, most: u32) -> Duration {
        let most = f64::from(most).max(MIN);
        self.rate = self.rate.min(most);
        if sample.busy >= BUSY || sample.lateness >= LATE {
            self.calm = 0;
            self.rate = (self.rate * 0.8).max(MIN);
        } else if sample.busy < SPARE {
            self.calm += 1;
            if self.calm >= CALM {
                self.calm = 0;
                self.rate = (self.rate + 1.0).min(most);
            }
        } else {
            self.calm = 0;
        }
        Duration::from_secs_f64(1.0 / self.rate)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const BUSY_ALL: Sample = Sample { busy: 1.0, lateness: Duration::ZERO };

    fn rate(frame_time: Duration) -> f64 {
        1.0 / frame_time.as_secs_f64()
    }

    #[test]
    fn the_rate_falls_within_two_seconds_and_rises_in_half_a_minute() {
        let mut governor = Governor::new();
        assert!((rate(governor.decide(Sample::default(), 30)) - 30.0).abs() < 0.01);
        let fallen = (0..8).map(|_| rate(governor.decide(BUSY_ALL, 30))).last().unwrap();
        assert!(fallen < 5.1, "{fallen}");
        let rates: Vec<f64> =
            (0..100).map(|_| rate(governor.decide(Sample::default(), 30))).collect();
        assert!(rates[19] < 11.0 && rates[99] > 29.9, "{rates:?}");
    }

    #[test]
    fn late_steps_lower_the_rate_even_if_threads_are_idle() {
        let mut governor = Governor::new();
        let late = Sample { busy: 0.1, lateness: Duration::from_millis(40) };
        assert!(rate(governor.decide(late, 30)) < 25.0);
    }

    /// Each frame a second costs the share `cost` of the processor.
    #[test]
    fn the_rate_settles_when_threads_are_busy_but_not_full() {
        for cost in [0.01, 0.05, 0.09] {
            let (mut governor, mut frames) = (Governor::new(), 30.0);
            for decision in 0..400 {
                let busy = f64::min(frames * cost, 1.0);
                frames = rate(governor.decide(Sample { busy, lateness: Duration::ZERO }, 30));
                assert!(decision < 40 || frames * cost < 0.95, "{cost}: {frames}");
            }
            assert!(frames > 29.0 || frames * cost > 0.6, "{cost}: {frames}");
        }
    }

    proptest! {
        #[test]
        fn the_rate_stays_in_its_range_and_moves_in_small_steps(
            samples in prop::collection::vec((0.0..=2.0_f64, 0_u64..2000), 1..200),
            most in 1_u32..240,
        ) {
            let mut governor = Governor::new();
            let mut last = f64::from(most).max(MIN);
            for (busy, lateness) in samples {
                let sample = Sample { busy, lateness: Duration::from_millis(lateness) };
                let rate = rate(governor.decide(sample, most));
                prop_assert!(rate > MIN - 0.01 && rate < f64::from(most).max(MIN) + 0.01);
                prop_assert!(rate > last * 0.79 && rate < last + 1.01);
                last = rate;
            }
        }
    }
}
