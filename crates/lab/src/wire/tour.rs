//! Comparisons on a short walk through each level: of glyph sets at each fidelity, and of methods
//! to choose among few colours.
//!
//! Pictures are compared with the view as both appear from a distance ([`seen`]): the linear light
//! is blurred, and the error is the distance in Oklab. Without a blur, the nearest colours would
//! have the least error, because no pixel can be nearer.
//!
//! [`seen`]: super::seen

use std::num::NonZeroU32;

use ratatui::backend::Backend;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Rect, Size};
use ratatui::style::Color;
use ratatui::widgets::StatefulWidget;

use super::encoder::Encoder;
use super::seen::{SeenPicture, blurred};
use crate::report::{Diagram, Row, Table, Value, headings};
use cellcaster::app::parts::Choice;
use cellcaster::color::Rgb;
use cellcaster::color::oklab::Oklab;
use cellcaster::color::palette::{ColorDepth, ShadeInk, nearest_of_16, nearest_of_256};
use cellcaster::color::srgb::linear;
use cellcaster::game::{Game, STEPS_PER_SECOND, Script};
use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::terminal::{CellWriter, Fidelity};
use cellcaster::tui::canvas::{Canvas, Mosaic};
use cellcaster::tui::{FirstPerson, GlyphSet, View, rgb_of};
use cellcaster::world::{FieldOfView, World};

const TOUR: &str = "\
[tour]
1 s    forward
1 s    turn-left
0.5 s  forward turn-right
1 s    turn-right aim
0.5 s  strafe-left
";

/// Walks through a level. Calls `show` with the number and the state of each frame.
fn walk(mut game: Game, frames_per_second: NonZeroU32, mut show: impl FnMut(usize, &Game)) {
    let script = Script::parse(TOUR, "tour").unwrap_or_else(|faults| unreachable!("{faults}"));
    let frames_after =
        |steps: u64| steps * u64::from(frames_per_second.get()) / u64::from(STEPS_PER_SECOND);
    show(0, &game);
    let mut frames = 1;
    for (steps, (_, intents)) in (0..).zip(script.iter()) {
        game.step(intents);
        if frames_after(steps + 1) > frames_after(steps) {
            show(frames, &game);
            frames += 1;
        }
    }
}

// Glyph sets.

const SETS: [GlyphSet; 4] =
    [GlyphSet::Half, GlyphSet::Quadrant, GlyphSet::Sextant, GlyphSet::Octant];
const FIDELITIES: [Fidelity; 3] = [Fidelity::EXACT, Fidelity::HIGH, Fidelity::LOW];

/// Walks through `levels` in a window of this size, and measures the glyph sets of two, four, six and eight
/// dots in order, each at exact, high and low fidelity.
pub fn report_glyphs(
    size: Size,
    frames_per_second: NonZeroU32,
    levels: impl IntoIterator<Item = World>,
) -> Table {
    let mut sums = SETS.map(|_| FIDELITIES.map(|_| GlyphSums::default()));
    for world in levels {
        measure_glyphs(size, frames_per_second, Game::new(world), &mut sums);
    }
    let rows = SETS.into_iter().zip(sums).flat_map(|(glyphs, sums)| {
        FIDELITIES.into_iter().zip(sums).map(move |(fidelity, sums)| {
            let bytes = sums.bytes as f64 / sums.frames.max(1) as f64;
            let error = 1000.0 * sums.error / sums.compared.max(1) as f64;
            let values = [bytes, error].map(Value::Number).into();
            Row::new(["", glyphs.name(), &fidelity.to_string()], values)
        })
    });
    Table {
        name: "glyphs",
        title: "Glyph sets in all built-in levels; errors in Oklab after a blur of half a cell"
            .to_owned(),
        keys: ["", "glyphs", "fidelity"],
        columns: headings(["bytes a frame", "error, thousandths"]),
        rows: rows.collect(),
        diagrams: vec![Diagram { columns: [1, 0], range: Diagram::ALL }],
    }
}

/// The totals over all frames. The first frame of each level does not count for `frames` and
/// `bytes`.
#[derive(Clone, Copy, Default)]
struct GlyphSums {
    frames: usize,
    bytes: usize,
    compared: usize,
    error: f64,
}

