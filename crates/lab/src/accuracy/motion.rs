//! Damped motion: five integrators, and the error of each.
//!
//! A velocity v approaches a target w by dv/dt = rate · (w − v), from rest to [`SPEED`]. Each
//! integrator moves for [`SECONDS`] in steps of several lengths. It is compared with the analytic
//! solution after each step. The reported errors are the largest of these, relative to the speed and
//! to the distance at that speed. At the end alone, a motion that has come to rest would show no
//! error. The solution is computed in [fixed
//! point](super::fixed_point) of 512 bits, from the same doubles that the integrators take, and
//! subtracted before anything is rounded.
//!
//! The error of a method of order p falls by a factor of 10^p if steps are a tenth as long. An
//! explicit method is unstable if rate · step is above its limit.

use std::hint::black_box;

use super::fixed_point::FixedPoint;
use crate::report::{Diagram, Row, Table, Value, headings, seconds, time_in_rounds};
use cellcaster::numeric::damped_motion::approach;

/// The time of a motion, in seconds.
const SECONDS: f64 = 10.0;
/// The target: the walking speed of a player, in cells per second.
const SPEED: f64 = 3.0;
/// The lengths of steps, in seconds.
const STEPS: [f64; 4] = [1e-3, 1e-2, 0.1, 1.0];

/// The errors of each integrator at the player's `friction`, with the step of a game that takes
/// `steps_per_second` and with other steps. Each is timed in `rounds` rounds.
pub(crate) fn motions(friction: f64, steps_per_second: f64, rounds: usize) -> Table {
    let mut steps = STEPS.to_vec();
    steps.push(1.0 / steps_per_second);
    steps.sort_unstable_by(f64::total_cmp);
    steps.dedup();
    let motion = |&step: &f64| Motion { rate: friction, step, target: SPEED };
    let cases: Vec<(Integrator, Motion)> = Integrator::ALL
        .into_iter()
        .flat_map(|integrator| steps.iter().map(move |step| (integrator, motion(step))))
        .collect();
    let times = time_in_rounds(cases.len(), rounds, |index| microseconds(cases[index]));
    let rows = cases.iter().zip(times).map(|(&(integrator, motion), time)| {
        let [velocity, place] = errors(integrator, &motion).map(Value::Number);
        let stiffness = Value::Number(motion.rate * motion.step);
        let values = vec![stiffness, velocity, place, time];
        Row::new(["", integrator.name(), &step_name(motion.step)], values)
    });
    Table {
        name: "motion",
        title: format!(
            "Ten seconds of motion with a friction of {friction} per second, compared with the analytic solution"
        ),
        keys: ["", "integrator", "step, s"],
        columns: headings([
            "rate × step",
            "worst relative error of velocities",
            "worst relative error of positions",
            "time, µs a motion",
        ]),
        rows: rows.collect(),
        diagrams: vec![Diagram { columns: [2, 3], range: [1e-18, 10.0] }],
    }
}

/// The order and the limit of stability of each integrator.
pub(crate) fn orders() -> Table {
    let rows = Integrator::ALL.map(|integrator| {
        let [velocity, place] = slopes(integrator).map(Value::maybe);
        let limit = Value::Number(integrator.limit_of_stability());
        Row::new(["", integrator.name(), ""], vec![velocity, place, limit])
    });
    Table {
        name: "orders",
        title: "The slope of the error over the step at a rate of 1, and the largest stable rate × step"
            .to_owned(),
        keys: ["", "integrator", ""],
        columns: headings(["slope, velocity", "slope, place", "stable up to"]),
        rows: rows.into(),
        diagrams: Vec::new(),
    }
}

/// The number of steps of this length in the duration of a motion.
fn count(step: f64) -> u64 {
    (SECONDS / step).round().max(1.0) as u64
}

fn step_name(step: f64) -> String {
    let per_second = (1.0 / step).round();
    if step < 1.0 && 1.0 / per_second == step && STEPS.iter().all(|&other| other != step) {
        format!("1/{per_second}")
    } else {
        step.to_string()
    }
}

