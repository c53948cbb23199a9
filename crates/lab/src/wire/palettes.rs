//! Bytes and colour errors of pictures in a small palette.
//!
//! A script walks through each level. Every frame is drawn in the nearest palette colours and as the
//! game draws it, and compared with the frame in true colour as both appear to the eye: the linear
//! light is blurred, and the error is the distance in Oklab. Without a blur, the nearest colours would
//! have the least error, because no pixel can be nearer.

use std::num::NonZeroU32;

use ratatui::backend::Backend;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Rect, Size};
use ratatui::style::Color;
use ratatui::widgets::StatefulWidget;

use super::seen::blurred;
use super::tour::walk;
use cellcaster::color::Rgb;
use cellcaster::color::oklab::Oklab;
use cellcaster::color::palette::{ColorDepth, ShadeInk, nearest_of_16, nearest_of_256, of_256};
use cellcaster::color::srgb::linear;
use cellcaster::game::Game;
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::terminal::CellWriter;
use cellcaster::tui::canvas::Canvas;
use cellcaster::tui::{FirstPerson, View};
use cellcaster::world::{FieldOfView, World};

/// One in this number of frames is compared; the bytes of all are counted.
const COMPARED: usize = 6;

/// The options of a measurement.
#[derive(Clone, Copy, Debug)]
pub struct PalettePlan {
    /// The palette: 256 or 16 colours.
    pub depth: ColorDepth,
    /// The size of the picture, in cells.
    pub size: Size,
    /// The number of frames sent per second.
    pub frames_per_second: NonZeroU32,
}

/// The results of one method in one level. The errors are means over all pixels, in Oklab.
#[derive(Clone, Debug, PartialEq)]
pub struct PaletteRow {
    /// The level's name; `all` for the mean of all levels.
    pub level: String,
    /// `nearest` for the nearest colours. Otherwise the game's mixtures, for a terminal that draws
    /// shades as `dots`, as `flat` colours, or as is `unknown` to the game: as dots.
    pub method: &'static str,
    /// The error of the level's first picture.
    pub start_error: f64,
    /// The error of the first picture in its red–green and yellow–blue components alone.
    pub start_chroma_error: f64,
    /// How much lighter the first picture is than in true colour.
    pub start_lightness: f64,
    /// The error of all compared pictures.
    pub error: f64,
    /// The share of cells that change between a block and a shade, from one frame to the next.
    pub changes: f64,
    /// The mean number of bytes per frame, without the first.
    pub bytes: f64,
}

/// The names of the methods. The game's have the kind of shades for which they mix.
const METHODS: [(&str, Option<ShadeInk>); 4] = [
    ("nearest", None),
    ("dots", Some(ShadeInk::Dots)),
    ("flat", Some(ShadeInk::Flat)),
    ("unknown", Some(ShadeInk::Unknown)),
];

/// Walks through each of `levels`, which have a name, and measures.
///
/// # Panics
/// Panics if the plan's size has no cells.
pub fn report_palettes<'a>(
    plan: &PalettePlan,
    levels: impl IntoIterator<Item = (&'a str, World)>,
) -> Vec<PaletteRow> {
    let mut rows: Vec<PaletteRow> = levels
        .into_iter()
        .flat_map(|(name, world)| report_level(plan, name, Game::new(world)))
        .collect();
    let means = METHODS.map(|(method, _)| mean(method, &rows));
    rows.extend(means);
    rows
}

fn report_level(plan: &PalettePlan, level: &str, game: Game) -> Vec<PaletteRow> {
    let size = FrameSize::new(u32::from(plan.size.width), 2 * u32::from(plan.size.height));
    let mut frame = Frame::new(size.expect("a picture has cells"), PixelAspect::SQUARE);
    let mut renderer = Renderer::new();
    let mut view = View::default();
    let mut runs = METHODS.map(|(_, ink)| MethodRun::new(plan, ink));
    let mut truth = Vec::new();
    walk(game, plan.frames_per_second, |frames, game| {
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
                None => draw_nearest(plan.depth, &frame, buffer),
                Some(ink) => FirstPerson::new(game.world(), &camera)
                    .color_depth(plan.depth)
                    .shade_ink(ink)
                    .render(buffer.area, buffer, &mut view),
            });
        }
    });
    let runs = runs.into_iter().zip(METHODS);
    runs.map(|(run, (name, _))| run.finish(level, name)).collect()
}

/// The mean of a method's rows.
fn mean(method: &'static str, rows: &[PaletteRow]) -> PaletteRow {
    let rows: Vec<&PaletteRow> = rows.iter().filter(|row| row.method == method).collect();
    let mean = |value: fn(&PaletteRow) -> f64| {
        rows.iter().map(|row| value(row)).sum::<f64>() / rows.len().max(1) as f64
    };
    PaletteRow {
        level: "all".to_owned(),
        method,
        start_error: mean(|row| row.start_error),
        start_chroma_error: mean(|row| row.start_chroma_error),
        start_lightness: mean(|row| row.start_lightness),
        error: mean(|row| row.error),
        changes: mean(|row| row.changes),
        bytes: mean(|row| row.bytes),
    }
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

/// A method and its sums so far.
struct MethodRun {
    ink: Option<ShadeInk>,
    buffer: Buffer,
    writer: CellWriter<Vec<u8>>,
    /// The bytes of each frame.
    bytes: Vec<usize>,
    /// The errors of each compared frame.
    errors: Vec<Errors>,
    changes: usize,
}

/// The mean errors of a picture, as in [`PaletteRow`].
#[derive(Clone, Copy)]
struct Errors {
    error: f64,
    chroma: f64,
    lightness: f64,
}

impl MethodRun {
    fn new(plan: &PalettePlan, ink: Option<ShadeInk>) -> Self {
        Self {
            ink,
            buffer: Buffer::empty(Rect::from(plan.size)),
            writer: CellWriter::new(Vec::new(), plan.size),
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

    fn finish(self, level: &str, method: &'static str) -> PaletteRow {
        let later = self.bytes.get(1..).unwrap_or_default();
        let count = later.len().max(1) as f64;
        let cells = self.buffer.content().len() as f64;
        let start = self.errors[0];
        let sum: f64 = self.errors.iter().map(|errors| errors.error).sum();
        PaletteRow {
            level: level.to_owned(),
            method,
            start_error: start.error,
            start_chroma_error: start.chroma,
            start_lightness: start.lightness,
            error: sum / self.errors.len() as f64,
            changes: self.changes as f64 / cells / count,
            bytes: later.iter().sum::<usize>() as f64 / count,
        }
    }
}

/// What the eye sees of the cells.
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
    let color = |color| if let Color::Indexed(index) = color { of_256(index) } else { Rgb::BLACK };
    let [text, ground] = [cell.fg, cell.bg].map(color);
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

fn errors(shown: &[Oklab], truth: &[Oklab]) -> Errors {
    let mean = |value: fn([f64; 3]) -> f64| {
        let pairs = shown.iter().zip(truth);
        let values =
            pairs.map(|(one, other)| value(std::array::from_fn(|i| one.0[i] - other.0[i])));
        values.sum::<f64>() / truth.len() as f64
    };
    Errors {
        error: mean(|[l, a, b]| libm::sqrt(l * l + a * a + b * b)),
        chroma: mean(|[_, a, b]| libm::hypot(a, b)),
        lightness: mean(|[l, _, _]| l),
    }
}

/// The standard deviation of the blur, in pixels.
const DEVIATION: [f64; 2] = [0.6; 2];
