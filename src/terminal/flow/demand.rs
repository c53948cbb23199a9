//! The fidelity at which frames of motion fit a rate.

use super::super::Fidelity;

/// The bytes that an exact frame of motion would take, estimated from the sent frames.
///
/// The fidelity follows from this estimate and the rate alone. Raising and lowering it step by step
/// was refused: it is then late at the beginning of motion, when lag is most noticeable.
#[derive(Debug, Default)]
pub(crate) struct Demand {
    exact_bytes: f64,
}

/// The number of frames a second for which the rate should suffice.
const FRAMES_PER_SECOND: f64 = 18.0;
/// An exact frame takes 1 + 0.32 t times the bytes of one at tolerance t: 3.6 times at 8, and 8.7
/// times at 24.
const SAVING: f64 = 0.32;
/// The share of a high estimate that is left after one more frame.
const DECAY: f64 = 0.99;
/// The coarsest fidelity: beyond it, fewer frames are better than coarser ones.
pub(crate) const MIN_FIDELITY: Fidelity = Fidelity::new(48);

impl Demand {
    /// Updates the estimate with a frame of motion.
    pub(crate) fn sent_motion(&mut self, bytes: usize, fidelity: Fidelity) {
        let saving = 1.0 + f64::from(fidelity.tolerance()) * SAVING;
        self.exact_bytes = (self.exact_bytes * DECAY).max(bytes as f64 * saving);
    }

    /// The best fidelity for a link that carries `rate` bytes a second.
    pub(crate) fn fidelity_within(&self, rate: f64) -> Fidelity {
        let excess = self.exact_bytes * FRAMES_PER_SECOND / rate;
        let tolerance = (excess - 1.0).max(0.0) / SAVING;
        Fidelity::new(tolerance.min(f64::from(MIN_FIDELITY.tolerance())).round() as u8)
    }
}