fn measure_glyphs(
    size: Size,
    frames_per_second: NonZeroU32,
    game: Game,
    sums: &mut [[GlyphSums; FIDELITIES.len()]; SETS.len()],
) {
    /// One in this number of frames is compared, but the bytes of all frames are counted.
    const COMPARED: usize = 30;
    let writer = |fidelity| Encoder::ours(size, ColorDepth::True, fidelity, false);
    let mut writers = SETS.map(|_| FIDELITIES.map(writer));
    let mut pictures = SETS.map(|_| Buffer::empty(Rect::from(size)));
    let mut view = View::default();
    let mut bytes = Vec::new();
    walk(game, frames_per_second, |frame, game| {
        let camera = game.camera(FieldOfView::default());
        let truth =
            (frame % COMPARED == 0).then(|| SeenPicture::of_view(game.world(), &camera, size));
        for (set, glyphs) in SETS.into_iter().enumerate() {
            let before = pictures[set].clone();
            let picture = &mut pictures[set];
            FirstPerson::new(game.world(), &camera).glyphs(glyphs).filter(Filter::Area).render(
                picture.area,
                picture,
                &mut view,
            );
            let changes = before.diff(picture);
            for (writer, sums) in writers[set].iter_mut().zip(&mut sums[set]) {
                bytes.clear();
                writer.encode(&changes, &mut bytes);
                if frame > 0 {
                    sums.frames += 1;
                    sums.bytes += bytes.len();
                }
                if let Some(truth) = &truth {
                    sums.compared += 1;
                    sums.error += shown_by(writer, size).distance(truth);
                }
            }
        }
    });
}

/// The picture on the terminal. The terminal's own colours are black.
fn shown_by(encoder: &Encoder, size: Size) -> SeenPicture {
    SeenPicture::of_cells(size, |x, y| match encoder.shown(x, y) {
        Some((Some(mosaic), colors)) => {
            (mosaic, colors.map(|color| rgb_of(color).unwrap_or(Rgb::BLACK)))
        }
        _ => (Mosaic::halves(0), [Rgb::BLACK; 2]),
    })
}

// Methods to choose among few colours.

/// The names of the methods. `nearest` takes the nearest colours. The others are the game's
/// mixtures, for a terminal that draws shades as `dots` or as `flat` colours, or whose behaviour is
/// `unknown` to the game, which then assumes dots.
const METHODS: [(&str, Option<ShadeInk>); 4] = [
    ("nearest", None),
    ("dots", Some(ShadeInk::Dots)),
    ("flat", Some(ShadeInk::Flat)),
    ("unknown", Some(ShadeInk::Unknown)),
];

/// The headings of [`MethodRun::figures`].
const COLUMNS: [&str; 6] =
    ["first error", "first chroma error", "first lightness", "error", "changes", "bytes a frame"];

/// Walks through each of `levels`, which have a name, in a window of `size`, and compares the
/// methods in the palette of 256 or 16 colours. The last rows are the means over all levels.
///
/// # Panics
/// Panics if `size` has no cells.
pub fn report_palettes<'a>(
    depth: ColorDepth,
    size: Size,
    frames_per_second: NonZeroU32,
    levels: impl IntoIterator<Item = (&'a str, World)>,
) -> Table {
    let measured = levels.into_iter().map(|(name, world)| {
        (name, measure_palettes(depth, size, frames_per_second, Game::new(world)))
    });
    let mut levels: Vec<(&str, [[f64; 6]; 4])> = measured.collect();
    let mean = |method: usize, figure: usize| {
        let sum: f64 = levels.iter().map(|(_, figures)| figures[method][figure]).sum();
        sum / levels.len().max(1) as f64
    };
    let means = std::array::from_fn(|method| std::array::from_fn(|figure| mean(method, figure)));
    levels.push(("all", means));
    let rows = levels.iter().flat_map(|(level, figures)| {
        METHODS.iter().zip(figures).map(move |((method, _), figures)| {
            let [.., changes, bytes] = *figures;
            let errors = figures[..4].iter().map(|error| Value::Number(1000.0 * error));
            let values = errors.chain([Value::Share(changes), Value::Number(bytes)]).collect();
            Row::new([level, method, ""], values)
        })
    });
    Table {
        name: "palettes",
        title: format!(
            "{}×{} cells, {frames_per_second} frames a second. Errors in thousandths in Oklab after a blur, of the first\n\
             picture and of all; lightness: how much lighter than true colour; changes: the share of cells\n\
             that change between block and shade from frame to frame",
            size.width, size.height
        ),
        keys: ["level", "method", ""],
        columns: headings(COLUMNS),
        rows: rows.collect(),
        diagrams: vec![Diagram { columns: [3, 5], range: Diagram::ALL }],
    }
}

