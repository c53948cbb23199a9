//! Methods to integrate a damped motion.

use cellcaster::numeric::damped_motion::approach;

/// A method to integrate the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// Explicit Euler.
    Euler,
    /// Heun's method of order 2, with a step of Euler's as the predictor.
    Heun,
    /// The classic method of Runge and Kutta, of order 4.
    RungeKutta,
    /// Implicit Euler. The equation is linear, so that a division solves it.
    ImplicitEuler,
    /// The exact solution over each step, as in the game.
    ClosedForm,
}

/// A motion from rest at position 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Motion {
    /// The friction, per second.
    pub(crate) rate: f64,
    /// The length of a step in seconds.
    pub(crate) step: f64,
    /// The velocity that is approached.
    pub(crate) target: f64,
}

impl Integrator {
    /// All integrators.
    pub const ALL: [Self; 5] =
        [Self::Euler, Self::Heun, Self::RungeKutta, Self::ImplicitEuler, Self::ClosedForm];

    /// The name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Euler => "Euler",
            Self::Heun => "Heun",
            Self::RungeKutta => "RK4",
            Self::ImplicitEuler => "implicit Euler",
            Self::ClosedForm => "closed form",
        }
    }

    /// How often a step evaluates the right-hand side, or the solution.
    pub(crate) const fn evaluations(self) -> u64 {
        match self {
            Self::Euler | Self::ImplicitEuler | Self::ClosedForm => 1,
            Self::Heun => 2,
            Self::RungeKutta => 4,
        }
    }

    /// The velocity and the position after a step.
    pub(crate) fn step(self, motion: &Motion, (velocity, place): (f64, f64)) -> (f64, f64) {
        let Motion { rate, step, target } = *motion;
        let slope = |velocity: f64| rate * (target - velocity);
        match self {
            Self::Euler => (velocity + step * slope(velocity), place + step * velocity),
            Self::Heun => {
                let first = slope(velocity);
                let predicted = velocity + step * first;
                let second = slope(predicted);
                (
                    velocity + step / 2.0 * (first + second),
                    place + step / 2.0 * (velocity + predicted),
                )
            }
            Self::RungeKutta => {
                let first = slope(velocity);
                let v2 = velocity + step / 2.0 * first;
                let second = slope(v2);
                let v3 = velocity + step / 2.0 * second;
                let third = slope(v3);
                let v4 = velocity + step * third;
                let fourth = slope(v4);
                (
                    velocity + step / 6.0 * (first + 2.0 * second + 2.0 * third + fourth),
                    place + step / 6.0 * (velocity + 2.0 * v2 + 2.0 * v3 + v4),
                )
            }
            Self::ImplicitEuler => {
                let velocity = (velocity + rate * target * step) / (1.0 + rate * step);
                (velocity, place + velocity * step)
            }
            Self::ClosedForm => {
                let moved = approach(velocity, target, rate, step);
                (moved.velocity, place + moved.displacement)
            }
        }
    }

    /// The largest rate · step at which a step takes the velocity no farther from the target than
    /// it was, found by bisection; infinite if there is none up to 10¹².
    pub(crate) fn limit_of_stability(self) -> f64 {
        const BISECTIONS: u32 = 60;
        let is_stable = |step: f64| {
            let (velocity, _) = self.step(&Motion { rate: 1.0, step, target: 0.0 }, (1.0, 0.0));
            velocity.abs() <= 1.0
        };
        let Some(unstable) = (0..40).map(|power| 2_f64.powi(power)).find(|&step| !is_stable(step))
        else {
            return f64::INFINITY;
        };
        let (stable, _) = (0..BISECTIONS).fold((0.0, unstable), |(stable, unstable), _| {
            let middle = f64::midpoint(stable, unstable);
            if is_stable(middle) { (middle, unstable) } else { (stable, middle) }
        });
        stable
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The limits in Hairer and Wanner, "Solving Ordinary Differential Equations II" (1996), IV.2.
    #[test]
    fn limits_of_stability_are_those_of_the_textbook() {
        let [euler, heun, runge_kutta, implicit, closed] =
            Integrator::ALL.map(Integrator::limit_of_stability);
        assert!((euler - 2.0).abs() < 1e-12 && (heun - 2.0).abs() < 1e-7);
        assert!((runge_kutta - 2.785_293_563_405).abs() < 1e-9, "{runge_kutta}");
        assert_eq!((implicit, closed), (f64::INFINITY, f64::INFINITY));
    }
}
