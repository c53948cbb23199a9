//! The report: the cost and the errors of every method, with several values of its parameter.

use std::num::NonZeroU32;

use super::{
    Errors, FilterRow, Gallery, MotionResult, Set, Timing, Trial, compare_filters, compare_motions,
    ordinary, random_ray, sets, time_in_turns,
};
use crate::lab::casters::Method;
use crate::render::FrameSize;
use crate::rng::SplitMix64;
use crate::world::World;

/// The options of a report.
#[derive(Clone, Debug)]
pub struct Plan<'world> {
    /// The world whose pictures are compared.
    pub world: &'world World,
    /// The source of the rays.
    pub rays: RaySource,
    /// The methods; all of them if empty.
    pub methods: Vec<Method>,
    /// The number of rays in each scene.
    pub count: usize,
    /// The seed of the random rays.
    pub seed: u64,
}

/// A source of rays.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RaySource {
    /// Three ordinary scenes. The report then includes the stiff sets.
    Scenes,
    /// The world whose pictures are compared.
    World,
    /// The set with this name.
    Set(String),
}

/// The costs and the errors of the methods.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// One row for each method, in the order of the request.
    pub rows: Vec<Row>,
    /// The texture filters, in pictures of each of the sizes in [`PICTURES`].
    pub filters: [FilterRow; 2],
    /// The stiff and extreme sets, if they were requested.
    pub sets: Vec<SetRow>,
    /// The integrators, if the sets were requested.
    pub motions: Vec<MotionResult>,
}

/// A method on ordinary rays.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The method, as on the command line.
    pub method: String,
    /// The time for a ray.
    pub timing: Timing,
    /// The errors.
    pub errors: Errors,
    /// The fraction of wrong pixels in pictures of each of the sizes in [`PICTURES`].
    pub wrong_pixels: [f64; 2],
    /// Whether no other method is both faster and less wrong: the Pareto front.
    pub is_on_front: bool,
}

/// The errors of each method in a set of rays.
#[derive(Clone, Debug, PartialEq)]
pub struct SetRow {
    /// The set's name.
    pub name: &'static str,
    /// The name and the errors of each method.
    pub errors: Vec<(String, Errors)>,
}

/// The sizes of the compared pictures, in pixels.
pub const PICTURES: [FrameSize; 2] = [picture(160, 90), picture(400, 120)];
const fn picture(width: u32, height: u32) -> FrameSize {
    match (NonZeroU32::new(width), NonZeroU32::new(height)) {
        (Some(width), Some(height)) => FrameSize { width, height },
        _ => panic!("a picture has pixels"),
    }
}

/// The number of pictures of each size.
const PICTURES_OF_A_SIZE: usize = 4;
/// The number of timings of each method.
const TURNS: usize = 15;

/// The methods of a report that names none.
const METHODS: [&str; 15] = [
    "exact",
    "dda",
    "dda32",
    "accumulate",
    "fixed:6",
    "fixed:10",
    "fixed:16",
    "fixed:24",
    "table:480",
    "table:1920",
    "table:7680",
    "table:65536",
    "march:0.1",
    "march:0.01",
    "march:0.001",
];

/// The report for `plan`; `None` if no set has the requested name. `progress` is called with the
/// completed fraction.
pub fn report(plan: &Plan, mut progress: impl FnMut(f64)) -> Option<Report> {
    // The fractions of progress at which timing and pictures end.
    const UNTIL_TIMED: f64 = 0.6;
    const UNTIL_PICTURED: f64 = 0.9;
    let methods = plan.methods_or_all();
    let trials = plan.trials()?;
    let timings = time_in_turns(&methods, &trials, TURNS, |share| progress(share * UNTIL_TIMED));
    let galleries =
        PICTURES.map(|size| Gallery::new(plan.world, size, PICTURES_OF_A_SIZE, plan.seed));
    let mut rows = Vec::with_capacity(methods.len());
    for (method, timing) in methods.iter().zip(timings) {
        let done = rows.len() as f64 / methods.len() as f64;
        progress(UNTIL_TIMED + done * (UNTIL_PICTURED - UNTIL_TIMED));
        rows.push(Row {
            method: method.to_string(),
            timing,
            errors: Errors::of_all(trials.iter().map(|trial| trial.errors(method))),
            wrong_pixels: galleries.each_ref().map(|gallery| gallery.share_wrong(method)),
            is_on_front: false,
        });
    }
    mark_front(&mut rows);
    let is_whole = plan.rays == RaySource::Scenes;
    let report = Report {
        rows,
        filters: compare_filters(plan.world, PICTURES, PICTURES_OF_A_SIZE, plan.seed),
        sets: if is_whole { set_rows(plan.seed) } else { Vec::new() },
        motions: if is_whole { compare_motions() } else { Vec::new() },
    };
    progress(1.0);
    Some(report)
}

