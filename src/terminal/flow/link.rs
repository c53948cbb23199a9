//! Estimates of a link from the terminal's answers: its minimum round-trip time, rate and jitter.

use std::time::Duration;

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

/// The time that a link takes for a frame, as a function of its bytes: a line through recent frames, by sums over them
/// in bytes and seconds.
///
/// A frame of b bytes takes c + b / rate. Weighted least squares finds both coefficients, with weights that fall
/// exponentially with age (Haykin, *Adaptive Filter Theory*, "recursive least squares"). Google's congestion control
/// estimates the same pair with a Kalman filter over differences (draft-alvestrand-rmcat-congestion, "arrival-time
/// filter").
///
/// Frames of one size do not determine c. A point at 0 bytes and 0 seconds represents the expectation that there is no
/// jitter. Its weight is small, and frames of different sizes outweigh it.
///
/// Rejected: the quotient of bytes and time as the rate. Jitter then lowers the rate, so that frames become smaller and
/// jitter lowers it more, until frames are as small as possible.
#[derive(Clone, Copy, Debug, Default)]
struct Fit {
    weight: f64,
    bytes: f64,
    seconds: f64,
    bytes_squared: f64,
    products: f64,
    seconds_squared: f64,
}

/// The line, in seconds and seconds a byte.
#[derive(Clone, Copy, Debug)]
struct Line {
    /// The time of a frame of 0 bytes.
    constant: f64,
    per_byte: f64,
    /// The slope of the line through the origin, which is the largest possible slope.
    through_origin: f64,
    /// The standard deviation of frames from the line.
    deviation: f64,
}

/// The weight of the past after one more frame.
const FORGETTING_FACTOR: f64 = 0.97;
/// The weight of the point at the origin, relative to the latest frame's.
const ORIGIN_WEIGHT: f64 = 0.25;

impl Fit {
    /// Adds a frame.
    fn add(&mut self, bytes: f64, seconds: f64) {
        self.weight = self.weight * FORGETTING_FACTOR + 1.0;
        self.bytes = self.bytes * FORGETTING_FACTOR + bytes;
        self.seconds = self.seconds * FORGETTING_FACTOR + seconds;
        self.bytes_squared = self.bytes_squared * FORGETTING_FACTOR + bytes * bytes;
        self.products = self.products * FORGETTING_FACTOR + bytes * seconds;
        self.seconds_squared = self.seconds_squared * FORGETTING_FACTOR + seconds * seconds;
    }

    /// The mean bytes and seconds of a frame; `None` if there was no frame.
    fn mean(&self) -> Option<(f64, f64)> {
        (self.weight > 0.0).then(|| (self.bytes / self.weight, self.seconds / self.weight))
    }

    /// The line, with neither coefficient below zero; `None` if there was no frame.
    fn line(&self) -> Option<Line> {
        let (mean_bytes, mean_seconds) = self.mean()?;
        let weight = self.weight + ORIGIN_WEIGHT;
        let (center_bytes, center_seconds) = (self.bytes / weight, self.seconds / weight);
        let variance = self.bytes_squared - center_bytes * self.bytes;
        let covariance = self.products - center_bytes * self.seconds;
        if variance <= 0.0 {
            return None;
        }
        let through_origin = mean_seconds / mean_bytes;
        let per_byte = (covariance / variance).clamp(0.0, through_origin);
        let constant = center_seconds - per_byte * center_bytes;
        let total = self.seconds_squared - center_seconds * self.seconds;
        let residual = (total - 2.0 * per_byte * covariance + per_byte * per_byte * variance)
            .max(0.0)
            / weight;
        let deviation = residual.sqrt();
        Some(Line { constant: constant.max(0.0), per_byte, through_origin, deviation })
    }
}

/// The minimum of recent round-trip times, of this half of a window and of the one before it: the delay of the link
/// in both directions, without queues.
///
/// The minimum of all times would stay wrong after the route has become longer. This is the windowed minimum filter of
/// BBR (draft-cardwell-iccrg-bbr-congestion-control, "`BBR.min_rtt`").
#[derive(Clone, Copy, Debug)]
struct MinRoundTrip {
    since: Duration,
    current: Duration,
    previous: Duration,
}

/// The length of half of the window.
const HALF_WINDOW: Duration = Duration::from_secs(30);

impl MinRoundTrip {
    /// The minimum after a `round_trip` that ended at `now`.
    fn with(before: Option<Self>, now: Duration, round_trip: Duration) -> Self {
        match before {
            None => Self { since: now, current: round_trip, previous: round_trip },
            Some(old) if now.saturating_sub(old.since) > HALF_WINDOW => {
                Self { since: now, current: round_trip, previous: old.current }
            }
            Some(old) => Self { current: old.current.min(round_trip), ..old },
        }
    }

    fn get(self) -> Duration {
        self.current.min(self.previous)
    }
}
