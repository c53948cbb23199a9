//! The time that a link takes for a frame, as a function of its bytes: a line through recent
//! frames.
//!
//! A frame of b bytes takes c + b / rate. Weighted least squares finds both coefficients, with
//! weights that fall exponentially with age (Haykin, *Adaptive Filter Theory*, "recursive least
//! squares"). Google's congestion control estimates the same pair with a Kalman filter over
//! differences (draft-alvestrand-rmcat-congestion, "arrival-time filter"). The quotient of bytes
//! and time as the rate was refused: jitter then lowers the rate, so that frames become smaller and
//! jitter lowers it more, until frames are as small as possible.
//!
//! Frames of one size do not determine c. A point at 0 bytes and 0 seconds represents the
//! expectation that there is no jitter; its weight is small, and frames of different sizes outweigh
//! it.

/// Sums over frames, in bytes and seconds.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Fit {
    weight: f64,
    bytes: f64,
    seconds: f64,
    bytes_squared: f64,
    products: f64,
    seconds_squared: f64,
}

/// The line, in seconds and seconds a byte.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    /// The time of a frame of 0 bytes.
    pub(crate) constant: f64,
    pub(crate) per_byte: f64,
    /// The slope of the line through the origin, which is the largest possible slope.
    pub(crate) through_origin: f64,
    /// The standard deviation of frames from the line.
    pub(crate) deviation: f64,
}

/// The weight of the past after one more frame.
const FORGETTING_FACTOR: f64 = 0.97;
/// The weight of the point at the origin, relative to that of the latest frame.
const ORIGIN_WEIGHT: f64 = 0.25;

impl Fit {
    /// Adds a frame.
    pub(crate) fn add(&mut self, bytes: f64, seconds: f64) {
        self.weight = self.weight * FORGETTING_FACTOR + 1.0;
        self.bytes = self.bytes * FORGETTING_FACTOR + bytes;
        self.seconds = self.seconds * FORGETTING_FACTOR + seconds;
        self.bytes_squared = self.bytes_squared * FORGETTING_FACTOR + bytes * bytes;
        self.products = self.products * FORGETTING_FACTOR + bytes * seconds;
        self.seconds_squared = self.seconds_squared * FORGETTING_FACTOR + seconds * seconds;
    }

    /// The mean bytes and seconds of a frame; `None` if there was no frame.
    pub(crate) fn mean(&self) -> Option<(f64, f64)> {
        (self.weight > 0.0).then(|| (self.bytes / self.weight, self.seconds / self.weight))
    }

    /// The line, with neither coefficient below zero; `None` if there was no frame.
    pub(crate) fn line(&self) -> Option<Line> {
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
