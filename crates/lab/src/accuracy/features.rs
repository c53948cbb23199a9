//! Every other feature that has a reference: one row for each feature.
//!
//! The reference is computed in another way than the feature. If a ray meets a shape, it is
//! computed in [fixed point](super::fixed_point). If a picture has heights, it comes from another
//! caster. If a picture has mirrors, it comes from a copy of the room. If a colour has light, it
//! comes from the definition.

mod pictures;
mod rays;
mod solids;

use std::hint::black_box;

use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};
use ratatui::style::Color;

use crate::report::{Row, Table, Value, headings, seconds, time_in_rounds};
use cellcaster::color::Rgb;
use cellcaster::color::lab::Lab;
use cellcaster::color::oklab::Oklab;
use cellcaster::color::palette::{nearest_of_16, nearest_of_256, of_256};
use cellcaster::terminal::{CellWriter, Fidelity};
use cellcaster::tui::{FirstPerson, View, rgb_of};
use cellcaster::world::{Camera, FieldOfView, World};

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
pub(crate) fn table(world: &World, seed: u64, rounds: usize) -> Table {
    let mut features = rays::features(seed);
    features.extend(solids::features(seed));
    features.extend(pictures::features(seed));
    features.extend([
        palette("palette of 256", 16..=255, nearest_of_256),
        palette("palette of 16", 0..=15, nearest_of_16),
        fidelity("fidelity: exact", Fidelity::EXACT, world),
        fidelity("fidelity: high", Fidelity::HIGH, world),
        fidelity("fidelity: low", Fidelity::LOW, world),
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

// Fidelity: the colours that a terminal shows while the camera moves, compared with the drawn ones.

const WINDOW: Size = Size::new(80, 24);
const FRAMES: usize = 24;
/// The turn between frames, in radians: a player's turn at 30 frames a second.
const TURN: f64 = 0.05;
/// The smallest visible difference, in ΔE.
const SEEN: f64 = 2.3;

/// Compares colours at a fidelity. A colour is wrong if its difference is visible. The errors
/// include all colours.
fn fidelity(name: &'static str, fidelity: Fidelity, world: &World) -> Feature {
    let mut camera = world.start_camera(FieldOfView::default());
    let mut view = View::default();
    let mut writer = writer(fidelity);
    let mut drawn = Buffer::empty(Rect::from(WINDOW));
    let (mut outcomes, mut cameras) = (Vec::new(), Vec::new());
    for _ in 0..FRAMES {
        show(world, &camera, &mut view, &mut writer);
        FirstPerson::new(world, &camera).paint(&view, 0, drawn.area, &mut drawn);
        for (y, row) in (0..).zip(drawn.content.chunks(usize::from(WINDOW.width))) {
            for (x, cell) in (0..).zip(row) {
                let wanted = halves(cell.symbol(), cell.fg, cell.bg);
                let shown = writer.shown_colors(x, y).unwrap_or(wanted);
                outcomes.extend(wanted.into_iter().zip(shown).map(|(one, other)| {
                    let error = distance(one, other);
                    (error > SEEN, Some(error))
                }));
            }
        }
        cameras.push(camera);
        camera.heading = camera.heading.turned(TURN);
    }
    let world = world.clone();
    let work = move || {
        let mut writer = self::writer(fidelity);
        for camera in &cameras {
            show(&world, camera, &mut view, &mut writer);
        }
    };
    Feature { name, figure: "colour of half a cell", unit: "ΔE", outcomes, work: Box::new(work) }
}

fn writer(fidelity: Fidelity) -> CellWriter<Vec<u8>> {
    let mut writer = CellWriter::new(Vec::new(), WINDOW);
    writer.set_fidelity(fidelity);
    writer
}

/// Draws the view of `camera`, and encodes it.
fn show(world: &World, camera: &Camera, view: &mut View, writer: &mut CellWriter<Vec<u8>>) {
    let picture = FirstPerson::new(world, camera);
    picture.draw(WINDOW, view);
    writer.draw_frame(|screen| picture.paint(view, 0, Rect::from(WINDOW), screen));
    writer.output_mut().clear();
}

/// The colours of the upper and the lower half of a cell that contains a half block, a full block
/// or a space.
fn halves(symbol: &str, text: Color, ground: Color) -> [Color; 2] {
    match symbol {
        "▀" => [text, ground],
        "▄" => [ground, text],
        "█" => [text, text],
        _ => [ground, ground],
    }
}

fn distance(one: Color, other: Color) -> f64 {
    let lab = |color| Lab::from(rgb_of(color).unwrap_or(Rgb::BLACK));
    lab(one).distance(lab(other))
}

#[cfg(test)]
mod tests {
    use super::*;
    use cellcaster::map::builtin;

    #[test]
    fn only_features_that_approximate_by_design_are_wrong() {
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
