//! Measurements of how busy the server is, and the frame rate and effort that follow from them.
//!
//! If processor time is short, frames are first encoded greedily instead of by search, which takes a third of the time.
//! Then frame rates drop evenly, before anything else waits: rooms keep their 60 steps a second, and the answer to a key
//! comes with the next frame. The governor holds the processor at [`TARGET`]. A full processor does not tell by how much
//! it is overloaded, so the rate then drops by a fifth for each decision.
//!
//! Rejected: a rate for each session. The latest visitor would get the worst picture. Rejected: raising the rate by one
//! frame a second while a quarter of the processor is idle. That quarter stayed idle.

#[cfg(test)]
mod simulated;
#[cfg(test)]
mod simulation;

use std::mem::{replace, take};
use std::num::NonZero;
use std::sync::{Arc, Mutex};
use std::thread::available_parallelism;
use std::time::Duration;

#[cfg(test)]
pub(crate) use self::simulated::{Work, Worker};
use crate::lock::locked;
use crate::metrics::{Metrics, cpu_time};
use cellcaster::terminal::Effort;

/// Measurements from all rooms and sessions, and the rate that follows from them.
#[derive(Debug)]
pub(crate) struct Load {
    pub(crate) metrics: Arc<Metrics>,
    state: Mutex<LoadState>,
    /// The number of processors that this process may use.
    processors: f64,
    /// The clock of this process's processor time.
    clock: fn() -> Duration,
    #[cfg(test)]
    worker: Worker,
}

#[derive(Debug)]
struct LoadState {
    /// The sum of the delays of all steps since the last decision, and their number.
    lateness: Duration,
    steps: u32,
    /// The processor time of this process at the last decision.
    used: Duration,
    governor: Governor,
    rate: Rate,
}

impl Load {
    /// Creates a load without measurements. It also records them in `metrics`.
    pub(crate) fn new(metrics: Arc<Metrics>) -> Self {
        let processors = available_parallelism().map_or(1, NonZero::get) as f64;
        // If the processor time is unknown, only late steps lower the frame rate.
        Self::with(metrics, processors, || cpu_time().unwrap_or_default())
    }

    fn with(metrics: Arc<Metrics>, processors: f64, clock: fn() -> Duration) -> Self {
        let mut governor = Governor::new();
        let rate = governor.decide(Sample::default(), FIRST_RATE);
        let (lateness, steps, used) = (Duration::ZERO, 0, clock());
        Self {
            metrics,
            state: Mutex::new(LoadState { lateness, steps, used, governor, rate }),
            processors,
            clock,
            #[cfg(test)]
            worker: Worker::default(),
        }
    }

    /// Records by how much a step of a room was late.
    pub(crate) fn note_lateness(&self, lateness: Duration) {
        locked(&self.state, |state| {
            state.lateness += lateness;
            state.steps += 1;
        });
        self.metrics.step_lateness.observe(lateness);
    }

    /// Decides about the rate, by the measurements since the last decision, which was `time` ago. `most` is the
    /// configured limit in frames a second.
    pub(crate) fn decide(&self, time: Duration, most: u32) {
        let now = (self.clock)();
        locked(&self.state, |state| {
            let lateness = take(&mut state.lateness) / take(&mut state.steps).max(1);
            let used = now.saturating_sub(replace(&mut state.used, now));
            let available = (time + lateness).as_secs_f64() * self.processors;
            let sample = Sample { busy: used.as_secs_f64() / available, lateness };
            state.rate = state.governor.decide(sample, most);
        });
    }

    /// The rate of each session.
    pub(crate) fn rate(&self) -> Rate {
        locked(&self.state, |state| state.rate)
    }
}

/// The least time between two frames of a session, and the effort for each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rate {
    pub(crate) frame_time: Duration,
    pub(crate) effort: Effort,
}

/// Measurements since the last decision.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Sample {
    /// The share of the available processor time that was used, from 0 to 1.
    busy: f64,
    /// The mean delay of the steps of rooms.
    lateness: Duration,
}

/// The state of the policy for the frame rate.
#[derive(Clone, Debug)]
struct Governor {
    /// The rate in frames a second; [`f64::INFINITY`] for no limit.
    rate: f64,
    effort: Effort,
    /// The mean busy share of about the last three seconds.
    usual: f64,
}

/// The limit until the configured one is known, in frames a second.
const FIRST_RATE: u32 = 30;
/// The lowest rate, in frames a second.
const MIN_RATE: f64 = 5.0;
/// The busy share that the governor aims at while it limits the rate.
const TARGET: f64 = 0.95;
/// The busy share from which the processor counts as full.
const FULL: f64 = 0.98;
/// The largest factor by which a decision raises the rate.
const MAX_RISE: f64 = 1.05;
/// The mean delay of steps at which the rate drops: one step. Rejected: the longest delay. If other
/// programs use the machine, some step is late in each quarter of a second.
const LATE: Duration = Duration::from_micros(16_667);
/// The busy share from which frames are encoded greedily.
const GREEDY_FROM: f64 = 0.6;
/// The usual busy share below which they are encoded by search again. A frame takes up to 2.5 times as long then, so
/// the share stays below [`GREEDY_FROM`]. Rejected: the share of the last quarter of a second. If another program takes
/// the processor for so long, the share is low.
const SEARCH_BELOW: f64 = 0.2;
/// The weight of the latest sample in the usual share.
const WEIGHT: f64 = 0.08;