fn measure_palettes(
    depth: ColorDepth,
    size: Size,
    frames_per_second: NonZeroU32,
    game: Game,
) -> [[f64; 6]; 4] {
    /// One in this number of frames is compared, but the bytes of all frames are counted.
    const COMPARED: usize = 6;
    let pixels = FrameSize::new(u32::from(size.width), 2 * u32::from(size.height));
    let mut frame = Frame::new(pixels.expect("a picture has cells"), PixelAspect::SQUARE);
    let mut renderer = Renderer::new();
    let mut view = View::default();
    let mut runs = METHODS.map(|(_, ink)| MethodRun::new(size, ink));
    let mut truth = Vec::new();
    walk(game, frames_per_second, |frames, game| {
        let camera = game.camera(FieldOfView::default());
        renderer.render(game.world(), &camera, &mut frame);
        let is_compared = frames % COMPARED == 0;
        if is_compared {
            let light: Vec<_> = frame.rows().flatten().map(|&pixel| linear(pixel)).collect();
            truth = blurred(&light, frame.width() as usize, DEVIATION);
        }
        let truth = is_compared.then_some(&*truth);
        for run in &mut runs {
            run.take(truth, |ink, buffer| match ink {
                None => draw_nearest(depth, &frame, buffer),
                Some(ink) => FirstPerson::new(game.world(), &camera)
                    .color_depth(depth)
                    .shade_ink(ink)
                    .render(buffer.area, buffer, &mut view),
            });
        }
    });
    runs.map(MethodRun::figures)
}

/// Draws a frame in the nearest palette colours.
fn draw_nearest(depth: ColorDepth, frame: &Frame, buffer: &mut Buffer) {
    let nearest = |pixel| match depth {
        ColorDepth::Indexed16 => Color::Indexed(nearest_of_16(pixel)),
        _ => Color::Indexed(nearest_of_256(pixel)),
    };
    for (y, upper) in (0..buffer.area.height).zip((0..).step_by(2)) {
        let halves = frame.row(upper).zip(frame.row(upper + 1));
        buffer.draw_halves(0, y, halves.map(|(top, bottom)| [top, bottom].map(nearest)));
    }
}

/// A method and its totals.
struct MethodRun {
    ink: Option<ShadeInk>,
    buffer: Buffer,
    writer: CellWriter<Vec<u8>>,
    /// The bytes of each frame.
    bytes: Vec<usize>,
    /// The mean error, chroma error and lightness of each compared frame.
    errors: Vec<[f64; 3]>,
    changes: usize,
}

impl MethodRun {
    fn new(size: Size, ink: Option<ShadeInk>) -> Self {
        Self {
            ink,
            buffer: Buffer::empty(Rect::from(size)),
            writer: CellWriter::new(Vec::new(), size),
            bytes: Vec::new(),
            errors: Vec::new(),
            changes: 0,
        }
    }

    fn take(&mut self, truth: Option<&[Oklab]>, draw: impl FnOnce(Option<ShadeInk>, &mut Buffer)) {
        let before = self.buffer.clone();
        draw(self.ink, &mut self.buffer);
        let is_shade = |cell: &Cell| "░▒▓".contains(cell.symbol());
        if !self.bytes.is_empty() {
            let pairs = before.content().iter().zip(self.buffer.content());
            self.changes += pairs.filter(|(one, other)| is_shade(one) != is_shade(other)).count();
        }
        let buffer = &self.buffer;
        self.writer.draw_frame(|screen| {
            for (position, cell) in buffer.area.positions().zip(buffer.content()) {
                let character = cell.symbol().chars().next().unwrap_or(' ');
                screen.draw_character(position.x, position.y, character, [cell.fg, cell.bg]);
            }
        });
        // Writing to memory cannot fail.
        _ = Backend::flush(&mut self.writer);
        self.bytes.push(self.writer.output_mut().drain(..).len());
        if let Some(truth) = truth {
            self.errors.push(errors(&shown(&self.buffer, self.ink), truth));
        }
    }

