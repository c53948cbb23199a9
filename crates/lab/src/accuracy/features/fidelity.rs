//! Fidelity: the colours that a terminal shows while the camera moves, compared with those that were
//! drawn.

use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};
use ratatui::style::Color;

use super::Feature;
use cellcaster::color::Rgb;
use cellcaster::color::lab::Lab;
use cellcaster::terminal::{CellWriter, Fidelity};
use cellcaster::tui::{FirstPerson, View};
use cellcaster::world::{Camera, FieldOfView, World};

const WINDOW: Size = Size::new(80, 24);
const FRAMES: usize = 24;
/// Between frames, in radians: a turn of a player at 30 frames a second.
const TURN: f64 = 0.05;
/// The difference that is just seen, in ΔE.
const SEEN: f64 = 2.3;

pub(crate) fn features(world: &World) -> Vec<Feature> {
    [
        ("fidelity: exact", Fidelity::EXACT),
        ("fidelity: high", Fidelity::HIGH),
        ("fidelity: low", Fidelity::LOW),
    ]
    .into_iter()
    .map(|(name, fidelity)| feature(name, fidelity, world))
    .collect()
}

/// A colour is wrong if its difference is seen. The errors are of all colours.
fn feature(name: &'static str, fidelity: Fidelity, world: &World) -> Feature {
    let mut camera = world.start_camera(FieldOfView::default());
    let mut view = View::default();
    let mut writer = writer(fidelity);
    let mut drawn = Buffer::empty(Rect::from(WINDOW));
    let mut errors = Vec::new();
    let mut cameras = Vec::new();
    for _ in 0..FRAMES {
        show(world, &camera, &mut view, &mut writer);
        FirstPerson::new(world, &camera).paint(&view, 0, drawn.area, &mut drawn);
        for (y, row) in (0..).zip(drawn.content.chunks(usize::from(WINDOW.width))) {
            for (x, cell) in (0..).zip(row) {
                let wanted = halves(cell.symbol(), cell.fg, cell.bg);
                let shown = writer.shown_colors(x, y).unwrap_or(wanted);
                errors
                    .extend(wanted.into_iter().zip(shown).map(|(one, other)| distance(one, other)));
            }
        }
        cameras.push(camera);
        camera.heading = camera.heading.turned(TURN);
    }
    let wrong = errors.iter().filter(|&&error| error > SEEN).count();
    let cases = errors.len();
    let world = world.clone();
    let work = move || {
        let mut writer = self::writer(fidelity);
        for camera in &cameras {
            show(&world, camera, &mut view, &mut writer);
        }
    };
    let work: Option<Box<dyn FnMut()>> = Some(Box::new(work));
    Feature { name, figure: "colour of half a cell", unit: "ΔE", cases, wrong, errors, work }
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

/// The colours of the upper and the lower half of a cell with a half block or a space.
fn halves(symbol: &str, text: Color, ground: Color) -> [Color; 2] {
    match symbol {
        "▀" => [text, ground],
        "▄" => [ground, text],
        "█" => [text, text],
        _ => [ground, ground],
    }
}

fn distance(one: Color, other: Color) -> f64 {
    let lab = |color| match color {
        Color::Rgb(red, green, blue) => Lab::from(Rgb::new(red, green, blue)),
        _ => Lab::from(Rgb::BLACK),
    };
    lab(one).distance(lab(other))
}
