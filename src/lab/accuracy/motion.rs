//! Damped motion: three integrators, and the error of each.
//!
//! A velocity v approaches a target w by dv/dt = rate · (w − v). The reference is the analytic
//! solution, with the exponential computed from its series in rational arithmetic. The closed form
//! of the game shares nothing with it, and is one of the three.

use std::hint::black_box;
use std::time::Instant;

use num_bigint::BigInt;

use crate::numeric::damped_motion::approach;

/// A method to integrate the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// The exact solution over each step, as in the game.
    ClosedForm,
    /// Explicit Euler: `x += v·dt; v += rate·(w − v)·dt`, with all values from before the step.
    Explicit,
    /// Semi-implicit Euler: first `v`, with the rate after the step, and then `x` with the new `v`.
    SemiImplicit,
}

impl Integrator {
    /// All integrators.
    pub const ALL: [Self; 3] = [Self::ClosedForm, Self::Explicit, Self::SemiImplicit];

    /// The name.
    pub fn name(self) -> &'static str {
        match self {
            Self::ClosedForm => "closed form",
            Self::Explicit => "explicit Euler",
            Self::SemiImplicit => "semi-implicit Euler",
        }
    }

    /// The velocity and the position after a step of `dt` seconds.
    fn step(self, case: &MotionCase, (velocity, place): (f64, f64)) -> (f64, f64) {
        let MotionCase { rate, step, target, .. } = *case;
        match self {
            Self::ClosedForm => {
                let glide = approach(velocity, target, rate, step);
                (glide.velocity, place + glide.displacement)
            }
            Self::Explicit => {
                (velocity + rate * (target - velocity) * step, place + velocity * step)
            }
            Self::SemiImplicit => {
                let velocity = (velocity + rate * target * step) / (1.0 + rate * step);
                (velocity, place + velocity * step)
            }
        }
    }
}

/// A motion from position 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionCase {
    /// The friction, per second.
    pub rate: f64,
    /// The length of a step in seconds.
    pub step: f64,
    /// The number of steps.
    pub steps: u32,
    /// The initial velocity, in cells per second.
    pub velocity: f64,
    /// The velocity that is approached.
    pub target: f64,
}

/// The errors of one integrator in one case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionResult {
    /// The integrator.
    pub integrator: Integrator,
    /// The motion.
    pub case: MotionCase,
    /// The error of the final velocity, as a fraction of the largest speed.
    pub velocity_error: f64,
    /// The error of the final position, as a fraction of the distance covered at the largest speed.
    pub place_error: f64,
    /// Nanoseconds for each step, the median of several runs.
    pub nanoseconds: f64,
}

/// Cases from soft to stiff: friction from 1e-3 to 1e6 per second, steps from 1e-9 to 1e3 seconds,
/// and speeds up to 1e6 cells per second.
pub(super) fn motion_cases() -> Vec<MotionCase> {
    let case =
        |rate, step, steps, velocity, target| MotionCase { rate, step, steps, velocity, target };
    vec![
        case(12.0, 1.0 / 60.0, 60, 0.0, 3.0),
        case(12.0, 1e-9, 1000, 0.0, 3.0),
        case(1e-3, 1.0 / 60.0, 600, 1e6, 0.0),
        case(1e-3, 1e3, 10, 1e6, 0.0),
        case(12.0, 0.25, 20, 5.5, -5.5),
        case(1e3, 1.0 / 60.0, 60, 0.0, 1e6),
        case(1e6, 1.0 / 60.0, 60, 0.0, 3.0),
        case(1e6, 1e3, 10, -1e6, 1e6),
    ]
}

/// The errors of every integrator in every case.
pub fn compare_motions() -> Vec<MotionResult> {
    let cases = motion_cases();
    let pairs = cases.iter().flat_map(|case| Integrator::ALL.map(|integrator| (integrator, *case)));
    pairs.map(|(integrator, case)| run(integrator, case)).collect()
}

