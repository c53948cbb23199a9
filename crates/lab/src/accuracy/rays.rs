//! The tables of rays: ordinary scenes, stiff and extreme sets, and whole pictures.

use std::hint::black_box;

use super::{Set, Truth, cast};
use crate::casters::{Method, Visitor};
use crate::report::{Diagram, Row, Table, Value, headings, seconds, time_in_rounds};
use crate::speed::size;
use cellcaster::cast::{Caster, Hit, Ray};
use cellcaster::render::{DynCaster, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::rng::SplitMix64;
use cellcaster::world::{Camera, Cell, FieldOfView, Grid, Heading, World};

/// The largest relative error of a distance that is correctly rounded to a double: 2⁻⁵³.
const ROUNDING: f64 = f64::EPSILON / 2.0;

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
                Value::Number(errors.worst_distance),
                Value::Number(errors.worst_ulps),
                Value::maybe(instructions(name, method)),
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
            "worst relative error of distances",
            "worst error of right rays, ulp",
            "instructions, a ray",
            "time, ns a ray",
        ]),
        rows: rows.collect(),
        diagrams: vec![
            Diagram { columns: [4, 1], range: [ROUNDING, 10.0] },
            Diagram { columns: [4, 0], range: [1e-4, 1.0] },
            Diagram { columns: [3, 1], range: [ROUNDING, 10.0] },
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

// The number of instructions that each method takes for a ray, counted by Callgrind.
//
// A program cannot count its own instructions without help from the system, and a time differs from
// run to run. Therefore a file stores the counts of the ordinary scenes, and `.ci/accuracy count`
// writes it. The counts are for [`SEED`] and [`RAYS`] rays, or a tenth of that number on the plain.

/// The seed of the counted rays.
pub const SEED: u64 = 1;
/// The number of counted rays in a scene.
pub const RAYS: usize = 2000;

/// A line for each scene and method: their names, and the number of instructions for a ray.
const COUNTS: &str = include_str!("instructions/counts");

/// The number of instructions for a ray in the scene with this name, if it is stored.
fn instructions(scene: &str, method: &Method) -> Option<f64> {
    let counted = format!("{scene} {method} ");
    COUNTS.lines().find_map(|line| line.strip_prefix(&counted)?.parse().ok())
}

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
    /// The largest relative error of the distance.
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
            errors.worst_distance = errors.worst_distance.max(distance_error(truth.as_ref(), hit));
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

// The fraction of wrong pixels in whole pictures.

/// The number of pictures, and the size of each in pixels.
const PICTURES: usize = 4;
const PICTURE: FrameSize = size(160, 90);

/// The number of wrong pixels in pictures of `world`: one from its start, the others from random
/// positions.
pub(crate) fn pixels(world: &World, methods: &[Method], seed: u64) -> Table {
    let reference = DynCaster::new(Reference);
    let pictures: Vec<(Camera, Frame)> = cameras(world, seed)
        .take(PICTURES)
        .map(|camera| (camera, draw(world, &camera, &reference)))
        .collect();
    let pixels = PICTURES * PICTURE.width.get() as usize * PICTURE.height.get() as usize;
    let row = |method: &Method| {
        let caster = method.caster();
        let wrong =
            |(camera, truth): &(Camera, Frame)| different(&draw(world, camera, &caster), truth);
        let wrong = pictures.iter().map(wrong).sum();
        row_of("", method, vec![Value::share(wrong, pixels)])
    };
    Table {
        name: "pixels",
        title: format!(
            "Wrong pixels of each method in {PICTURES} pictures of {}x{}",
            PICTURE.width, PICTURE.height
        ),
        keys: ["", "method", "parameter"],
        columns: headings(["wrong pixels"]),
        rows: methods.iter().map(row).collect(),
        diagrams: Vec::new(),
    }
}

/// The number of pixels that differ between two pictures of the same size.
fn different(one: &Frame, other: &Frame) -> usize {
    one.rows().flatten().zip(other.rows().flatten()).filter(|(one, other)| one != other).count()
}

/// Casts in rational arithmetic. It is never wrong, and thousands of times slower than the casters.
#[derive(Debug)]
struct Reference;

impl Caster for Reference {
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        let truth = cast(grid, ray)?;
        Some(Hit { cell: truth.cell, side: truth.side, t: truth.t.to_f64(), u: truth.u.to_f64() })
    }
}

/// The cameras of the pictures: the start of `world`, and then random positions.
pub(crate) fn cameras(world: &World, seed: u64) -> impl Iterator<Item = Camera> {
    let mut random = SplitMix64::new(seed);
    let start = world.start_camera(FieldOfView::default());
    std::iter::once(start).chain(std::iter::repeat_with(move || random_camera(world, &mut random)))
}

/// A random camera on open floor.
fn random_camera(world: &World, random: &mut SplitMix64) -> Camera {
    let grid = world.grid();
    let on_floor = |random: &mut SplitMix64| {
        let column = random.whole(0, grid.width() as i32 - 1);
        let row = random.whole(0, grid.height() as i32 - 1);
        let cell = Cell { column: column as u32, row: row as u32 };
        (!grid.is_solid(column as i64, row as i64)).then_some(cell)
    };
    // There is open floor, because the start is on it.
    let cell = std::iter::repeat_with(|| on_floor(random)).flatten().next();
    let heading = Heading::default().turned(random.between(0.0, std::f64::consts::TAU));
    Camera::in_cell(cell.unwrap_or(world.start().cell), heading, FieldOfView::default())
}

fn draw(world: &World, camera: &Camera, caster: &DynCaster) -> Frame {
    let mut frame = Frame::new(PICTURE, PixelAspect::SQUARE);
    let caster = DynCaster::new(OnlyWalls(caster.clone()));
    Renderer::with_caster(caster).render(world, camera, &mut frame);
    frame
}

/// Treats doors and transparent cubes as walls, as most methods do. The pictures then differ only
/// where rays end differently.
#[derive(Debug)]
struct OnlyWalls(DynCaster);

impl Caster for OnlyWalls {
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        self.0.cast(grid, ray)
    }
}

#[cfg(test)]
mod tests {
    use super::super::ordinary;
    use super::*;
    use cellcaster::map;

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
            assert!(exact.worst_distance > ROUNDING / 4.0, "{exact:?}");
        }
    }

    #[test]
    fn only_coarse_pictures_have_wrong_pixels() {
        let museum = include_str!("../../../../tests/maps/museum.toml");
        let world = map::parse_str(museum).unwrap();
        let methods = ["exact", "march:0.2"].map(|name| name.parse().unwrap());
        let rows = pixels(&world, &methods, 7).rows;
        let [exact, coarse] = &rows[..] else { panic!("{rows:?}") };
        assert_eq!(exact.values, [Value::Share(0.0)]);
        assert!(coarse.values[0].number().unwrap() > 0.0);
    }
}
