//! Estimates of a link from the terminal's answers: its minimum round-trip time, rate and jitter.

use std::time::Duration;

use super::fit::Fit;
use super::min_round_trip::MinRoundTrip;

/// The estimates of a link.
#[derive(Debug, Default)]
pub(crate) struct Link {
    min_round_trip: Option<MinRoundTrip>,
    last_round_trip: Option<Duration>,
    answered_at: Duration,
    fit: Fit,
    /// The latest frame, if it took far longer than expected.
    outlier: Option<Transfer>,
    stalled_at: Option<Duration>,
}

/// A frame, and the time for which it occupied the link.
#[derive(Clone, Copy, Debug)]
struct Transfer {
    bytes: f64,
    seconds: f64,
}

/// The shortest time of a frame that can be measured.
const MIN_TRANSFER: Duration = Duration::from_micros(100);
/// An outlier is a frame that takes longer than expected by this number of standard deviations, and
/// by this number of seconds.
const OUTLIER_DEVIATIONS: f64 = 4.0;
const OUTLIER_SECONDS: f64 = 0.25;
/// An outlier of at least this number of seconds is a stall; a shorter one may be jitter.
const STALL_SECONDS: f64 = 1.0;
/// The factor by which the fitted time of a byte is increased, up to the slope of the line through
/// the origin. Where time grows with the bytes, the link is narrow, and the constant part of the
/// time may belong to other frames on it. Without the margin, two sessions on 2 Mbit/s send finer
/// frames than their shares carry, 12.5 a second in place of 20. With the whole margin (the line
/// through the origin), jitter counts as slowness: at 1 Mbit/s with 0 to 50 ms of it, the largest
/// error of frames is 41 in place of 21.
const SLOPE_MARGIN: f64 = 1.5;
/// An answer is late after this number of standard deviations: Jacobson and Karels, RFC 6298.
const LATE_DEVIATIONS: f64 = 4.0;
/// The resolution of the time of an answer.
const CLOCK_GRANULARITY: Duration = Duration::from_millis(10);
/// The limit in flight after a stall: the larger of this number of bytes and the bytes that the
/// link carries in this number of seconds. If it stalls again, all of them arrive before anything newer.
const AFTER_STALL_BYTES: f64 = 16_000.0;
const AFTER_STALL_SECONDS: f64 = 0.024;
/// The duration of that limit.
const AFTER_STALL: Duration = Duration::from_mins(1);
/// The longest computed time: a day, in seconds.
const MAX_SECONDS: f64 = 86_400.0;

impl Link {
    /// Updates the estimates with the answer to a frame.
    pub(crate) fn answered(&mut self, now: Duration, sent_at: Duration, bytes: usize) {
        let round_trip = now.saturating_sub(sent_at);
        let minimum = MinRoundTrip::with(self.min_round_trip, now, round_trip);
        // The link could begin to carry it when the first byte could arrive and the frame before it
        // had arrived.
        let begun = (sent_at + minimum.get()).max(self.answered_at);
        self.add_transfer(now, bytes, now.saturating_sub(begun));
        self.min_round_trip = Some(minimum);
        self.last_round_trip = Some(round_trip);
        self.answered_at = now;
    }

    /// Updates the estimates with a frame that the system has accepted.
    pub(crate) fn written(&mut self, now: Duration, sent_at: Duration, bytes: usize) {
        self.add_transfer(now, bytes, now.saturating_sub(sent_at));
        self.answered_at = now;
    }

    /// Adds a frame to the fit. One outlier is a stall, which is no evidence about the rate; two in
    /// a row mean that the link has changed.
    fn add_transfer(&mut self, now: Duration, bytes: usize, time: Duration) {
        if bytes == 0 {
            return;
        }
        let seconds = time.max(MIN_TRANSFER).as_secs_f64();
        let transfer = Transfer { bytes: bytes as f64, seconds };
        match self.outlier.take() {
            None if self.is_outlier(transfer) => {
                self.outlier = Some(transfer);
                if seconds >= STALL_SECONDS {
                    self.stalled_at = Some(now);
                }
            }
            Some(before) if self.is_outlier(transfer) => {
                self.fit = Fit::default();
                self.fit.add(before.bytes, before.seconds);
                self.fit.add(transfer.bytes, transfer.seconds);
            }
            _ => self.fit.add(transfer.bytes, transfer.seconds),
        }
    }