/// The largest errors of velocity and place along the way, relative.
fn errors(integrator: Integrator, motion: &Motion) -> [f64; 2] {
    let mut exact = ExactMotion::new(motion);
    let mut state = (0.0, 0.0);
    let mut errors = [0.0_f64; 2];
    for step in 1..=count(motion.step) {
        state = integrator.step(motion, state);
        exact.step();
        let [velocity, place] = exact.errors(state);
        let way = SPEED * motion.step * step as f64;
        for (worst, error) in errors.iter_mut().zip([velocity / SPEED, place / way]) {
            *worst = if error.is_finite() { worst.max(error) } else { f64::INFINITY };
        }
    }
    errors
}

/// The time of a motion, in microseconds, measured over many steps.
fn microseconds((integrator, motion): (Integrator, Motion)) -> f64 {
    const MANY: u64 = 20_000;
    let steps = count(motion.step);
    let motions = MANY.div_ceil(steps);
    let time = seconds(|| {
        for _ in 0..motions {
            let motion = black_box(motion);
            let end = (0..steps).fold((0.0, 0.0), |state, _| integrator.step(&motion, state));
            black_box(end);
        }
    });
    time * 1e6 / motions as f64
}

/// The slopes of the errors of velocity and place over the step in logarithms, by least squares, at
/// the rate 1. Errors that are mostly rounding, or that come from steps that are too long, are left
/// out. `None` if fewer than two remain.
fn slopes(integrator: Integrator) -> [Option<f64>; 2] {
    const LINEAR: std::ops::Range<f64> = 1e-12..0.1;
    const SLOPE_STEPS: [f64; 6] = [0.2, 0.1, 0.05, 0.02, 0.01, 0.005];
    let points = SLOPE_STEPS
        .map(|step| (step, errors(integrator, &Motion { rate: 1.0, step, target: SPEED })));
    [0, 1].map(|which| {
        let points: Vec<(f64, f64)> = points
            .iter()
            .filter(|(_, errors)| LINEAR.contains(&errors[which]))
            .map(|(step, errors)| (libm::log(*step), libm::log(errors[which])))
            .collect();
        (points.len() > 1).then(|| slope(&points))
    })
}

/// The slope of the line of least squares through at least two points.
fn slope(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let mean = |value: fn(&(f64, f64)) -> f64| points.iter().map(value).sum::<f64>() / count;
    let (x, y) = (mean(|point| point.0), mean(|point| point.1));
    let covariance: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
    let variance: f64 = points.iter().map(|point| (point.0 - x).powi(2)).sum();
    covariance / variance
}

// Methods to integrate a damped motion.

/// A method to integrate the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Integrator {
    /// Explicit Euler.
    Euler,
    /// Heun's method of order 2, with a step of Euler's as the predictor.
    Heun,
    /// The classic method of Runge and Kutta, of order 4.
    RungeKutta,
    /// Implicit Euler. The equation is linear, so a division solves it.
    ImplicitEuler,
    /// The exact solution over each step, as in the game.
    ClosedForm,
}

/// A motion from rest at position 0.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Motion {
    /// The friction, per second.
    rate: f64,
    /// The length of a step in seconds.
    step: f64,
    /// The velocity that the motion approaches.
    target: f64,
}

impl Integrator {
    /// All integrators.
    const ALL: [Self; 5] =
        [Self::Euler, Self::Heun, Self::RungeKutta, Self::ImplicitEuler, Self::ClosedForm];