    /// The errors of the first picture, the error of all compared pictures, the share of cells that
    /// change between a block and a shade from one frame to the next, and the mean bytes per frame
    /// without the first frame.
    fn figures(self) -> [f64; 6] {
        let later = self.bytes.get(1..).unwrap_or_default();
        let count = later.len().max(1) as f64;
        let cells = self.buffer.content().len() as f64;
        let [error, chroma, lightness] = self.errors[0];
        let sum: f64 = self.errors.iter().map(|errors| errors[0]).sum();
        let mean = sum / self.errors.len() as f64;
        let bytes = later.iter().sum::<usize>() as f64 / count;
        [error, chroma, lightness, mean, self.changes as f64 / cells / count, bytes]
    }
}

/// The cells as the eye sees them.
fn shown(buffer: &Buffer, ink: Option<ShadeInk>) -> Vec<Oklab> {
    let width = usize::from(buffer.area.width);
    let mut light = Vec::with_capacity(2 * buffer.content().len());
    for row in buffer.content().chunks_exact(width) {
        for half in [0, 1] {
            light.extend(row.iter().map(|cell| half_of(cell, half, ink)));
        }
    }
    blurred(&light, width, DEVIATION)
}

/// The light of a half of a cell.
fn half_of(cell: &Cell, half: usize, ink: Option<ShadeInk>) -> [f64; 3] {
    let [text, ground] = [cell.fg, cell.bg].map(|it| rgb_of(it).unwrap_or(Rgb::BLACK));
    let share = match (cell.symbol(), half) {
        ("▀", 0) | ("▄", 1) | ("█", _) => 1.0,
        ("░", _) => 0.25,
        ("▒", _) => 0.5,
        ("▓", _) => 0.75,
        _ => 0.0,
    };
    let between = |one: f64, other: f64| other + share * (one - other);
    if ink == Some(ShadeInk::Flat) {
        let [text, ground] = [text, ground].map(|color| color.channels().map(f64::from));
        let [red, green, blue] = [0, 1, 2].map(|i| between(text[i], ground[i]).round() as u8);
        linear(Rgb::new(red, green, blue))
    } else {
        let [text, ground] = [text, ground].map(linear);
        [0, 1, 2].map(|i| between(text[i], ground[i]))
    }
}

/// The mean error, the mean error of the red–green and yellow–blue components alone, and the mean
/// excess of lightness.
fn errors(shown: &[Oklab], truth: &[Oklab]) -> [f64; 3] {
    let mean = |value: fn([f64; 3]) -> f64| {
        let pairs = shown.iter().zip(truth);
        let values =
            pairs.map(|(one, other)| value(std::array::from_fn(|i| one.0[i] - other.0[i])));
        values.sum::<f64>() / truth.len() as f64
    };
    [
        mean(|[l, a, b]| libm::sqrt(l * l + a * a + b * b)),
        mean(|[_, a, b]| libm::hypot(a, b)),
        mean(|[l, _, _]| l),
    ]
}

/// The standard deviation of the blur, in pixels.
const DEVIATION: [f64; 2] = [0.6; 2];

#[cfg(test)]
mod tests {
    use super::*;
    use cellcaster::map::builtin;

    #[test]
    fn finer_glyphs_reduce_errors_and_lower_fidelities_reduce_bytes() {
        let level = builtin::LEVELS.iter().find(|level| level.name == "cellar").unwrap();
        let rate = NonZeroU32::new(5).unwrap();
        let table = report_glyphs(Size::new(40, 12), rate, [level.world().unwrap()]);
        let figure = |row: &Row, column: usize| row.values[column].number();
        let of_each: Vec<&[Row]> = table.rows.chunks(FIDELITIES.len()).collect();
        assert!(of_each.is_sorted_by(|coarse, fine| figure(&coarse[0], 1) > figure(&fine[0], 1)));
        for rows in of_each {
            assert!(rows.is_sorted_by(|one, other| figure(one, 0) > figure(other, 0)), "{rows:?}");
            assert!(rows.is_sorted_by(|one, other| figure(one, 1) < figure(other, 1)), "{rows:?}");
        }
    }
}
