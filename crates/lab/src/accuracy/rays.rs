//! The tables of rays: ordinary scenes, stiff and extreme sets, and whole pictures.

use std::hint::black_box;
use std::num::NonZeroU32;

use super::{Set, Truth, cast};
use crate::casters::{Method, Visitor};
use crate::report::{Diagram, Row, Table, Value, headings, seconds, time_in_rounds};
use cellcaster::cast::{Caster, Hit, Ray};
use cellcaster::render::{DynCaster, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::rng::SplitMix64;
use cellcaster::world::{Camera, Cell, FieldOfView, Grid, Heading, World};

/// The methods of a report whose options name none.
const METHODS: &str = "exact dda dda32 accumulate fixed:6 fixed:10 fixed:16 fixed:24 table:480 \
                       table:1920 table:7680 table:65536 march:0.1 march:0.01 march:0.001";

/// All methods, each with several values of its parameter.
pub fn all_methods() -> Vec<Method> {
    METHODS.split(' ').filter_map(|name| name.parse().ok()).collect()
}

/// Returns whether `method` takes little enough time in the scene with this name to be measured
/// there. A small step across a large plain takes too long.
pub fn is_measured(scene: &str, method: &Method) -> bool {
    const LEAST_STEP: f64 = 0.01;
    scene != "plain-4096" || !matches!(method, Method::March(march) if march.step < LEAST_STEP)
}

/// The largest relative error of a distance that is correctly rounded to a double: 2⁻⁵³.
const ROUNDING: f64 = f64::EPSILON / 2.0;

/// The table of `trials`, each timed in `rounds` rounds.
pub(crate) fn scenes(trials: &[Trial], methods: &[Method], rounds: usize) -> Table {
    let rows = trials.iter().flat_map(|trial| {
        let name = trial.set.name;
        let methods: Vec<&Method> = methods.iter().filter(|it| is_measured(name, it)).collect();
        let times =
            time_in_rounds(methods.len(), rounds, |index| trial.nanoseconds(methods[index]));
        let row = |(method, time): (&Method, Value)| {
            let mut values = trial.errors(method).values();
            values.extend([Value::maybe(instructions(name, method)), time]);
            row_of(name, method, values)
        };
        methods.into_iter().zip(times).map(row).collect::<Vec<_>>()
    });
    Table {
        name: "rays",
        title: "Rays in ordinary scenes, compared with rational arithmetic".to_owned(),
        keys: ["scene", "method", "parameter"],
        columns: headings([
            "rays",
            "wrong rays",
            "distance, rms, relative",
            "distance, worst, relative",
            "right rays: median, ulp",
            "right rays: worst, ulp",
            "right rays: rms, texels of 64",
            "right rays: worst, texels of 64",
            "instructions, a ray",
            "time, ns a ray",
        ]),
        rows: rows.collect(),
        diagrams: vec![
            Diagram { columns: [9, 2], range: [ROUNDING / 4.0, 10.0] },
            Diagram { columns: [9, 1], range: [1e-4, 1.0] },
            Diagram { columns: [8, 2], range: [ROUNDING / 4.0, 10.0] },
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
    let methods: Vec<Method> = Method::NAMES.iter().filter_map(|name| name.parse().ok()).collect();
    let rows = trials.map(|trial| {
        let errors = methods.iter().map(|method| trial.errors(method));
        let figures = errors.flat_map(|errors| {
            [Value::share(errors.wrong, errors.rays), Value::Number(errors.worst_distance)]
        });
        let count = Value::Count(trial.set.rays.len() as u64);
        Row::new([trial.set.name, "", ""], std::iter::once(count).chain(figures).collect())
    });
    let columns =
        methods.iter().flat_map(|method| [format!("{method}: wrong"), format!("{method}: worst")]);
    Table {
        name: "stiff",
        title: "Rays in stiff and extreme sets: wrong rays, and the worst relative error of the distance"
            .to_owned(),
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
/// units of the last place, and of texture coordinates, include only correct rays.
#[derive(Debug, Default)]
struct Errors {
    rays: usize,
    wrong: usize,
    /// Relative errors of the distance: the root mean square and the largest.
    mean_distance: f64,
    worst_distance: f64,
    /// Errors of the distance in units of its last place.
    median_ulps: f64,
    worst_ulps: f64,
    /// Errors of the texture coordinate, in texels of a wall with 64 texels.
    mean_texel: f64,
    worst_texel: f64,
}

impl Errors {
    fn values(&self) -> Vec<Value> {
        let errors = [
            self.mean_distance,
            self.worst_distance,
            self.median_ulps,
            self.worst_ulps,
            self.mean_texel,
            self.worst_texel,
        ];
        let counts = [Value::Count(self.rays as u64), Value::share(self.wrong, self.rays)];
        counts.into_iter().chain(errors.map(Value::Number)).collect()
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
        const TEXELS: f64 = 64.0;
        let caster = method.caster();
        let (mut distances, mut texels, mut ulps) = (Vec::new(), Vec::new(), Vec::new());
        let mut wrong = 0;
        for (ray, truth) in self.set.rays.iter().zip(&self.truths) {
            let hit = caster.cast(&self.set.grid, ray);
            distances.push(distance_error(truth.as_ref(), hit));
            match (truth, hit) {
                (None, None) => {}
                (Some(truth), Some(hit)) if truth.is_met_by(&hit) => {
                    ulps.push(error_in_ulps(truth, hit));
                    texels.push(TEXELS * truth.u.error(hit.u));
                }
                _ => wrong += 1,
            }
        }
        ulps.sort_unstable_by(f64::total_cmp);
        Errors {
            rays: self.set.rays.len(),
            wrong,
            mean_distance: root_mean_square(&distances),
            worst_distance: largest(&distances),
            median_ulps: ulps.get(ulps.len() / 2).copied().unwrap_or_default(),
            worst_ulps: largest(&ulps),
            mean_texel: root_mean_square(&texels),
            worst_texel: largest(&texels),
        }
    }

    /// The time of `method` for one ray, in nanoseconds.
    fn nanoseconds(&self, method: &Method) -> f64 {
        method.accept(TimingVisitor { set: &self.set })
    }
}

fn root_mean_square(errors: &[f64]) -> f64 {
    let sum = errors.iter().fold(0.0, |sum, error| sum + error * error);
    (sum / errors.len().max(1) as f64).sqrt()
}

fn largest(errors: &[f64]) -> f64 {
    errors.iter().copied().fold(0.0, f64::max)
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
            let error = truth.t.error(hit.t.min(f64::MAX));
            // At a distance of zero the quotient would be infinite. The largest double stands for
            // it.
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

/// The sizes of the compared pictures, in pixels.
const PICTURES: [FrameSize; 2] = [picture(160, 90), picture(400, 120)];
const fn picture(width: u32, height: u32) -> FrameSize {
    match (NonZeroU32::new(width), NonZeroU32::new(height)) {
        (Some(width), Some(height)) => FrameSize { width, height },
        _ => panic!("a picture has pixels"),
    }
}

/// The number of pictures of each size.
const PICTURES_OF_A_SIZE: usize = 4;

/// The number of wrong pixels in pictures of `world`: one from its start, the others from random
/// positions.
pub(crate) fn pixels(world: &World, methods: &[Method], seed: u64) -> Table {
    let cameras: Vec<Camera> = cameras(world, seed).take(PICTURES_OF_A_SIZE).collect();
    let rows = PICTURES.iter().flat_map(|&size| {
        let reference = DynCaster::new(Reference);
        let truths: Vec<Frame> =
            cameras.iter().map(|it| draw(world, it, size, &reference)).collect();
        let name = format!("{}x{}", size.width, size.height);
        let row = |method: &Method| {
            let caster = method.caster();
            let pictures = cameras.iter().zip(&truths);
            let wrong =
                pictures.map(|(it, truth)| different(&draw(world, it, size, &caster), truth)).sum();
            let pixels = size.width.get() as usize * size.height.get() as usize * truths.len();
            let values = vec![Value::Count(pixels as u64), Value::share(wrong, pixels)];
            row_of(&name, method, values)
        };
        methods.iter().map(row).collect::<Vec<_>>()
    });
    Table {
        name: "pixels",
        title: "Pixels of whole pictures that another method of casting changes".to_owned(),
        keys: ["picture", "method", "parameter"],
        columns: headings(["pixels", "wrong"]),
        rows: rows.collect(),
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

fn draw(world: &World, camera: &Camera, size: FrameSize, caster: &DynCaster) -> Frame {
    let mut frame = Frame::new(size, PixelAspect::SQUARE);
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
            assert!(exact.worst_distance < 1e-15 && exact.worst_texel < 1e-10);
            let march = trial.errors(&"march:0.3".parse().unwrap());
            assert!(march.wrong > 0 && march.worst_distance > exact.worst_distance);
        }
    }

    /// The double nearest to a number in general position is a quarter of a unit away on average. A
    /// mean relative error below 2⁻⁵⁶ is impossible.
    #[test]
    fn rounding_is_an_error() {
        for trial in trials() {
            let exact = trial.errors(&Method::Exact);
            assert!(exact.median_ulps > 0.1 && exact.mean_distance > 2_f64.powi(-56), "{exact:?}");
            assert!(exact.worst_ulps < 2.0);
        }
    }

    #[test]
    fn exact_pictures_have_no_wrong_pixel_and_coarse_ones_have() {
        let museum = include_str!("../../../../tests/maps/museum.toml");
        let world = map::parse_str(museum).unwrap();
        let methods = ["exact", "march:0.2"].map(|name| name.parse().unwrap());
        for [exact, coarse] in pixels(&world, &methods, 7).rows.as_chunks().0 {
            assert_eq!(exact.values[1], Value::Share(0.0));
            assert!(coarse.values[1].number().unwrap() > 0.0);
        }
    }
}
