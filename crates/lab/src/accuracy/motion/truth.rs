//! The analytic solution of a damped motion in fixed point.

use super::super::fixed_point::Fixed;
use super::Motion;

/// Where a motion should be.
pub(crate) struct Truth {
    velocity: Fixed,
    place: Fixed,
}

impl Truth {
    /// The truth after `steps` steps: `v = w·(1 − e^(−rate·t))`, and
    /// `x = w·(t − (1 − e^(−rate·t)) / rate)`.
    pub(crate) fn new(motion: &Motion, steps: u64) -> Self {
        let [rate, step, target] = [motion.rate, motion.step, motion.target].map(Fixed::new);
        let time = &step * &Fixed::new(steps as f64);
        let approached = &Fixed::new(1.0) - &(&rate * &time).exponential_of_minus();
        let lag = &approached / &rate;
        Self { velocity: &target * &approached, place: &target * &(&time - &lag) }
    }

    /// The absolute errors of a velocity and a place; infinite for those that are not finite.
    pub(crate) fn errors(&self, (velocity, place): (f64, f64)) -> [f64; 2] {
        [(velocity, &self.velocity), (place, &self.place)].map(|(value, truth)| {
            if value.is_finite() {
                (&Fixed::new(value) - truth).to_f64().abs()
            } else {
                f64::INFINITY
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_ends_at_its_target() {
        let motion = Motion { rate: 1e9, step: 0.5, target: 3.0 };
        let [velocity, place] = Truth::new(&motion, 4).errors((3.0, 6.0));
        assert!(velocity == 0.0 && (place - 3e-9).abs() < 1e-20, "{velocity} {place}");
        assert_eq!(Truth::new(&motion, 4).errors((f64::NAN, 0.0))[0], f64::INFINITY);
    }
}
