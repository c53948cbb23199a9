//! Frames of a player, from an encoder or of random sizes.

use std::time::Duration;

use crate::terminal::Fidelity;

/// Frames of a player in motion.
pub(crate) trait FrameSource {
    /// The size of a frame that is drawn at `now`, in bytes. `draw` is a random number below 1.
    fn bytes(&mut self, now: Duration, fidelity: Fidelity, draw: f64) -> f64;

    /// The share of a frame's bytes that is left after compression.
    fn carried(&self, fidelity: Fidelity) -> f64;
}

/// The distribution of frame sizes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frames {
    /// The mean size of exact frames, in bytes.
    pub(crate) exact: f64,
    /// The maximum deviation from the mean, as a share of it.
    pub(crate) spread: f64,
    /// The share of the bytes that is left after compression: of an exact frame, and of a coarse
    /// one.
    pub(crate) compressed: [f64; 2],
}

impl Frames {
    /// The frames of a walk through the citadel at 120×40, as `cellcaster wire` measures them.
    pub(crate) const CITADEL: Self = Self { exact: 27_000.0, spread: 0.6, compressed: [1.0, 1.0] };
    /// The same frames with `ssh -C`.
    pub(crate) const COMPRESSED: Self = Self { compressed: [0.183, 0.225], ..Self::CITADEL };

    pub(crate) fn all_of(bytes: usize) -> Self {
        Self { exact: bytes as f64, spread: 0.0, compressed: [1.0, 1.0] }
    }
}

impl FrameSource for Frames {
    fn bytes(&mut self, _: Duration, fidelity: Fidelity, draw: f64) -> f64 {
        self.exact * (1.0 + self.spread * (2.0 * draw - 1.0)) / saving(fidelity)
    }

    fn carried(&self, fidelity: Fidelity) -> f64 {
        let [exact, coarse] = self.compressed;
        if fidelity == Fidelity::EXACT { exact } else { coarse }
    }
}

/// The factor by which frames are smaller at `fidelity`.
pub(crate) fn saving(fidelity: Fidelity) -> f64 {
    1.0 + f64::from(fidelity.tolerance()) * 0.3
}
