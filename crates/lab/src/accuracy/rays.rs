//! The tables of rays: ordinary scenes, and stiff and extreme sets.

use std::hint::black_box;

use super::{Set, Truth, cast};
use crate::casters::{Method, Visitor};
use crate::report::{Diagram, Row, Table, Value, headings, seconds, time_in_rounds};
use cellcaster::cast::{Caster, Hit, Ray};
use cellcaster::world::Grid;

/// The table of `trials`, each timed in `rounds` rounds.
pub(crate) fn scenes(trials: &[Trial], methods: &[Method], rounds: usize) -> Table {
    let rows = trials.iter().flat_map(|trial| {
        let name = trial.set.name;
        let times =
            time_in_rounds(methods.len(), rounds, |index| trial.nanoseconds(&methods[index]));
        let row = move |(method, time): (&Method, Value)| {
            let errors = trial.errors(method);
            let values = vec![
                errors.share_of_wrong(),
                Value::Number(errors.distances / errors.rays.max(1) as f64),
                Value::Number(errors.worst_distance),
                Value::Number(errors.worst_ulps),
                time,
            ];
            row_of(name, method, values)
        };
        methods.iter().zip(times).map(row)
    });
    Table {
        name: "rays",
        title: "Rays in ordinary scenes, compared with rational arithmetic".to_owned(),
        keys: ["scene", "method", "parameter"],
        columns: headings([
            "wrong rays",
            "mean relative error of distances",
            "worst relative error",
            "worst error of right rays, ulp",
            "time, ns a ray",
        ]),
        rows: rows.collect(),
        diagrams: vec![
            Diagram { columns: [1, 4], range: [1e-18, 10.0] },
            Diagram { columns: [0, 4], range: [1e-6, 1.0] },
        ],
    }
}

/// A row with a scene, a method and its parameter as keys.
fn row_of(scene: &str, method: &Method, values: Vec<Value>) -> Row {
    let method = method.to_string();
    let (name, parameter) = method.split_once(':').unwrap_or((&method, ""));
    Row::new([scene, name, parameter], values)
}

/// The stiff and extreme sets of `trials`, with the default parameter of each method.
pub(crate) fn stiff(trials: impl Iterator<Item = Trial>) -> Table {
    let methods = Method::all();
    let rows = trials.map(|trial| {
        let count = Value::Count(trial.set.rays.len() as u64);
        let wrong = methods.iter().map(|method| trial.errors(method).share_of_wrong());
        Row::new([trial.set.name, "", ""], std::iter::once(count).chain(wrong).collect())
    });
    let columns = methods.iter().map(Method::to_string);
    Table {
        name: "stiff",
        title: "Wrong rays of each method in stiff and extreme sets".to_owned(),
        keys: ["set", "", ""],
        columns: std::iter::once("rays".to_owned()).chain(columns).collect(),
        rows: rows.collect(),
        diagrams: Vec::new(),
    }
}

/// The seed of the rays.
pub const SEED: u64 = 1;
/// The number of rays in a scene.
pub const RAYS: usize = 2000;

// The errors of a method over rays with known exact hits.

/// Rays and their exact hits.
#[derive(Clone, Debug)]
pub(crate) struct Trial {
    set: Set,
    truths: Vec<Option<Truth>>,
}

/// The errors of a method over some rays.
///
/// A ray is wrong if it hits another cell or side than the exact hit, or if only one of the two
/// escapes. Errors of distances are differences from the rational number, not from the nearest
/// double: half a unit in the last place is generally the least error that a method can have. They
/// include all rays: if only one of the two results is a hit, the relative error is 1. Errors in
/// units of the last place include only correct rays.
#[derive(Debug, Default)]
struct Errors {
    rays: usize,
    wrong: usize,
    /// The sum of the relative errors of the distances.
    distances: f64,
    /// The largest relative error of a distance.
    worst_distance: f64,
    /// The largest error of the distance in units of its last place.
    worst_ulps: f64,
}

impl Errors {
    fn share_of_wrong(&self) -> Value {
        Value::share(self.wrong, self.rays)
    }
}

