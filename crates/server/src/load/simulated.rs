//! The worker of a host in simulated time, in which computing would take no time.
//!
//! After each piece of work, the clock goes on by what the work costs, before anything else runs: so does it on a
//! host with one processor. What one visitor causes then delays all others, and a turn that is too long shows.
//!
//! A lock that work holds while it sleeps was refused: the task that works would let others run, which is what a turn
//! that is too long does not.

use std::pin::pin;
use std::sync::Arc;
use std::task::{Context, Waker};
use std::time::Duration;

use tokio::time::advance;

use super::Load;
use crate::metrics::Metrics;

/// What each piece of work costs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Worker {
    arrival: Duration,
    byte: Duration,
    frame: Duration,
    step: Duration,
}

/// A piece of work.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Work {
    /// A session has taken so many bytes that arrived together.
    Arrival(usize),
    /// A session has drawn a frame.
    Frame,
    /// A room has taken a step.
    Step,
}

impl Load {
    /// That of a host in simulated time, of which only the steps of rooms are measured.
    pub(crate) fn simulated(metrics: Arc<Metrics>, worker: Worker) -> Self {
        Self { worker, ..Self::with(metrics, 1.0, || Duration::ZERO) }
    }

    /// Lets the time of `work` that is done pass, in simulated time.
    pub(crate) fn spend(&self, work: Work) {
        self.worker.spend(work);
    }
}

impl Worker {
    /// One that takes 10 µs for a byte. What was measured is 3 µs for a typed letter and 7 µs for one that combines.
    pub(crate) const SLOW: Self = Self {
        arrival: Duration::from_micros(100),
        byte: Duration::from_micros(10),
        frame: Duration::from_millis(1),
        step: Duration::from_micros(100),
    };

    /// Lets the time of `work` pass.
    pub(crate) fn spend(self, work: Work) {
        let time = match work {
            Work::Arrival(bytes) => self.arrival + self.byte * bytes as u32,
            Work::Frame => self.frame,
            Work::Step => self.step,
        };
        if time > Duration::ZERO {
            // The clock goes on at the first look. At the second one, others would have run.
            _ = pin!(advance(time)).poll(&mut Context::from_waker(Waker::noop()));
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};

    use tokio::runtime::Builder;
    use tokio::time::{Instant, sleep};

    use super::*;

    #[test]
    fn time_passes_and_nobody_else_runs_before_work_is_done() {
        let runtime =
            Builder::new_current_thread().enable_time().start_paused(true).build().unwrap();
        runtime.block_on(async {
            let has_run = Arc::<AtomicBool>::default();
            let other = tokio::spawn({
                let has_run = Arc::clone(&has_run);
                async move {
                    sleep(Duration::from_millis(1)).await;
                    has_run.store(true, Ordering::Relaxed);
                }
            });
            let begun = Instant::now();
            Worker::SLOW.spend(Work::Arrival(1_000));
            assert_eq!(begun.elapsed(), Duration::from_micros(10_100));
            assert!(!has_run.load(Ordering::Relaxed));
            other.await.unwrap();
            assert!(begun.elapsed() >= Duration::from_millis(11));
        });
    }
}
