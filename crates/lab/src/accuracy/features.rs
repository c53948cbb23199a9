//! Everything else that has a truth: one row for each feature.
//!
//! Each truth is computed another way than the feature: in [fixed point](super::fixed_point) where a
//! ray meets a shape, by another caster where a picture has heights, by a copy of the room where it
//! has mirrors, from the definition where a colour has light.

mod colors;
mod fidelity;
mod light;
mod rays;
mod scenes;
mod solids;

use std::time::Instant;

use super::table::{Column, Row, Table, Value};
use super::timing::time_in_rounds;
use cellcaster::world::World;

/// The errors of a feature.
struct Feature {
    name: &'static str,
    /// What is compared.
    figure: &'static str,
    /// The unit of the errors.
    unit: &'static str,
    /// The number of comparisons.
    cases: usize,
    /// The number of cases that are another thing than they should be.
    wrong: usize,
    /// The errors of the other cases.
    errors: Vec<f64>,
    /// Does the work of all cases once; `None` if it was timed with another feature.
    work: Option<Box<dyn FnMut()>>,
}

/// The errors of all features. Each is timed in `rounds` rounds.
pub(crate) fn table(world: &World, seed: u64, rounds: usize) -> Table {
    let mut features = rays::features(seed);
    features.extend(solids::features(seed));
    features.extend(scenes::features(seed));
    features.extend(light::features());
    features.extend(colors::features());
    features.extend(fidelity::features(world));
    let times = time_in_rounds(features.len(), rounds, |index| {
        let Feature { work, cases, .. } = &mut features[index];
        let start = Instant::now();
        if let Some(work) = work {
            work();
        }
        start.elapsed().as_secs_f64() * 1e9 / (*cases).max(1) as f64
    });
    let rows = features.iter().zip(times).map(|(feature, time)| {
        let time = if feature.work.is_some() { time } else { Value::None };
        Row {
            keys: [feature.name, feature.figure, feature.unit].map(str::to_owned),
            values: feature.values(time),
        }
    });
    Table {
        name: "features",
        title: "Everything else that has a truth: a case is a ray, a pixel or a colour",
        keys: ["feature", "figure", "unit"],
        columns: vec![
            Column::new("cases", ""),
            Column::new("wrong", ""),
            Column::new("mean error", ""),
            Column::new("worst error", ""),
            Column::new("time", "ns a case"),
        ],
        rows: rows.collect(),
        diagrams: Vec::new(),
    }
}

impl Feature {
    fn values(&self, time: Value) -> Vec<Value> {
        let Self { cases, wrong, errors, .. } = self;
        let mean = errors.iter().sum::<f64>() / errors.len().max(1) as f64;
        let worst = errors.iter().copied().fold(0.0, f64::max);
        let number = |value| if errors.is_empty() { Value::None } else { Value::Number(value) };
        vec![
            Value::Count(*cases as u64),
            Value::Share(*wrong as f64 / (*cases).max(1) as f64),
            number(mean),
            number(worst),
            time,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cellcaster::map::builtin;

    #[test]
    fn every_feature_has_cases_and_none_is_wrong_but_by_choice() {
        let world = builtin::LEVELS[0].world().unwrap();
        let table = table(&world, 1, 0);
        assert!(table.rows.len() >= 15);
        for row in &table.rows {
            let [Value::Count(cases), Value::Share(wrong), ..] = row.values[..] else { panic!() };
            assert!(cases > 100, "{row:?}");
            let is_chosen =
                ["palette", "fidelity"].iter().any(|name| row.keys[0].starts_with(name));
            assert!(wrong == 0.0 || is_chosen, "{row:?}");
        }
    }
}