fn run(integrator: Integrator, case: MotionCase) -> MotionResult {
    const RUNS: usize = 9;
    let mut state = (0.0, 0.0);
    let mut times: Vec<f64> = (0..RUNS)
        .map(|_| {
            let start = Instant::now();
            let moved = (0..case.steps)
                .fold((case.velocity, 0.0), |state, _| integrator.step(black_box(&case), state));
            state = black_box(moved);
            start.elapsed().as_secs_f64() * 1e9 / f64::from(case.steps)
        })
        .collect();
    times.sort_by(f64::total_cmp);
    let (velocity, place) = truth(&case);
    let fastest = case.velocity.abs().max(case.target.abs());
    let duration = case.step * f64::from(case.steps);
    let share = |error: f64| if error.is_finite() { error.abs() } else { f64::INFINITY };
    MotionResult {
        integrator,
        case,
        velocity_error: share((state.0 - velocity) / fastest),
        place_error: share((state.1 - place) / (fastest * duration)),
        nanoseconds: times[RUNS / 2],
    }
}

/// The final velocity and position, accurate to the last few digits of a double.
fn truth(case: &MotionCase) -> (f64, f64) {
    let duration = case.step * f64::from(case.steps);
    let exponent = case.rate * duration;
    let remains = exponential_of_minus(exponent);
    let velocity = case.target + (case.velocity - case.target) * remains;
    // (1 − e^−x) / x, from its own series where the difference would cancel.
    let coasting = if exponent < 1e-3 {
        let factorials = [1.0, 2.0, 6.0, 24.0, 120.0, 720.0];
        factorials.iter().rev().fold(0.0, |sum, factorial| 1.0 / factorial - sum * exponent)
    } else {
        (1.0 - remains) / exponent
    };
    let place = case.target * duration + (case.velocity - case.target) * duration * coasting;
    (velocity, place)
}

/// e to the power of `-x`, for `x ≥ 0`, from the series of e^(x/2^k) in fixed point.
fn exponential_of_minus(x: f64) -> f64 {
    const BITS: u32 = 256;
    const HALVINGS: u32 = 40;
    const TERMS: u32 = 24;
    if x > 700.0 {
        return 0.0;
    }
    let one = BigInt::from(1) << BITS;
    // x has 53 bits, so that x · 2^80 is an integer, or the remainder is below 2^-80.
    let scaled = BigInt::from((x * 2_f64.powi(80)) as u128) << (BITS - 80) >> HALVINGS;
    let mut sum = one.clone();
    let mut term = one.clone();
    for count in 1..=TERMS {
        term = ((term * &scaled) >> BITS) / count;
        sum += &term;
    }
    for _ in 0..HALVINGS {
        sum = (&sum * &sum) >> BITS;
    }
    let quotient = (BigInt::from(1) << (2 * BITS)) / sum;
    let digits = u64::try_from(quotient >> (BITS - 63)).unwrap_or(u64::MAX);
    digits as f64 / 2_f64.powi(63)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_is_the_exponential() {
        for x in [0.0, 1e-9, 0.5, 1.0, 12.0, 40.0] {
            let series = exponential_of_minus(x);
            assert!((series - libm::exp(-x)).abs() <= 1e-18 + 4e-16 * series, "{x}");
        }
    }

    #[test]
    fn the_closed_form_is_right_in_every_case_and_the_others_are_not() {
        for result in compare_motions() {
            let MotionResult { integrator, case, velocity_error, place_error, .. } = result;
            if integrator == Integrator::ClosedForm {
                assert!(velocity_error < 1e-12 && place_error < 1e-12, "{result:?}");
            }
            let is_stiff = case.rate * case.step > 2.0;
            if integrator == Integrator::Explicit && is_stiff {
                assert!(velocity_error > 1.0, "{result:?}");
            }
        }
    }
}
