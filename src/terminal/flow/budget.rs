//! A budget of bytes: a token bucket that limits the bytes of frames on the wire, after compression.

use std::num::NonZero;
use std::time::Duration;

/// A token bucket of bytes, stored as the time at which it is full again (the generic cell rate algorithm, ITU-T I.371),
/// and the measurements from which frames are planned.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Budget {
    bytes_per_second: f64,
    /// The time at which the bucket is full again.
    full_at: Duration,
    /// The bytes that the wire carries for each byte of a frame.
    wire_share: f64,
    /// The mean bytes that recent frames of motion would take if they were exact.
    exact_bytes: f64,
}

/// The time in which an empty bucket fills. A frame may be sent unless the bucket is overdrawn. The first frame of a
/// picture takes several times the bytes of the others.
const BURST: Duration = Duration::from_secs(1);
/// The interval of frames for which the budget is planned.
const FRAME_TIME: Duration = Duration::from_millis(50);
/// The share of the budget that frames aim at. Without a reserve, frames that answer keys wait for the budget.
const USED: f64 = 0.85;
/// The weight of the latest frame in means.
const WEIGHT: f64 = 0.1;

impl Budget {
    /// A budget of this number of bytes per second.
    pub(crate) fn new(bytes_per_second: NonZero<u32>) -> Self {
        let bytes_per_second = f64::from(bytes_per_second.get());
        Self { bytes_per_second, full_at: Duration::ZERO, wire_share: 1.0, exact_bytes: 0.0 }
    }

    /// The number of bytes of frames that it allows per second.
    fn rate(&self) -> f64 {
        self.bytes_per_second / self.wire_share
    }

    /// Records that a frame of this number of bytes was sent.
    pub(crate) fn sent(&mut self, now: Duration, bytes: usize) {
        let time = Duration::from_secs_f64(bytes as f64 / self.rate());
        self.full_at = self.full_at.max(now) + time;
    }

    /// Records that a frame of motion would have taken this number of bytes if it were exact.
    pub(crate) fn sent_motion(&mut self, exact_bytes: f64) {
        self.exact_bytes += (exact_bytes - self.exact_bytes) * WEIGHT;
    }

    /// The bytes of exact frames, one in each [`FRAME_TIME`], as a multiple of the budget.
    ///
    /// Rejected: the largest recent frame in place of the mean. Frames then took half of the budget, because smaller
    /// frames follow a large one and let the bucket fill again.
    pub(crate) fn excess(&self) -> f64 {
        self.exact_bytes / FRAME_TIME.as_secs_f64() / (self.rate() * USED)
    }

    /// The least time between two frames: more frames would be coarser. Zero if all frames can be exact.
    pub(crate) fn frame_time(&self) -> Duration {
        if self.excess() > 1.0 { FRAME_TIME } else { Duration::ZERO }
    }

    /// Records that the wire has carried a frame of `bytes` bytes with `on_wire` bytes.
    pub(crate) fn carried(&mut self, bytes: usize, on_wire: usize) {
        if bytes > 0 && on_wire > 0 {
            let share = on_wire as f64 / bytes as f64;
            self.wire_share += (share - self.wire_share) * WEIGHT;
        }
    }

    /// The time from which on the next frame may be sent.
    pub(crate) fn opens_at(&self) -> Duration {
        self.full_at.saturating_sub(BURST)
    }
}
