//! Damped motion in closed form: a velocity that approaches a target.
//!
//! The velocity v obeys dv/dt = rate · (target − v), so that the difference decays exponentially.
//! The velocity and the displacement at the end of a step are the analytic solution of this
//! equation. Steps may therefore have any length, and rates any size; two steps equal one step of
//! their combined length. Rejected: the explicit Euler method, which overshoots as soon as
//! `rate * dt` exceeds 1.

use glam::DVec2;

/// The state of a motion at the end of a step, and the displacement during it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DampedMotion<V> {
    /// Units per second.
    pub velocity: V,
    /// Units.
    pub displacement: V,
}

/// The motion after `duration` seconds. It begins with `velocity` and approaches `target`. The
/// difference between the two shrinks by the factor e every 1 / `rate` seconds. The result is
/// finite if all arguments are finite, `rate` is above 0 and `duration` is at least 0.
pub fn approach(velocity: f64, target: f64, rate: f64, duration: f64) -> DampedMotion<f64> {
    let remains = libm::exp(-rate * duration);
    // The displacement is the same as if the body moved at `velocity` for this time and at `target`
    // for the rest.
    let first_part = (-libm::expm1(-rate * duration) / rate).min(duration);
    DampedMotion {
        velocity: target + (velocity - target) * remains,
        displacement: velocity * first_part + target * (duration - first_part),
    }
}

/// Does the same as [`approach`], for vectors in the plane.
pub(crate) fn approach_in_plane(
    velocity: DVec2,
    target: DVec2,
    rate: f64,
    duration: f64,
) -> DampedMotion<DVec2> {
    let x = approach(velocity.x, target.x, rate, duration);
    let y = approach(velocity.y, target.y, rate, duration);
    DampedMotion {
        velocity: DVec2::new(x.velocity, y.velocity),
        displacement: DVec2::new(x.displacement, y.displacement),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const ROUNDING: f64 = 1e-12;

    fn speed() -> impl Strategy<Value = f64> {
        prop_oneof![Just(0.0), -1e3..1e3, -1e-6..1e-6]
    }

    fn power_of_ten(exponents: std::ops::Range<f64>) -> impl Strategy<Value = f64> {
        exponents.prop_map(|exponent| libm::pow(10.0, exponent))
    }

    proptest! {
        #[test]
        fn two_steps_equal_one_step_of_their_sum(
            velocity in speed(),
            target in speed(),
            rate in power_of_ten(-3.0..6.0),
            first in power_of_ten(-9.0..3.0),
            second in power_of_ten(-9.0..3.0),
        ) {
            let halfway = approach(velocity, target, rate, first);
            let twice = approach(halfway.velocity, target, rate, second);
            let once = approach(velocity, target, rate, first + second);
            let displacement = halfway.displacement + twice.displacement;
            let scale = velocity.abs() + target.abs();
            prop_assert!((twice.velocity - once.velocity).abs() <= ROUNDING * scale);
            prop_assert!(
                (displacement - once.displacement).abs() <= ROUNDING * scale * (first + second)
            );
        }

        #[test]
        fn velocity_never_passes_its_target(
            velocity in speed(),
            target in speed(),
            rate in power_of_ten(-3.0..6.0),
            duration in power_of_ten(-9.0..3.0),
        ) {
            let motion = approach(velocity, target, rate, duration);
            let (low, high) = (velocity.min(target), velocity.max(target));
            let slack = ROUNDING * (velocity.abs() + target.abs());
            if velocity <= target {
                prop_assert!(motion.velocity <= target && motion.velocity >= velocity - slack);
            } else {
                prop_assert!(motion.velocity >= target && motion.velocity <= velocity + slack);
            }
            let mean = motion.displacement / duration;
            prop_assert!(low - slack <= mean && mean <= high + slack);
        }
    }

    #[test]
    fn motion_agrees_with_the_integral_in_small_steps() {
        let (velocity, target, rate, duration) = (-2.0, 3.0, 12.0, 0.5);
        let steps = 10_000;
        let tick = duration / f64::from(steps);
        let mut displacement = 0.0;
        for step in 0..steps {
            let middle = (f64::from(step) + 0.5) * tick;
            displacement += approach(velocity, target, rate, middle).velocity * tick;
        }
        let exact = approach(velocity, target, rate, duration).displacement;
        assert!((displacement - exact).abs() < 1e-6);
    }
}
