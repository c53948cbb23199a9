//! How exact frames can be on a link that carries so much.

use super::super::Fidelity;

/// How many bytes a frame of motion would take if it were exact, judged by those that were sent.
///
/// The tolerance follows from that and from what the link carries, without a memory of its own. A
/// tolerance that goes up and down step by step was refused: it is late where motion begins,
/// which is when lag is felt.
#[derive(Debug, Default)]
pub(super) struct Demand {
    exact_bytes: f64,
}

/// How many frames a second the link should have room for.
const FRAMES_PER_SECOND: f64 = 18.0;
/// An exact frame takes so many times the bytes more for each unit of tolerance: 3.6 times what one
/// takes at 8, and 8.7 times at 24.
const SAVING: f64 = 0.32;
/// How much of a high demand counts after one more frame.
const KEPT: f64 = 0.99;
/// From here on, fewer frames are better than worse ones.
pub(super) const LEAST_FIDELITY: Fidelity = Fidelity::new(48);

impl Demand {
    pub(super) fn showed_motion(&mut self, bytes: usize, fidelity: Fidelity) {
        let saving = 1.0 + f64::from(fidelity.tolerance()) * SAVING;
        self.exact_bytes = (self.exact_bytes * KEPT).max(bytes as f64 * saving);
    }

    /// The best fidelity for a link that carries `rate` bytes a second.
    pub(super) fn fidelity_within(&self, rate: f64) -> Fidelity {
        let excess = self.exact_bytes * FRAMES_PER_SECOND / rate;
        let tolerance = (excess - 1.0).max(0.0) / SAVING;
        Fidelity::new(tolerance.min(f64::from(LEAST_FIDELITY.tolerance())).round() as u8)
    }
}
