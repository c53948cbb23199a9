//! Accuracy: comparisons with a reference, and the cost of each figure in a report.
//!
//! [`cast`] computes in rational arithmetic, and shares only the rules in [`cellcaster::cast`] with
//! the casters. [`sets()`] returns named sets of stiff and extreme cases; [`random_ray`] generates
//! any number of other rays from a seed. [`report`] compares and times, and returns
//! [tables](Table).

mod areas;
mod features;
mod fixed_point;
mod motion;
mod rays;
mod reference;
mod sets;

pub use rays::{RAYS, SEED};
pub use reference::{Truth, cast};
pub use sets::{Set, ordinary, plain, random_ray, sets};

use clap::{Args, ValueEnum};

use crate::casters::Method;
use crate::report::Table;
use cellcaster::cli::options::{seed, within};
use cellcaster::cli::parse::ValidValues;
use cellcaster::game::{FRICTION, STEPS_PER_SECOND};
use cellcaster::rng::SplitMix64;
use cellcaster::world::World;
use rays::Trial;

/// The options of a report.
#[derive(Args, Clone, Debug)]
pub struct Plan {
    /// Report on this part; may be repeated [default: all]
    #[arg(long = "part", value_name = "PART")]
    pub parts: Vec<Part>,
    /// Cast the rays of one set, such as "through corners"
    #[arg(long, value_name = "NAME")]
    pub set: Option<String>,
    /// Report on this method; may be repeated: exact, dda, dda32, accumulate, fixed:BITS, table:ANGLES or march:STEP
    /// [default: all]
    #[arg(long = "caster", value_name = "METHOD")]
    pub methods: Vec<Method>,
    /// The number of rays in each scene, from 1 to 1000000
    #[arg(long, value_name = "N", value_parser = rays, default_value_t = RAYS)]
    pub rays: usize,
    /// The seed of the random numbers
    #[arg(long, value_name = "N", value_parser = seed, default_value_t = SEED)]
    pub seed: u64,
    /// The number of timings of each candidate; 0 omits the times, so that every run writes the same report
    #[arg(long, value_name = "N", value_parser = rounds, default_value_t = 15)]
    pub rounds: usize,
    /// The player's friction per second, for the part motion
    #[arg(long, value_name = "RATE", value_parser = friction, default_value_t = FRICTION)]
    pub friction: f64,
    /// The game's steps per second, for the part motion
    #[arg(long, value_name = "N", value_parser = steps_per_second, default_value_t = STEPS_PER_SECOND.into())]
    pub steps_per_second: f64,
}

/// A part of the report.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Part {
    /// Rays.
    #[value(help = None)]
    Rays,
    /// Pictures, compared with the mean over the area of each pixel.
    #[value(help = None)]
    Pictures,
    /// Damped motion.
    #[value(help = None)]
    Motion,
    /// Everything else that has a reference.
    #[value(help = None)]
    Features,
}

fn rays(text: &str) -> Result<usize, ValidValues> {
    within(text, |rays| (1..=1_000_000).contains(rays), "a whole number from 1 to 1000000")
}

fn rounds(text: &str) -> Result<usize, ValidValues> {
    within(text, |&rounds| rounds <= 1000, "a whole number from 0 to 1000")
}

fn friction(text: &str) -> Result<f64, ValidValues> {
    within(text, |rate| (1e-3..=1e9).contains(rate), "a number from 0.001 to 1000000000")
}

fn steps_per_second(text: &str) -> Result<f64, ValidValues> {
    within(text, |steps| (0.1..=1e4).contains(steps), "a number from 0.1 to 10000")
}

/// The tables for `plan`; `None` if no set has the requested name. Rays and pictures use `map`.
/// Without a map, rays use two scenes and the stiff sets, and pictures all built-in levels. Calls `progress` with each part
/// before it begins.
pub fn report(
    plan: &Plan,
    map: Option<&World>,
    mut progress: impl FnMut(Part),
) -> Option<Vec<Table>> {
    let parts = if plan.parts.is_empty() { Part::value_variants() } else { &plan.parts };
    let mut tables = Vec::new();
    for &part in parts {
        progress(part);
        match part {
            Part::Rays => tables.extend(ray_tables(plan, map)?),
            Part::Pictures => tables.push(areas::table(map, plan.rounds)),
            Part::Motion => tables.extend([
                motion::motions(plan.friction, plan.steps_per_second, plan.rounds),
                motion::orders(),
            ]),
            Part::Features => tables.push(features::table(plan.seed, plan.rounds)),
        }
    }
    Some(tables)
}

/// The names of all sets of rays.
pub fn set_names() -> Vec<&'static str> {
    let ordinary = ordinary(0, 0).into_iter().map(|set| set.name);
    let stiff = sets(0).into_iter().map(|set| set.name);
    ordinary.chain(["plain-4096"]).chain(stiff).collect()
}

fn ray_tables(plan: &Plan, map: Option<&World>) -> Option<Vec<Table>> {
    let &Plan { rays: count, seed, rounds, .. } = plan;
    let methods = match plan.methods.as_slice() {
        [] => Method::at_all_parameters(),
        named => named.to_vec(),
    };
    let sets_of_rays = match (plan.set.as_deref(), map) {
        (Some("plain-4096"), _) => vec![plain(seed, count)],
        (Some(name), _) => {
            let mut all = ordinary(seed, count).into_iter().chain(sets(seed));
            vec![all.find(|set| set.name == name)?]
        }
        (None, Some(map)) => {
            let grid = map.grid().clone();
            let mut random = SplitMix64::new(seed);
            let rays = (0..count).map(|_| random_ray(&grid, &mut random)).collect();
            vec![Set { name: "map", grid, rays }]
        }
        (None, None) => {
            let rooms = ordinary(seed, count).into_iter().take(1);
            rooms.chain([plain(seed, count)]).collect()
        }
    };
    let trials: Vec<Trial> = sets_of_rays.into_iter().map(Trial::new).collect();
    let mut tables = vec![rays::scenes(&trials, &methods, rounds)];
    if plan.set.is_none() && map.is_none() {
        tables.push(rays::stiff(sets(seed).into_iter().map(Trial::new)));
    }
    Some(tables)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cellcaster::map::builtin;

    fn plan() -> Plan {
        Plan {
            parts: vec![Part::Rays],
            set: None,
            methods: ["exact", "march:0.1"].map(|name| name.parse().unwrap()).into(),
            rays: 50,
            seed: SEED,
            rounds: 0,
            friction: FRICTION,
            steps_per_second: STEPS_PER_SECOND.into(),
        }
    }

    #[test]
    fn a_table_has_a_row_per_method_and_a_value_per_column() {
        let world = builtin::LEVELS[0].world().unwrap();
        let mut parts = Vec::new();
        let tables = report(&plan(), Some(&world), |part| parts.push(part)).unwrap();
        let names: Vec<&str> = tables.iter().map(|table| table.name).collect();
        assert_eq!(names, ["rays"]);
        assert_eq!(tables[0].rows.len(), 2);
        let rows = tables.iter().flat_map(|table| table.rows.iter().map(move |row| (table, row)));
        for (table, row) in rows {
            assert_eq!(table.columns.len(), row.values.len(), "{}", table.name);
        }
        assert_eq!(parts, [Part::Rays]);
    }

    #[test]
    fn an_unknown_set_has_no_report() {
        let plan = Plan { set: Some("nobody's".to_owned()), ..plan() };
        assert!(report(&plan, None, |_| ()).is_none());
        assert!(set_names().len() > 3);
    }
}
