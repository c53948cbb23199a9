//! Damped motion: five integrators, and the error of each.
//!
//! A velocity v approaches a target w by dv/dt = rate · (w − v), from rest to [`SPEED`]. Each
//! integrator moves for [`SECONDS`] by steps of several lengths, and is compared with the analytic
//! solution after 1, 2, 4, 8 and so on steps and after the last. The errors are the largest of
//! these, relative to the speed and to the way at it: at the end alone, a motion that has come to
//! rest would show no error. The solution is computed in [fixed point](super::fixed_point) of 512 bits, from the
//! very doubles that the integrators take, and subtracted before anything is rounded.
//!
//! A method of order p has an error that falls by the factor 10^p where steps are a tenth as long.
//! An explicit method is unstable where rate · step is above its limit.

mod integrator;
mod truth;

use std::hint::black_box;
use std::time::Instant;

pub use integrator::Integrator;

use super::table::{Column, Diagram, Row, Table, Value};
use super::timing::time_in_rounds;
use integrator::Motion;
use truth::Truth;

/// The time of a motion, in seconds.
const SECONDS: f64 = 10.0;
/// The target, in cells per second: that of a player who walks.
const SPEED: f64 = 3.0;
/// The lengths of steps, in seconds.
const STEPS: [f64; 6] = [1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0];
/// The rates, per second, from soft to stiff.
const RATES: [f64; 4] = [1.0, 1e3, 1e6, 1e9];

/// The errors of each integrator at the player's `friction` and at other rates, with the step of a
/// game with `steps_per_second` and with other steps. Each is timed in `rounds` rounds.
pub(crate) fn motions(friction: f64, steps_per_second: f64, rounds: usize) -> Table {
    let mut steps = STEPS.to_vec();
    steps.push(1.0 / steps_per_second);
    steps.sort_unstable_by(f64::total_cmp);
    steps.dedup();
    let mut rates = vec![friction];
    rates.extend(RATES.iter().filter(|&&rate| rate != friction));
    let cases: Vec<(Integrator, Motion)> = rates
        .iter()
        .flat_map(|&rate| Integrator::ALL.map(|integrator| (integrator, rate)))
        .flat_map(|(integrator, rate)| {
            steps.iter().map(move |&step| (integrator, Motion { rate, step, target: SPEED }))
        })
        .collect();
    let times = time_in_rounds(cases.len(), rounds, |index| nanoseconds(cases[index]));
    let rows = cases.iter().zip(times).map(|(&(integrator, motion), time)| {
        let [velocity, place] = errors(integrator, &motion).map(Value::Number);
        let keys = [rate_name(motion.rate), integrator.name().to_owned(), step_name(motion.step)];
        let steps = count(motion.step);
        let work = Value::Count(steps * integrator.evaluations());
        let stiffness = Value::Number(motion.rate * motion.step);
        Row { keys, values: vec![Value::Count(steps), work, stiffness, velocity, place, time] }
    });
    Table {
        name: "motion",
        title: "Ten seconds of a motion that friction damps, compared with the analytic solution",
        keys: ["friction, per s", "integrator", "step, s"],
        columns: vec![
            Column::new("steps", ""),
            Column::new("evaluations", ""),
            Column::new("rate × step", ""),
            Column::new("velocity, worst", "relative"),
            Column::new("place, worst", "relative"),
            Column::new("time", "ns a step"),
        ],
        rows: rows.collect(),
        diagrams: vec![Diagram { columns: [1, 4], range: [f64::EPSILON / 2.0, 10.0] }],
    }
}

/// The order and the limit of stability of each integrator.
pub(crate) fn orders() -> Table {
    let rows = Integrator::ALL.map(|integrator| {
        let [velocity, place] =
            slopes(integrator).map(|slope| slope.map_or(Value::None, Value::Number));
        let limit = Value::Number(integrator.limit_of_stability());
        let keys = [String::new(), integrator.name().to_owned(), String::new()];
        Row { keys, values: vec![velocity, place, limit] }
    });
    Table {
        name: "orders",
        title: "The slope of the error over the step at a rate of 1, and the largest stable rate × step",
        keys: ["", "integrator", ""],
        columns: vec![
            Column::new("slope, velocity", ""),
            Column::new("slope, place", ""),
            Column::new("stable up to", ""),
        ],
        rows: rows.into(),
        diagrams: Vec::new(),
    }
}

/// The number of steps of this length in the time of a motion.
fn count(step: f64) -> u64 {
    (SECONDS / step).round().max(1.0) as u64
}

fn rate_name(rate: f64) -> String {
    if rate >= 1e3 { format!("{rate:e}") } else { rate.to_string() }
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
    let last = count(motion.step);
    let mut state = (0.0, 0.0);
    let mut errors = [0.0_f64; 2];
    for step in 1..=last {
        state = integrator.step(motion, state);
        if step.is_power_of_two() || step == last {
            let [velocity, place] = Truth::new(motion, step).errors(state);
            let way = SPEED * motion.step * step as f64;
            for (worst, error) in errors.iter_mut().zip([velocity / SPEED, place / way]) {
                *worst = if error.is_finite() { worst.max(error) } else { f64::INFINITY };
            }
        }
    }
    errors
}

/// The time of a step: that of whole motions, one after the other, with many steps in all.
fn nanoseconds((integrator, motion): (Integrator, Motion)) -> f64 {
    const MANY: u64 = 20_000;
    let steps = count(motion.step).min(MANY);
    let motions = MANY.div_ceil(steps);
    let start = Instant::now();
    for _ in 0..motions {
        let motion = black_box(motion);
        let end = (0..steps).fold((0.0, 0.0), |state, _| integrator.step(&motion, state));
        black_box(end);
    }
    start.elapsed().as_secs_f64() * 1e9 / (motions * steps) as f64
}

/// The slopes of the errors of velocity and place over the step in logarithms, by least squares, at
/// the rate 1; `None` where there are fewer than two errors between those of rounding and those of
/// steps that are too long.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closed_form_is_exact_but_for_rounding() {
        for row in motions(12.0, 60.0, 0).rows {
            let [Value::Number(velocity), Value::Number(place)] = row.values[3..5] else {
                panic!()
            };
            if row.keys[1] == "closed form" {
                assert!(velocity < 1e-11 && place < 1e-11, "{row:?}");
            }
        }
    }

    #[test]
    fn slopes_are_the_orders() {
        for (integrator, order) in Integrator::ALL.into_iter().zip([1.0, 2.0, 4.0, 1.0]) {
            for slope in slopes(integrator) {
                assert!((slope.unwrap() - order).abs() < 0.2, "{integrator:?}: {slope:?}");
            }
        }
        assert_eq!(slopes(Integrator::ClosedForm), [None; 2]);
    }

    #[test]
    fn the_step_of_the_game_is_among_the_steps() {
        let table = motions(12.0, 60.0, 0);
        assert!(table.rows.iter().any(|row| row.keys[0] == "12" && row.keys[2] == "1/60"));
        assert_eq!(table.problems().len(), 5);
        assert_eq!(motions(1.0, 10.0, 0).problems().len(), 4);
    }
}
