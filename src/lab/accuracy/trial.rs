//! A trial: rays with known exact hits, to be cast by several methods.

use std::hint::black_box;
use std::time::{Duration, Instant};

use super::{Set, Truth, cast};
use crate::cast::{Caster, Hit, Ray};
use crate::lab::casters::{Method, Visitor};
use crate::world::Grid;

/// Rays and their exact hits.
#[derive(Clone, Debug)]
pub struct Trial {
    set: Set,
    truths: Vec<Option<Truth>>,
}

/// The errors of a method over some rays.
///
/// A ray is wrong if it hits another cell or side than it should, or if it escapes instead of
/// hitting or hits instead of escaping. Distance errors include all rays: if only one of the two
/// results is a hit, the relative error is 1. Texture coordinates are compared only where the ray
/// is right, and count as exact elsewhere.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// The number of rays.
    pub rays: usize,
    /// The number of wrong rays.
    pub wrong: usize,
    /// The largest relative error of the distance.
    pub worst_distance: f64,
    /// The root mean square of the relative errors of the distance.
    pub mean_distance: f64,
    /// The largest error of the texture coordinate, in texels of a wall with 64 of them.
    pub worst_texel: f64,
    /// The root mean square of these errors.
    pub mean_texel: f64,
}

impl Errors {
    /// The errors of several trials together.
    pub(super) fn of_all(trials: impl IntoIterator<Item = Self>) -> Self {
        let mut all = Self::default();
        let (mut distances, mut texels) = (0.0, 0.0);
        for errors in trials {
            all.rays += errors.rays;
            all.wrong += errors.wrong;
            all.worst_distance = all.worst_distance.max(errors.worst_distance);
            all.worst_texel = all.worst_texel.max(errors.worst_texel);
            distances += errors.mean_distance.powi(2) * errors.rays as f64;
            texels += errors.mean_texel.powi(2) * errors.rays as f64;
        }
        let count = all.rays.max(1) as f64;
        all.mean_distance = (distances / count).sqrt();
        all.mean_texel = (texels / count).sqrt();
        all
    }

    /// The fraction of wrong rays, from 0 to 1.
    pub fn share_wrong(&self) -> f64 {
        self.wrong as f64 / self.rays.max(1) as f64
    }
}

/// The time of a method for one ray, in nanoseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timing {
    /// The median over all rounds.
    pub median: f64,
    /// The lower quartile.
    pub lower_quartile: f64,
    /// The upper quartile.
    pub upper_quartile: f64,
}

impl Trial {
    /// The trial of the rays of `set`. The exact hits take about ten microseconds for each ray.
    pub fn new(set: Set) -> Self {
        let truths = set.rays.iter().map(|ray| cast(&set.grid, ray)).collect();
        Self { set, truths }
    }

    /// The name of the set.
    pub fn name(&self) -> &'static str {
        self.set.name
    }

    /// The errors of `method`.
    pub fn errors(&self, method: &Method) -> Errors {
        method.accept(ErrorsVisitor { trial: self })
    }

    fn errors_of<C: Caster>(&self, caster: &C) -> Errors {
        const TEXELS: f64 = 64.0;
        let mut errors = Errors { rays: self.set.rays.len(), ..Errors::default() };
        let (mut distances, mut texels) = (Mean::default(), Mean::default());
        for (ray, truth) in self.set.rays.iter().zip(&self.truths) {
            let hit = caster.cast(&self.set.grid, ray);
            distances.add(distance_error(truth.as_ref(), hit));
            texels.add(match (truth, hit) {
                (Some(truth), Some(hit)) if truth.is_met_by(&hit) => TEXELS * truth.u.error(hit.u),
                _ => 0.0,
            });
            errors.wrong += usize::from(!is_right(truth.as_ref(), hit));
        }
        errors.worst_distance = distances.worst;
        errors.mean_distance = distances.root_mean_square();
        errors.worst_texel = texels.worst;
        errors.mean_texel = texels.root_mean_square();
        errors
    }
}

/// Whether `hit` has the exact cell and side, or correctly does not exist.
fn is_right(truth: Option<&Truth>, hit: Option<Hit>) -> bool {
    match (truth, hit) {
        (None, None) => true,
        (Some(truth), Some(hit)) => truth.is_met_by(&hit),
        _ => false,
    }
}