    fn is_outlier(&self, Transfer { bytes, seconds }: Transfer) -> bool {
        self.fit.line().is_some_and(|line| {
            let expected = line.constant + line.per_byte * bytes;
            seconds > expected + (OUTLIER_DEVIATIONS * line.deviation).max(OUTLIER_SECONDS)
        })
    }

    /// Whether the link has carried a frame.
    pub(crate) fn is_known(&self) -> bool {
        self.fit.mean().is_some()
    }

    /// Whether an answer can arrive after this short a time.
    pub(crate) fn is_plausible(&self, round_trip: Duration) -> bool {
        self.min_round_trip.is_none_or(|minimum| round_trip >= minimum.get() / 2)
    }

    /// The round-trip time of the latest answer.
    pub(crate) fn last_round_trip(&self) -> Option<Duration> {
        self.last_round_trip
    }

    fn seconds_per_byte(&self) -> f64 {
        let usual = self
            .fit
            .line()
            .map_or(0.0, |line| (line.per_byte * SLOPE_MARGIN).min(line.through_origin));
        self.outlier.map_or(usual, |transfer| usual.max(transfer.seconds / transfer.bytes))
    }

    /// The maximum of bytes a second that should be sent; `None` for no maximum.
    pub(crate) fn usable_rate(&self) -> Option<f64> {
        let seconds = self.seconds_per_byte();
        let rate = (seconds > 0.0).then(|| seconds.recip());
        let is_past = |at| self.answered_at.saturating_sub(at) > AFTER_STALL;
        if self.stalled_at.is_none_or(is_past) {
            return rate;
        }
        let in_flight = (AFTER_STALL_SECONDS * rate.unwrap_or(0.0)).max(AFTER_STALL_BYTES);
        let limit = in_flight / self.expected_round_trip().as_secs_f64().max(1e-3);
        Some(rate.map_or(limit, |rate| rate.min(limit)))
    }

    /// The time for which this number of bytes occupies the link.
    pub(crate) fn time_for(&self, bytes: usize) -> Duration {
        Duration::from_secs_f64((bytes as f64 * self.seconds_per_byte()).min(MAX_SECONDS))
    }

    /// The expected round-trip time of a frame of mean size that no other frame delays.
    pub(crate) fn expected_round_trip(&self) -> Duration {
        let bytes = self.fit.mean().map_or(0.0, |(bytes, _)| bytes);
        self.min_round_trip() + self.time_for(bytes as usize)
    }

    /// The mean excess of a round trip over its expected time.
    pub(crate) fn jitter(&self) -> Duration {
        Duration::from_secs_f64(self.fit.line().map_or(0.0, |line| line.constant))
    }

    /// The maximum excess of a round trip over its mean, unless the link has changed.
    pub(crate) fn jitter_range(&self) -> Duration {
        let deviation = self.fit.line().map_or(0.0, |line| line.deviation);
        Duration::from_secs_f64(LATE_DEVIATIONS * deviation)
    }

    /// The latest time at which the answer to the oldest frame in flight arrives, unless the link
    /// has changed; `None` if the link is unknown.
    pub(crate) fn latest_answer(&self, sent_at: Duration, bytes: usize) -> Option<Duration> {
        let begun = (sent_at + self.min_round_trip()).max(self.answered_at);
        let time = self.time_for(bytes) + self.jitter() + self.jitter_range();
        self.is_known().then(|| begun + time + CLOCK_GRANULARITY)
    }

    fn min_round_trip(&self) -> Duration {
        self.min_round_trip.map(MinRoundTrip::get).unwrap_or_default()
    }
}