    const fn name(self) -> &'static str {
        match self {
            Self::Euler => "Euler",
            Self::Heun => "Heun",
            Self::RungeKutta => "RK4",
            Self::ImplicitEuler => "implicit Euler",
            Self::ClosedForm => "closed form",
        }
    }

    /// The velocity and the position after a step.
    fn step(self, motion: &Motion, (velocity, place): (f64, f64)) -> (f64, f64) {
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

    /// The largest rate · step at which a step does not move the velocity away from the target,
    /// found by bisection; infinite if there is no limit up to 10¹².
    fn limit_of_stability(self) -> f64 {
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

// The analytic solution of a damped motion in fixed point.

/// The exact state of a motion: `v = w·(1 − e^(−rate·t))`, and
/// `x = w·(t − (1 − e^(−rate·t)) / rate)`.
struct ExactMotion {
    rate: FixedPoint,
    target: FixedPoint,
    step: FixedPoint,
    /// `e^(−rate·step)`.
    decay: FixedPoint,
    time: FixedPoint,
    /// `e^(−rate·time)`.
    left: FixedPoint,
}

impl ExactMotion {
    fn new(motion: &Motion) -> Self {
        let [rate, step, target] = [motion.rate, motion.step, motion.target].map(FixedPoint::new);
        let decay = (&rate * &step).exponential_of_minus();
        let [time, left] = [0.0, 1.0].map(FixedPoint::new);
        Self { rate, target, step, decay, time, left }
    }

    fn step(&mut self) {
        self.time = &self.time + &self.step;
        self.left = &self.left * &self.decay;
    }

    /// The absolute errors of a velocity and a place; infinite for a value that is not finite.
    fn errors(&self, (velocity, place): (f64, f64)) -> [f64; 2] {
        let approached = &FixedPoint::new(1.0) - &self.left;
        let lag = &approached / &self.rate;
        let truths = [&self.target * &approached, &self.target * &(&self.time - &lag)];
        [(velocity, &truths[0]), (place, &truths[1])].map(|(value, truth)| {
            if value.is_finite() {
                (&FixedPoint::new(value) - truth).to_f64().abs()
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
    fn the_closed_form_is_exact_except_for_rounding() {
        // From soft to stiff.
        for rate in [1.0, 12.0, 1e3, 1e6, 1e9] {
            for step in [1e-4, 1e-3, 1e-2, 1.0 / 60.0, 0.1, 1.0, 10.0] {
                let motion = Motion { rate, step, target: SPEED };
                let errors = errors(Integrator::ClosedForm, &motion);
                assert!(errors.iter().all(|&error| error < 2e-12), "{motion:?}: {errors:?}");
            }
        }
    }

    #[test]
    fn error_slopes_match_the_orders_of_the_integrators() {
        for (integrator, order) in Integrator::ALL.into_iter().zip([1.0, 2.0, 4.0, 1.0]) {
            for slope in slopes(integrator) {
                assert!((slope.unwrap() - order).abs() < 0.2, "{integrator:?}: {slope:?}");
            }
        }
        assert_eq!(slopes(Integrator::ClosedForm), [None; 2]);
    }

    #[test]
    fn the_steps_include_the_game_step() {
        let steps = |steps_per_second| -> Vec<String> {
            let rows = motions(12.0, steps_per_second, 0).rows.into_iter();
            let of_euler = rows.filter(|row| row.keys[1] == "Euler");
            of_euler.map(|row| row.keys[2].clone()).collect()
        };
        assert_eq!(steps(60.0), ["0.001", "0.01", "1/60", "0.1", "1"]);
        assert_eq!(steps(10.0), ["0.001", "0.01", "0.1", "1"]);
    }

    /// The limits in Hairer and Wanner, "Solving Ordinary Differential Equations II" (1996), IV.2.
    #[test]
    fn stability_limits_match_the_textbook() {
        let [euler, heun, runge_kutta, implicit, closed] =
            Integrator::ALL.map(Integrator::limit_of_stability);
        assert!((euler - 2.0).abs() < 1e-12 && (heun - 2.0).abs() < 1e-7);
        assert!((runge_kutta - 2.785_293_563_405).abs() < 1e-9, "{runge_kutta}");
        assert_eq!((implicit, closed), (f64::INFINITY, f64::INFINITY));
    }

    #[test]
    fn a_motion_ends_at_its_target() {
        let motion = Motion { rate: 1e9, step: 0.5, target: 3.0 };
        let mut exact = ExactMotion::new(&motion);
        (0..4).for_each(|_| exact.step());
        let [velocity, place] = exact.errors((3.0, 6.0));
        assert!(velocity == 0.0 && (place - 3e-9).abs() < 1e-20, "{velocity} {place}");
        assert_eq!(exact.errors((f64::NAN, 0.0))[0], f64::INFINITY);
    }
}