impl Governor {
    /// A governor without a limit.
    fn new() -> Self {
        Self { rate: f64::INFINITY, effort: Effort::Search, usual: 0.0 }
    }

    /// The rate of each session. `most` is the configured limit in frames a second.
    fn decide(&mut self, Sample { busy, lateness }: Sample, most: u32) -> Rate {
        let most = f64::from(most).max(MIN_RATE);
        let is_full = busy >= FULL || lateness >= LATE;
        self.usual += (busy - self.usual) * WEIGHT;
        if is_full || busy >= GREEDY_FROM {
            self.effort = Effort::Greedy;
            self.usual = self.usual.max(GREEDY_FROM);
        } else if self.usual < SEARCH_BELOW {
            self.effort = Effort::Search;
        }
        let factor = if is_full { 0.8 } else { (TARGET / busy).min(MAX_RISE) };
        self.rate = (self.rate.min(most) * factor).clamp(MIN_RATE, most);
        Rate { frame_time: Duration::from_secs_f64(1.0 / self.rate), effort: self.effort }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const BUSY_ALL: Sample = Sample { busy: 1.0, lateness: Duration::ZERO };

    fn frames_a_second(rate: Rate) -> f64 {
        1.0 / rate.frame_time.as_secs_f64()
    }

    #[test]
    fn the_rate_falls_and_rises_within_ten_seconds() {
        let mut governor = Governor::new();
        let first = governor.decide(Sample::default(), 30);
        assert!((frames_a_second(first) - 30.0).abs() < 0.01);
        let fallen = (0..9).map(|_| frames_a_second(governor.decide(BUSY_ALL, 30))).last().unwrap();
        assert!(fallen < 5.1, "{fallen}");
        let rates: Vec<f64> =
            (0..40).map(|_| frames_a_second(governor.decide(Sample::default(), 30))).collect();
        assert!(rates[9] < 10.0 && rates[39] > 29.9, "{rates:?}");
    }

    #[test]
    fn late_steps_count_whatever_the_threads_do() {
        let mut governor = Governor::new();
        let late = Sample { busy: 0.1, lateness: Duration::from_millis(40) };
        assert!(frames_a_second(governor.decide(late, 30)) < 25.0);
    }

    /// A frame by search takes 2.5 times as long as a greedy one. Before the efforts had different thresholds, they
    /// alternated.
    #[test]
    fn the_effort_settles() {
        for of_search in [0.1, 0.3, 0.5, 0.59, 0.7, 1.2] {
            let (mut governor, mut efforts) = (Governor::new(), Vec::new());
            for _ in 0..40 {
                let is_greedy = efforts.last() == Some(&Effort::Greedy);
                let busy = f64::min(if is_greedy { of_search / 2.5 } else { of_search }, 1.0);
                efforts.push(governor.decide(Sample { busy, lateness: Duration::ZERO }, 30).effort);
            }
            let changes = efforts.windows(2).filter(|pair| pair[0] != pair[1]).count();
            assert!(changes <= 1, "{of_search}: {efforts:?}");
        }
    }

    /// Players on one processor, whose frames take 130 µs if they are greedy and 270 µs if not. Now and then, another
    /// program takes the processor for a quarter of a second.
    #[test]
    fn one_to_a_thousand_players_leave_at_most_a_twentieth_of_the_processor_idle() {
        for (players, greedy, rate) in [
            (1, false, 30.0),
            (10, false, 30.0),
            (60, false, 30.0),
            (90, true, 30.0),
            (240, true, 30.0),
            (400, true, 18.3),
            (700, true, 10.4),
            (1000, true, 7.3),
        ] {
            let mut governor = Governor::new();
            let mut last = governor.decide(Sample::default(), 30);
            let mut frames = 0.0;
            for decision in 1..=860 {
                let time = if last.effort == Effort::Greedy { 130e-6 } else { 270e-6 };
                let busy = f64::min(f64::from(players) * frames_a_second(last) * time, 1.0);
                let busy = if decision % 200 == 0 { busy / 10.0 } else { busy };
                last = governor.decide(Sample { busy, lateness: Duration::ZERO }, 30);
                if decision > 60 {
                    assert_eq!(last.effort == Effort::Greedy, greedy, "{players}, {decision}");
                    frames += frames_a_second(last) / 800.0;
                }
            }
            assert!((frames / rate - 1.0).abs() < 0.02, "{players}: {frames}");
        }
    }

    proptest! {
        #[test]
        fn the_rate_stays_in_its_range_and_moves_in_small_steps(
            samples in prop::collection::vec((0.0..=2.0_f64, 0_u64..2000), 1..200),
            most in 1_u32..240,
        ) {
            let mut governor = Governor::new();
            let mut last = f64::from(most).max(MIN_RATE);
            for (busy, lateness) in samples {
                let sample = Sample { busy, lateness: Duration::from_millis(lateness) };
                let rate = frames_a_second(governor.decide(sample, most));
                prop_assert!(rate > MIN_RATE - 0.01 && rate < f64::from(most).max(MIN_RATE) + 0.01);
                prop_assert!(rate > last * 0.79 && rate < last * 1.051);
                last = rate;
            }
        }
    }
}
