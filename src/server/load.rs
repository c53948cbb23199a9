//! Measurements of how busy the server is, for the governor.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// Measurements that all rooms and sessions add to.
#[derive(Debug, Default)]
pub(crate) struct Load {
    /// In microseconds: the latest step of a room since the last [`Load::take_lateness`].
    lateness: AtomicU64,
}

impl Load {
    /// Notes by how much a step of a room was late.
    pub(crate) fn note_lateness(&self, lateness: Duration) {
        let micros = u64::try_from(lateness.as_micros()).unwrap_or(u64::MAX);
        self.lateness.fetch_max(micros, Ordering::Relaxed);
    }

    /// By how much the latest step was late since the last call.
    pub(crate) fn take_lateness(&self) -> Duration {
        Duration::from_micros(self.lateness.swap(0, Ordering::Relaxed))
    }
}
