//! The report: tables of figures, in parts.

use super::{
    RAYS, SEED, Set, Table, Trial, all_methods, areas, features, motion, ordinary, plain,
    random_ray, ray_tables, sets,
};
use crate::casters::Method;
use crate::speed::textured_scene;
use cellcaster::game::STEPS_PER_SECOND;
use cellcaster::rng::SplitMix64;
use cellcaster::world::World;

/// The options of a report.
#[derive(Clone, Debug)]
pub struct Plan<'world> {
    /// The parts; all of them if empty.
    pub parts: Vec<Part>,
    /// The world whose pictures are compared with the means over areas.
    pub world: &'world World,
    /// The source of the rays.
    pub rays: RaySource,
    /// The methods; all of them if empty.
    pub methods: Vec<Method>,
    /// The number of rays in each scene.
    pub count: usize,
    /// The seed of the random rays and cameras.
    pub seed: u64,
    /// How often each candidate is timed; never if 0.
    pub rounds: usize,
    /// The player's friction, per second.
    pub friction: f64,
    /// The steps of the game in a second.
    pub steps_per_second: f64,
}

impl<'world> Plan<'world> {
    /// The whole report on ordinary scenes, with pictures of `world`.
    pub fn new(world: &'world World) -> Self {
        Self {
            parts: Vec::new(),
            world,
            rays: RaySource::Scenes,
            methods: Vec::new(),
            count: RAYS,
            seed: SEED,
            rounds: 15,
            friction: cellcaster::game::FRICTION,
            steps_per_second: f64::from(STEPS_PER_SECOND),
        }
    }
}

/// A part of the report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Rays, and the pixels that they change.
    Rays,
    /// Pictures, compared with the mean over the area of each pixel.
    Pictures,
    /// Damped motion.
    Motion,
    /// Everything else that has a truth.
    Features,
}

impl Part {
    /// All parts, in the order of the report.
    pub const ALL: [Self; 4] = [Self::Rays, Self::Pictures, Self::Motion, Self::Features];

    /// The name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rays => "rays",
            Self::Pictures => "pictures",
            Self::Motion => "motion",
            Self::Features => "features",
        }
    }
}

/// A source of rays.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RaySource {
    /// Four ordinary scenes. The report then includes the stiff sets, and pictures of a level of
    /// rooms and pillars.
    Scenes,
    /// The world of the pictures.
    World,
    /// The set with this name.
    Set(String),
}

/// The tables for `plan`; `None` if no set has the requested name. `progress` is called with the
/// completed fraction.
pub fn report(plan: &Plan, mut progress: impl FnMut(f64)) -> Option<Vec<Table>> {
    let parts = if plan.parts.is_empty() { &Part::ALL[..] } else { &plan.parts };
    let mut tables = Vec::new();
    for (index, part) in parts.iter().enumerate() {
        progress(index as f64 / parts.len() as f64);
        match part {
            Part::Rays => tables.extend(rays(plan)?),
            Part::Pictures => tables.push(areas::table(plan.world, plan.seed, plan.rounds)),
            Part::Motion => tables.extend([
                motion::motions(plan.friction, plan.steps_per_second, plan.rounds),
                motion::orders(),
            ]),
            Part::Features => tables.push(features::table(plan.world, plan.seed, plan.rounds)),
        }
    }
    progress(1.0);
    Some(tables)
}

/// The names of all sets of rays.
pub fn set_names() -> Vec<&'static str> {
    let ordinary = ordinary(0, 0).into_iter().map(|set| set.name);
    let stiff = sets(0).into_iter().map(|set| set.name);
    ordinary.chain(["plain-4096"]).chain(stiff).collect()
}

fn rays(plan: &Plan) -> Option<Vec<Table>> {
    let methods = if plan.methods.is_empty() { all_methods() } else { plan.methods.clone() };
    let trials: Vec<Trial> = ray_sets(plan)?.into_iter().map(Trial::new).collect();
    let mut tables = vec![ray_tables::scenes(&trials, &methods, plan.rounds)];
    let scene = textured_scene();
    let world = if plan.rays == RaySource::World { plan.world } else { &scene };
    tables.push(ray_tables::pixels(world, &methods, plan.seed));
    if plan.rays == RaySource::Scenes {
        tables.push(ray_tables::stiff(sets(plan.seed).into_iter().map(Trial::new)));
    }
    Some(tables)
}

fn ray_sets(plan: &Plan) -> Option<Vec<Set>> {
    let &Plan { world, count, seed, .. } = plan;
    Some(match &plan.rays {
        RaySource::Scenes => {
            let mut sets = ordinary(seed, count);
            sets.push(plain(seed, count));
            sets
        }
        RaySource::World => {
            let grid = world.grid().clone();
            let mut random = SplitMix64::new(seed);
            let rays = (0..count).map(|_| random_ray(&grid, &mut random)).collect();
            vec![Set { name: "map", grid, rays }]
        }
        RaySource::Set(name) if name == "plain-4096" => vec![plain(seed, count)],
        RaySource::Set(name) => {
            let mut all = ordinary(seed, count).into_iter().chain(sets(seed));
            vec![all.find(|set| set.name == name)?]
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use cellcaster::map::builtin;

    fn plan(world: &World) -> Plan<'_> {
        Plan { rounds: 0, count: 50, ..Plan::new(world) }
    }

    #[test]
    fn a_part_has_a_row_for_each_method_and_a_value_for_each_column() {
        let world = builtin::LEVELS[0].world().unwrap();
        let methods = ["exact", "march:0.1"].map(|name| name.parse().unwrap()).into();
        let plan =
            Plan { parts: vec![Part::Rays], rays: RaySource::World, methods, ..plan(&world) };
        let mut shares = Vec::new();
        let tables = report(&plan, |share| shares.push(share)).unwrap();
        let names: Vec<&str> = tables.iter().map(|table| table.name).collect();
        assert_eq!(names, ["rays", "pixels"]);
        assert_eq!(tables[0].rows.len(), 2);
        let rows = tables.iter().flat_map(|table| table.rows.iter().map(move |row| (table, row)));
        for (table, row) in rows {
            assert_eq!(table.columns.len(), row.values.len(), "{}", table.name);
        }
        assert!(shares.is_sorted() && shares.last() == Some(&1.0));
    }

    #[test]
    fn there_is_no_set_without_a_name() {
        let world = builtin::LEVELS[0].world().unwrap();
        let rays = RaySource::Set("nobody's".to_owned());
        assert!(report(&Plan { rays, ..plan(&world) }, |_| ()).is_none());
        assert!(set_names().len() > 3);
    }
}
