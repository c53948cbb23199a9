//! How long a link is busy with bytes, and how long it takes besides: a line through recent frames.
//!
//! A frame of b bytes takes c + b / rate. Weighted least squares finds both, where a frame counts
//! the less the more there were after it (exponential forgetting; Haykin, *Adaptive Filter Theory*,
//! "recursive least squares"). What Google's congestion control estimates is the same pair:
//! draft-alvestrand-rmcat-congestion, "arrival-time filter", with a Kalman filter over differences.
//! Bytes over busy time was refused: jitter is then taken for slowness, frames are made smaller,
//! jitter weighs the more, and so on to the smallest ones.
//!
//! Frames that are alike say nothing of c. A point at no bytes and no time stands for what is to be
//! expected then, that there is no jitter; it counts little, and frames that differ outweigh it.

/// Sums over frames, of bytes and seconds.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Fit {
    weight: f64,
    bytes: f64,
    seconds: f64,
    bytes_squared: f64,
    products: f64,
    seconds_squared: f64,
}

/// The line, in seconds and seconds a byte.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// What a frame takes whatever its size.
    pub(super) constant: f64,
    pub(super) per_byte: f64,
    /// Seconds a byte of the line through the origin: as many as there can be.
    pub(super) through_origin: f64,
    /// The standard error of the slope.
    pub(super) error: f64,
    /// The standard deviation of frames from the line.
    pub(super) deviation: f64,
}

/// How much of the past counts after one more frame.
const KEPT: f64 = 0.97;
/// What the point at the origin counts, beside 1 for the latest frame.
const ORIGIN: f64 = 0.25;

impl Fit {
    pub(super) fn add(&mut self, bytes: f64, seconds: f64) {
        self.weight = self.weight * KEPT + 1.0;
        self.bytes = self.bytes * KEPT + bytes;
        self.seconds = self.seconds * KEPT + seconds;
        self.bytes_squared = self.bytes_squared * KEPT + bytes * bytes;
        self.products = self.products * KEPT + bytes * seconds;
        self.seconds_squared = self.seconds_squared * KEPT + seconds * seconds;
    }

    /// The mean bytes and seconds of a frame; `None` where there was none.
    pub(super) fn mean(&self) -> Option<(f64, f64)> {
        (self.weight > 0.0).then(|| (self.bytes / self.weight, self.seconds / self.weight))
    }

    /// The line, with neither coefficient below zero; `None` where there was no frame.
    pub(super) fn line(&self) -> Option<Line> {
        let (mean_bytes, mean_seconds) = self.mean()?;
        let weight = self.weight + ORIGIN;
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
        Some(Line {
            constant: constant.max(0.0),
            per_byte,
            through_origin,
            error: (residual / variance).sqrt(),
            deviation: residual.sqrt(),
        })
    }
}
