//! Measurements of how busy the server is, and the frame rate that follows from them.

#[cfg(test)]
mod worker;

use std::num::NonZero;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::available_parallelism;
use std::time::Duration;

#[cfg(test)]
pub(crate) use self::worker::{Work, Worker};
use crate::lock::locked;
use crate::ops::metrics::{Metrics, cpu_time};
use crate::sessions::governor::Sample;

/// Measurements that all rooms and sessions add to.
#[derive(Debug)]
pub(crate) struct Load {
    metrics: Arc<Metrics>,
    /// In microseconds: the sum of the delays of all steps since the last sample.
    lateness: AtomicU64,
    /// The number of those steps.
    steps: AtomicU64,
    /// In microseconds: the least time between two frames.
    frame_time: AtomicU64,
    /// The processor time of this process at the last sample.
    used: Mutex<Duration>,
    /// The processors that it may use.
    processors: f64,
    /// The clock of its processor time.
    clock: fn() -> Duration,
    #[cfg(test)]
    worker: Worker,
}

impl Load {
    /// Nothing measured yet; it adds to `metrics`, too.
    pub(crate) fn new(metrics: Arc<Metrics>) -> Self {
        let processors = available_parallelism().map_or(1, NonZero::get) as f64;
        // Where it is not known, late steps are all that lowers the frame rate.
        Self::with(metrics, processors, || cpu_time().unwrap_or_default())
    }

    /// That of a host in simulated time, of which only the steps of rooms are measured.
    #[cfg(test)]
    pub(crate) fn simulated(metrics: Arc<Metrics>, worker: Worker) -> Self {
        Self { worker, ..Self::with(metrics, 1.0, || Duration::ZERO) }
    }

    /// Lets the time of `work` that is done pass, in simulated time.
    #[cfg(test)]
    pub(crate) fn spend(&self, work: Work) {
        self.worker.spend(work);
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

    /// The figures of the server.
    pub(crate) fn metrics(&self) -> &Metrics {
        &self.metrics
    }

    /// Notes by how much a step of a room was late.
    pub(crate) fn note_lateness(&self, lateness: Duration) {
        self.lateness.fetch_add(micros(lateness), Ordering::Relaxed);
        self.steps.fetch_add(1, Ordering::Relaxed);
        self.metrics.step_lateness.observe(lateness.as_secs_f64());
    }

    /// What was measured in the last `time`, since the last call.
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