impl Trial {
    /// Creates the trial of the rays of `set`. The exact hits take about ten microseconds for each
    /// ray, and a microsecond for each line of the map.
    pub(crate) fn new(set: Set) -> Self {
        let truths = set.rays.iter().map(|ray| cast(&set.grid, ray)).collect();
        Self { set, truths }
    }

    fn errors(&self, method: &Method) -> Errors {
        let caster = method.caster();
        let mut errors = Errors { rays: self.set.rays.len(), ..Errors::default() };
        for (ray, truth) in self.set.rays.iter().zip(&self.truths) {
            let hit = caster.cast(&self.set.grid, ray);
            let error = distance_error(truth.as_ref(), hit);
            errors.distances += error;
            errors.worst_distance = errors.worst_distance.max(error);
            match (truth, hit) {
                (None, None) => {}
                (Some(truth), Some(hit)) if truth.is_met_by(&hit) => {
                    errors.worst_ulps = errors.worst_ulps.max(error_in_ulps(truth, hit));
                }
                _ => errors.wrong += 1,
            }
        }
        errors
    }

    /// The time of `method` for one ray, in nanoseconds.
    fn nanoseconds(&self, method: &Method) -> f64 {
        method.accept(TimingVisitor { set: &self.set })
    }
}

/// The relative error of the distance of `hit`; 1 if only one of the two exists.
fn distance_error(truth: Option<&Truth>, hit: Option<Hit>) -> f64 {
    match (truth, hit) {
        (None, None) => 0.0,
        (Some(truth), Some(hit)) => {
            let distance = truth.t.to_f64();
            if distance.is_infinite() {
                // Beyond the largest double, infinity is correct.
                return if hit.t.is_infinite() { 0.0 } else { 1.0 };
            }
            // At a distance of zero the quotient would be infinite. The largest double stands for
            // it.
            match truth.t.is_zero() {
                true if hit.t == 0.0 => 0.0,
                true => f64::MAX,
                false => truth.t.relative_error(hit.t.min(f64::MAX)).min(f64::MAX),
            }
        }
        _ => 1.0,
    }
}

/// The error of the distance of `hit`, in units of the last place of the true distance.
fn error_in_ulps(truth: &Truth, hit: Hit) -> f64 {
    let distance = truth.t.to_f64();
    if distance.is_infinite() && hit.t.is_infinite() {
        return 0.0;
    }
    let distance = distance.min(f64::MAX);
    truth.t.error(hit.t.min(f64::MAX)) / (distance - distance.next_down())
}

struct TimingVisitor<'a> {
    set: &'a Set,
}

impl Visitor for TimingVisitor<'_> {
    type Output = f64;

    fn visit<C: Caster>(self, caster: &C) -> f64 {
        let Set { grid, rays, .. } = self.set;
        seconds(|| cast_all(caster, grid, rays)) * 1e9 / rays.len().max(1) as f64
    }
}

fn cast_all<C: Caster>(caster: &C, grid: &Grid, rays: &[Ray]) {
    for ray in rays {
        black_box(caster.cast(grid, black_box(ray)));
    }
}

#[cfg(test)]
mod tests {
    use super::super::ordinary;
    use super::*;

    fn trials() -> impl Iterator<Item = Trial> {
        ordinary(1, 200).into_iter().map(Trial::new)
    }

    #[test]
    fn the_exact_method_is_right_and_a_coarse_march_is_not() {
        for trial in trials() {
            let exact = trial.errors(&Method::Exact);
            assert_eq!(exact.wrong, 0, "{}", trial.set.name);
            assert!(exact.worst_distance < 1e-15);
            let march = trial.errors(&"march:0.3".parse().unwrap());
            assert!(march.wrong > 0 && march.worst_distance > exact.worst_distance);
        }
    }

    /// The double nearest to a number in general position is up to half a unit away, so the worst
    /// of many errors is nearly that.
    #[test]
    fn rounding_counts_as_an_error() {
        for trial in trials() {
            let exact = trial.errors(&Method::Exact);
            assert!((0.4..2.0).contains(&exact.worst_ulps), "{exact:?}");
            assert!(exact.worst_distance > f64::EPSILON / 8.0, "{exact:?}");
        }
    }
}
