//! The tables of rays: ordinary scenes, stiff and extreme sets, and whole pictures.

use std::num::NonZeroU32;

use super::table::{Column, Diagram, Row, Table, Value, time_in_rounds};
use super::{Errors, Gallery, Trial};
use crate::casters::Method;
use cellcaster::render::FrameSize;
use cellcaster::world::World;

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

/// All methods, each with several values of its parameter.
pub fn all_methods() -> Vec<Method> {
    METHODS.iter().filter_map(|name| name.parse().ok()).collect()
}

/// Whether `method` ends soon enough among the cells of the scene with that name to be measured
/// there: a small step across a large plain does not.
pub fn is_measured(scene: &str, method: &Method) -> bool {
    const LEAST_STEP: f64 = 0.01;
    scene != "plain-4096" || !matches!(method, Method::March(march) if march.step() < LEAST_STEP)
}

/// The largest error of a distance that a double has without any fault, relative: 2⁻⁵³.
const ROUNDING: f64 = f64::EPSILON / 2.0;

/// The table of `trials`, each timed in `rounds` rounds.
pub(crate) fn scenes(trials: &[Trial], methods: &[Method], rounds: usize) -> Table {
    let rows = trials.iter().flat_map(|trial| {
        let methods: Vec<&Method> =
            methods.iter().filter(|method| is_measured(trial.name(), method)).collect();
        let times =
            time_in_rounds(methods.len(), rounds, |index| trial.nanoseconds(methods[index]));
        let row = |(method, time): (&Method, Value)| {
            let mut values = values(&trial.errors(method));
            values.push(instructions(trial.name(), method).map_or(Value::None, Value::Number));
            values.push(time);
            Row { keys: keys(trial.name(), method), values }
        };
        methods.into_iter().zip(times).map(row).collect::<Vec<_>>()
    });
    Table {
        name: "rays",
        title: "Rays in ordinary scenes, compared with rational arithmetic",
        keys: ["scene", "method", "parameter"],
        columns: vec![
            Column::new("rays", ""),
            Column::new("wrong rays", ""),
            Column::new("distance, rms", "relative"),
            Column::new("distance, worst", "relative"),
            Column::new("right rays: median", "ulp"),
            Column::new("right rays: worst", "ulp"),
            Column::new("right rays: rms", "texels of 64"),
            Column::new("right rays: worst", "texels of 64"),
            Column::new("instructions", "a ray"),
            Column::new("time", "ns a ray"),
        ],
        rows: rows.collect(),
        diagrams: vec![
            Diagram { columns: [9, 2], range: [ROUNDING / 4.0, 10.0] },
            Diagram { columns: [9, 1], range: [1e-4, 1.0] },
            Diagram { columns: [8, 2], range: [ROUNDING / 4.0, 10.0] },
        ],
    }
}

fn values(errors: &Errors) -> Vec<Value> {
    vec![
        Value::Count(errors.rays as u64),
        Value::Share(errors.share_wrong()),
        Value::Number(errors.mean_distance),
        Value::Number(errors.worst_distance),
        Value::Number(errors.median_ulps),
        Value::Number(errors.worst_ulps),
        Value::Number(errors.mean_texel),
        Value::Number(errors.worst_texel),
    ]
}

/// A scene, a method and its parameter, as keys.
fn keys(scene: &str, method: &Method) -> [String; 3] {
    let method = method.to_string();
    let (name, parameter) = method.split_once(':').unwrap_or((&method, ""));
    [scene, name, parameter].map(str::to_owned)
}

/// The stiff and extreme sets of `trials`, with the default parameter of each method.
pub(crate) fn stiff(trials: impl Iterator<Item = Trial>) -> Table {
    let methods: Vec<Method> = Method::NAMES.iter().filter_map(|name| name.parse().ok()).collect();
    let rows = trials.map(|trial| {
        let all: Vec<Errors> = methods.iter().map(|method| trial.errors(method)).collect();
        let mut values = vec![Value::Count(all[0].rays as u64)];
        values.extend(all.iter().flat_map(|errors| {
            [Value::Share(errors.share_wrong()), Value::Number(errors.worst_distance)]
        }));
        Row { keys: [trial.name().to_owned(), String::new(), String::new()], values }
    });
    let mut columns = vec![Column::new("rays", "")];
    columns.extend(methods.iter().flat_map(|method| {
        let name = |what| Column::new(format!("{method}: {what}"), "");
        [name("wrong"), name("worst")]
    }));
    Table {
        name: "stiff",
        title: "Rays in stiff and extreme sets: wrong rays, and the worst relative error of the distance",
        keys: ["set", "", ""],
        columns,
        rows: rows.collect(),
        diagrams: Vec::new(),
    }
}

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

/// The wrong pixels in pictures of `world`.
pub(crate) fn pixels(world: &World, methods: &[Method], seed: u64) -> Table {
    let rows = PICTURES.iter().flat_map(|&size| {
        let gallery = Gallery::new(world, size, PICTURES_OF_A_SIZE, seed);
        let name = format!("{}x{}", size.width, size.height);
        let pixels = size.width.get() as usize * size.height.get() as usize * PICTURES_OF_A_SIZE;
        let row = |method: &Method| Row {
            keys: keys(&name, method),
            values: vec![Value::Count(pixels as u64), Value::Share(gallery.share_wrong(method))],
        };
        methods.iter().map(row).collect::<Vec<_>>()
    });
    Table {
        name: "pixels",
        title: "Pixels of whole pictures that another method of casting changes",
        keys: ["picture", "method", "parameter"],
        columns: vec![Column::new("pixels", ""), Column::new("wrong", "")],
        rows: rows.collect(),
        diagrams: Vec::new(),
    }
}

// The instructions of each method for a ray, as Callgrind has counted them.
//
// A program cannot count its own instructions without the help of the system, and a time differs
// from run to run. Therefore the counts of the ordinary scenes are kept in a file, which
// `.ci/accuracy count` writes. They are those of [`SEED`] and [`RAYS`] rays, or a hundredth of
// these on the plain.

/// The seed of the counted rays.
pub const SEED: u64 = 1;
/// The number of counted rays in a scene.
pub const RAYS: usize = 2000;

/// A line for each scene and method: their names, and the instructions for a ray.
const COUNTS: &str = include_str!("instructions/counts");

/// The instructions for a ray of the scene with that name, if they are kept.
pub(crate) fn instructions(scene: &str, method: &Method) -> Option<f64> {
    let method = method.to_string();
    COUNTS.lines().find_map(|line| {
        let mut words = line.split(' ');
        let is_it = words.next() == Some(scene) && words.next() == Some(&method);
        is_it.then(|| words.next()?.parse().ok()).flatten()
    })
}