/// The relative error of the distance of `hit`; 1 if only one of the two exists.
fn distance_error(truth: Option<&Truth>, hit: Option<Hit>) -> f64 {
    match (truth, hit) {
        (None, None) => 0.0,
        (Some(truth), Some(hit)) => {
            let true_distance = truth.t.to_f64();
            let error =
                if hit.t == true_distance { 0.0 } else { truth.t.error(hit.t.min(f64::MAX)) };
            // At a distance of zero, the quotient is infinite; the largest double stands for it.
            if error == 0.0 { 0.0 } else { (error / true_distance).min(f64::MAX) }
        }
        _ => 1.0,
    }
}

#[derive(Default)]
struct Mean {
    worst: f64,
    sum_of_squares: f64,
    count: usize,
}

impl Mean {
    fn add(&mut self, error: f64) {
        self.worst = self.worst.max(error);
        self.sum_of_squares += error * error;
        self.count += 1;
    }

    fn root_mean_square(&self) -> f64 {
        (self.sum_of_squares / self.count.max(1) as f64).sqrt()
    }
}

struct ErrorsVisitor<'a> {
    trial: &'a Trial,
}

impl Visitor for ErrorsVisitor<'_> {
    type Output = Errors;

    fn visit<C: Caster>(self, caster: &C) -> Errors {
        self.trial.errors_of(caster)
    }
}

/// The time of each of `methods` for one ray of `trials`.
///
/// In each of `turns` rounds, every method is timed once, so that a slow phase of the machine
/// affects all of them. `progress` is called with the completed fraction.
pub fn time_in_turns(
    methods: &[Method],
    trials: &[Trial],
    turns: usize,
    mut progress: impl FnMut(f64),
) -> Vec<Timing> {
    let rays: usize = trials.iter().map(|trial| trial.set.rays.len()).sum();
    let mut times: Vec<Vec<f64>> = vec![Vec::with_capacity(turns); methods.len()];
    for turn in 0..turns {
        for (index, (method, times)) in methods.iter().zip(&mut times).enumerate() {
            progress((turn * methods.len() + index) as f64 / (turns * methods.len()) as f64);
            let elapsed: Duration =
                trials.iter().map(|trial| method.accept(TimingVisitor { trial })).sum();
            times.push(elapsed.as_secs_f64() * 1e9 / rays.max(1) as f64);
        }
    }
    times.into_iter().map(Timing::of).collect()
}

impl Timing {
    fn of(mut times: Vec<f64>) -> Self {
        times.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let index = (share * times.len().saturating_sub(1) as f64).round() as usize;
            times.get(index).copied().unwrap_or_default()
        };
        Self { median: at(0.5), lower_quartile: at(0.25), upper_quartile: at(0.75) }
    }
}

struct TimingVisitor<'a> {
    trial: &'a Trial,
}

impl Visitor for TimingVisitor<'_> {
    type Output = Duration;

    fn visit<C: Caster>(self, caster: &C) -> Duration {
        let Set { grid, rays, .. } = &self.trial.set;
        let start = Instant::now();
        cast_all(caster, grid, rays);
        start.elapsed()
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

    fn trials() -> Vec<Trial> {
        ordinary(1, 200).into_iter().map(Trial::new).collect()
    }

    #[test]
    fn the_exact_method_is_right_and_a_coarse_march_is_not() {
        for trial in trials() {
            let exact = trial.errors(&Method::Exact);
            assert_eq!((exact.rays, exact.wrong), (200, 0), "{}", trial.name());
            assert!(exact.worst_distance < 1e-15 && exact.worst_texel < 1e-10);
            let march = trial.errors(&"march:0.3".parse().unwrap());
            assert!(march.wrong > 0 && march.worst_distance > exact.worst_distance);
        }
    }

    #[test]
    fn quartiles_are_in_order() {
        let timing = Timing::of(vec![5.0, 1.0, 4.0, 2.0, 3.0]);
        let Timing { median, lower_quartile, upper_quartile } = timing;
        assert_eq!((lower_quartile, median, upper_quartile), (2.0, 3.0, 4.0));
    }
}