/// The names of all sets of rays.
pub fn set_names() -> Vec<&'static str> {
    let sets = ordinary(0, 0).into_iter().chain(sets(0));
    sets.map(|set| set.name).collect()
}

impl Plan<'_> {
    fn methods_or_all(&self) -> Vec<Method> {
        if self.methods.is_empty() {
            METHODS.iter().filter_map(|name| name.parse().ok()).collect()
        } else {
            self.methods.clone()
        }
    }

    fn trials(&self) -> Option<Vec<Trial>> {
        let sets = match &self.rays {
            RaySource::Scenes => ordinary(self.seed, self.count),
            RaySource::World => vec![self.rays_in_world()],
            RaySource::Set(name) => {
                let mut all = ordinary(self.seed, self.count).into_iter().chain(sets(self.seed));
                vec![all.find(|set| set.name == name)?]
            }
        };
        Some(sets.into_iter().map(Trial::new).collect())
    }

    fn rays_in_world(&self) -> Set {
        let grid = self.world.grid().clone();
        let mut random = SplitMix64::new(self.seed);
        let rays = (0..self.count).map(|_| random_ray(&grid, &mut random)).collect();
        Set { name: "map", grid, rays }
    }
}

/// The errors in each stiff set of each method with its default parameter.
fn set_rows(seed: u64) -> Vec<SetRow> {
    let methods: Vec<Method> = Method::NAMES.iter().filter_map(|name| name.parse().ok()).collect();
    let row = |set| {
        let trial = Trial::new(set);
        let errors = methods.iter().map(|method| (method.to_string(), trial.errors(method)));
        SetRow { name: trial.name(), errors: errors.collect() }
    };
    sets(seed).into_iter().map(row).collect()
}

/// Marks the rows of the Pareto front in time and mean error of the distance.
fn mark_front(rows: &mut [Row]) {
    let points: Vec<(f64, f64)> =
        rows.iter().map(|row| (row.timing.median, row.errors.mean_distance)).collect();
    for (row, &(time, error)) in rows.iter_mut().zip(&points) {
        let beats = |&(other_time, other_error): &(f64, f64)| {
            other_time <= time && other_error <= error && (other_time, other_error) != (time, error)
        };
        row.is_on_front = !points.iter().any(beats);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::builtin;

    #[test]
    fn no_row_dominates_the_front() {
        let row = |median, mean_distance| Row {
            method: String::new(),
            timing: Timing { median, ..Timing::default() },
            errors: Errors { mean_distance, ..Errors::default() },
            wrong_pixels: [0.0; 2],
            is_on_front: false,
        };
        let mut rows = [row(1.0, 1.0), row(2.0, 0.5), row(3.0, 0.5), row(4.0, 0.0), row(9.0, 2.0)];
        mark_front(&mut rows);
        assert_eq!(rows.map(|row| row.is_on_front), [true, true, false, true, false]);
    }

    #[test]
    fn a_report_has_a_row_for_each_method() {
        let world = builtin::LEVELS[0].world().unwrap();
        let plan = Plan {
            world: &world,
            rays: RaySource::World,
            methods: vec!["exact".parse().unwrap(), "march:0.1".parse().unwrap()],
            count: 50,
            seed: 3,
        };
        let mut shares = Vec::new();
        let report = report(&plan, |share| shares.push(share)).unwrap();
        assert_eq!(report.rows.len(), 2);
        assert_eq!((report.rows[0].errors.wrong, report.rows[0].wrong_pixels), (0, [0.0; 2]));
        assert!(shares.is_sorted() && shares.last() == Some(&1.0));
        assert!(report.rows.iter().any(|row| row.is_on_front));
    }

    #[test]
    fn there_is_no_set_without_a_name() {
        let world = builtin::LEVELS[0].world().unwrap();
        let rays = RaySource::Set("nobody's".to_owned());
        let plan = Plan { world: &world, rays, methods: Vec::new(), count: 1, seed: 3 };
        assert!(report(&plan, |_| ()).is_none());
        assert!(set_names().len() > 3);
    }
}
