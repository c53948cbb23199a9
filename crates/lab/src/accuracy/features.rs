//! Every other feature that has a reference: one row for each feature.
//!
//! The reference is computed in another way than the feature: in [fixed point](super::fixed_point) if a ray
//! meets a shape, and by a search of the whole palette for a colour.

mod mip;
mod rays;
mod solids;

use std::hint::black_box;

use crate::report::{Row, Table, Value, headings, seconds, time_in_rounds};
use cellcaster::color::Rgb;
use cellcaster::color::lab::Lab;
use cellcaster::color::oklab::Oklab;
use cellcaster::color::palette::{nearest_of_16, nearest_of_256, of_256};

/// The errors of a feature.
struct Feature {
    name: &'static str,
    /// The figure that is compared.
    figure: &'static str,
    /// The unit of the errors.
    unit: &'static str,
    outcomes: Vec<Outcome>,
    /// Does the work of all cases once.
    work: Box<dyn FnMut()>,
}

/// Whether the result of a case is wrong, and its error if it has one.
type Outcome = (bool, Option<f64>);

/// The errors of all features. Each is timed in `rounds` rounds.
pub(crate) fn table(seed: u64, rounds: usize) -> Table {
    let mut features = rays::features(seed);
    features.extend(solids::features(seed));
    features.push(mip::mip_levels());
    features.extend([
        palette("palette of 256", 16..=255, nearest_of_256),
        palette("palette of 16", 0..=15, nearest_of_16),
    ]);
    let times = time_in_rounds(features.len(), rounds, |index| {
        let Feature { work, outcomes, .. } = &mut features[index];
        seconds(work) * 1e9 / outcomes.len().max(1) as f64
    });
    let rows = features.iter().zip(times).map(|(feature, time)| {
        let Feature { name, figure, unit, outcomes, .. } = feature;
        let wrong = outcomes.iter().filter(|(is_wrong, _)| *is_wrong).count();
        let errors: Vec<f64> = outcomes.iter().filter_map(|(_, error)| *error).collect();
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        let values = vec![
            Value::Count(outcomes.len() as u64),
            Value::share(wrong, outcomes.len()),
            Value::maybe((!errors.is_empty()).then_some(mean)),
            Value::maybe(errors.iter().copied().reduce(f64::max)),
            time,
        ];
        Row::new([name, figure, unit], values)
    });
    Table {
        name: "features",
        title: "Other features; a case is a ray, a pixel or a colour".to_owned(),
        keys: ["feature", "figure", "unit"],
        columns: headings(["cases", "wrong", "mean error", "worst error", "time, ns a case"]),
        rows: rows.collect(),
        diagrams: Vec::new(),
    }
}

// Palettes: the distance of the nearest colour, and whether it is really the nearest.

/// Every fifteenth value of each channel.
const STEP: usize = 15;

/// Compares the nearest colours of a palette. A colour is wrong if another index is nearer in
/// Oklab, in which the palette is searched. The errors of the shown colours are in ΔE of CIE76, in
/// which a difference of 2.3 is just visible.
fn palette(
    name: &'static str,
    indices: std::ops::RangeInclusive<u8>,
    nearest: fn(Rgb) -> u8,
) -> Feature {
    let values = || (0..=255_u8).step_by(STEP);
    let colors: Vec<Rgb> = values()
        .flat_map(|red| {
            values().flat_map(move |green| values().map(move |blue| Rgb::new(red, green, blue)))
        })
        .collect();
    let outcome = |&color: &Rgb| {
        let distance = |index: u8| Oklab::from(of_256(index)).distance_squared(&Oklab::from(color));
        let chosen = nearest(color);
        let is_wrong = indices.clone().any(|index| distance(index) < distance(chosen));
        (is_wrong, Some(Lab::from(of_256(chosen)).distance(Lab::from(color))))
    };
    let outcomes = colors.iter().map(outcome).collect();
    let work = move || {
        for &color in &colors {
            black_box(nearest(black_box(color)));
        }
    };
    Feature { name, figure: "colour", unit: "ΔE", outcomes, work: Box::new(work) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_features_that_approximate_by_design_are_wrong() {
        let table = table(1, 0);
        assert!(table.rows.len() >= 10);
        for row in &table.rows {
            let [Value::Count(cases), Value::Share(wrong), ..] = row.values[..] else { panic!() };
            assert!(cases > 100, "{row:?}");
            assert!(wrong == 0.0 || row.keys[0].starts_with("palette"), "{row:?}");
        }
    }
}
