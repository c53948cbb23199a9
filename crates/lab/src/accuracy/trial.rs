//! A trial: rays with known exact hits, to be cast by several methods.

use std::hint::black_box;
use std::time::Instant;

use super::{Set, Truth, cast};
use crate::casters::{Method, Visitor};
use cellcaster::cast::{Caster, Hit, Ray};
use cellcaster::world::Grid;

/// Rays and their exact hits.
#[derive(Clone, Debug)]
pub struct Trial {
    set: Set,
    truths: Vec<Option<Truth>>,
}

/// The errors of a method over some rays.
///
/// A ray is wrong if it hits another cell or side than it should, or if it escapes instead of
/// hitting or hits instead of escaping. Errors of distances are differences from the rational
/// number, not from the double next to it: half a unit in the last place is the least that a method
/// can have in general. They include all rays: if only one of the two results is a hit, the
/// relative error is 1. Errors in units of the last place, and of texture coordinates, are of right
/// rays only.
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
    /// The median error of the distance, in units of its last place.
    pub median_ulps: f64,
    /// The largest error of the distance, in units of its last place.
    pub worst_ulps: f64,
    /// The largest error of the texture coordinate, in texels of a wall with 64 of them.
    pub worst_texel: f64,
    /// The root mean square of these errors.
    pub mean_texel: f64,
}

impl Errors {
    /// The fraction of wrong rays, from 0 to 1.
    pub fn share_wrong(&self) -> f64 {
        self.wrong as f64 / self.rays.max(1) as f64
    }
}

impl Trial {
    /// The trial of the rays of `set`. The exact hits take about ten microseconds for each ray, and
    /// a microsecond for each line of the map.
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
        const TEXELS: f64 = 64.0;
        let caster = method.caster();
        let mut errors = Errors { rays: self.set.rays.len(), ..Errors::default() };
        let (mut distances, mut texels) = (Mean::default(), Mean::default());
        let mut ulps = Vec::new();
        for (ray, truth) in self.set.rays.iter().zip(&self.truths) {
            let hit = caster.cast(&self.set.grid, ray);
            distances.add(distance_error(truth.as_ref(), hit));
            match (truth, hit) {
                (None, None) => {}
                (Some(truth), Some(hit)) if truth.is_met_by(&hit) => {
                    ulps.push(error_in_ulps(truth, hit));
                    texels.add(TEXELS * truth.u.error(hit.u));
                }
                _ => errors.wrong += 1,
            }
        }
        ulps.sort_unstable_by(f64::total_cmp);
        errors.worst_distance = distances.worst;
        errors.mean_distance = distances.root_mean_square();
        errors.median_ulps = ulps.get(ulps.len() / 2).copied().unwrap_or_default();
        errors.worst_ulps = ulps.last().copied().unwrap_or_default();
        errors.worst_texel = texels.worst;
        errors.mean_texel = texels.root_mean_square();
        errors
    }

    /// The time of `method` for one ray, in nanoseconds.
    pub(crate) fn nanoseconds(&self, method: &Method) -> f64 {
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
                // Beyond the largest double, infinity is right.
                return if hit.t.is_infinite() { 0.0 } else { 1.0 };
            }
            let error = truth.t.error(hit.t.min(f64::MAX));
            // At a distance of zero, the quotient is infinite; the largest double stands for it.
            if error == 0.0 { 0.0 } else { (error / distance).min(f64::MAX) }
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

struct TimingVisitor<'a> {
    set: &'a Set,
}

impl Visitor for TimingVisitor<'_> {
    type Output = f64;

    fn visit<C: Caster>(self, caster: &C) -> f64 {
        let Set { grid, rays, .. } = self.set;
        let start = Instant::now();
        cast_all(caster, grid, rays);
        start.elapsed().as_secs_f64() * 1e9 / rays.len().max(1) as f64
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
            assert_eq!(exact.wrong, 0, "{}", trial.name());
            assert!(exact.worst_distance < 1e-15 && exact.worst_texel < 1e-10);
            let march = trial.errors(&"march:0.3".parse().unwrap());
            assert!(march.wrong > 0 && march.worst_distance > exact.worst_distance);
        }
    }

    /// A double that is nearest to a number in general position is a quarter of a unit away in the
    /// mean, and a relative error below 2⁻⁵⁶ in the mean cannot be.
    #[test]
    fn rounding_is_an_error() {
        for trial in trials() {
            let exact = trial.errors(&Method::Exact);
            assert!(exact.median_ulps > 0.1 && exact.mean_distance > 2_f64.powi(-56), "{exact:?}");
            assert!(exact.worst_ulps < 2.0);
        }
    }
}
