//! Error against bytes, for ways to choose among few colours.
//!
//! A tour is walked through each level, and every frame of it is drawn in a small palette by each method. Compared with the frame in
//! true colour are the two as they are seen at arm's length: the light of each window of 2×2 cells, which is
//! 2×4 pixels, is averaged, and the error is the distance of the averages in Oklab. Nearest colours do best pixel by pixel, so an error
//! without such a blur could not tell a wall without hue from one with it.
//!
//! What has an Oklab chroma below [`GREY`] counts as grey: about what people can just tell from it.

mod methods;
mod view;

use std::num::NonZeroU32;

use ratatui::backend::Backend;
use ratatui::layout::Size;
use ratatui::style::Color;

use crate::canvas::Canvas;
use crate::color::palette::{ColorDepth, of_256};
use crate::color::srgb::linear;
use crate::game::{Game, STEPS_PER_SECOND, Script};
use crate::map::builtin;
use crate::render::{Frame, FrameSize, PixelAspect, Renderer};
use crate::terminal::CellWriter;
use crate::world::{Camera, FieldOfView};
use methods::{Method, method};
use view::Seen;

/// Chroma in Oklab, below which a colour counts as grey.
pub const GREY: f64 = 0.02;

/// What is walked in each level.
const TOUR: &str = "\
[tour]
1 s    forward
1 s    turn-left
0.5 s  forward turn-right
1 s    turn-right aim
0.5 s  strafe-left
";

/// One in so many frames is compared; the bytes of all are counted.
const COMPARED: usize = 6;

/// What to measure.
#[derive(Clone, Copy, Debug)]
pub struct PalettePlan {
    /// The palette: 256 or 16 colours.
    pub depth: ColorDepth,
    /// The size of the picture, in cells.
    pub size: Size,
    /// How many frames a second are sent.
    pub frames_per_second: NonZeroU32,
}

/// What was measured of one method in one level.
#[derive(Clone, Debug, PartialEq)]
pub struct PaletteRow {
    /// The level's name; `all` for all of them.
    pub level: String,
    /// What the method is called; the first of a level is `nearest`, and `mixed` is what is played.
    pub method: &'static str,
    /// How much of the blurred picture is grey, from 0 to 1.
    pub grey: f64,
    /// How much of it is grey in true colour.
    pub true_grey: f64,
    /// How much of the pixels is grey before they are blurred.
    pub grey_pixels: f64,
    /// The mean distance of what is seen, in Oklab.
    pub error: f64,
    /// That over the one of `nearest`.
    pub error_ratio: f64,
    /// How many bytes a frame takes, in the mean, the first not counted.
    pub bytes: f64,
    /// That over those of `nearest`.
    pub bytes_ratio: f64,
}

/// Walks the tour through all built-in levels and measures.
///
/// # Panics
/// Where the plan's size has no cells.
pub fn report_palettes(plan: &PalettePlan) -> Vec<PaletteRow> {
    let mut rows: Vec<PaletteRow> = builtin::LEVELS
        .iter()
        .filter_map(|level| Some((level.name, level.world().ok()?)))
        .flat_map(|(name, world)| report_level(plan, name, Game::new(world)))
        .collect();
    let total = total(&rows);
    rows.extend(total);
    rows
}

fn report_level(plan: &PalettePlan, name: &str, mut game: Game) -> Vec<PaletteRow> {
    let script = Script::parse(TOUR, "tour").unwrap_or_else(|faults| unreachable!("{faults}"));
    let size = FrameSize::new(u32::from(plan.size.width), 2 * u32::from(plan.size.height));
    let mut frame = Frame::new(size.expect("a picture has cells"), PixelAspect::SQUARE);
    let mut renderer = Renderer::new();
    let mut trials: Vec<Trial> =
        methods::NAMES.iter().map(|&name| Trial::new(name, plan)).collect();
    let mut truth = Seen::default();
    let mut is_due = true;
    let mut frames = 0;
    let mut steps = 0;
    let mut intents = script.iter().map(|(_, intents)| intents);
    loop {
        if is_due {
            let camera = game.camera(FieldOfView::default());
            renderer.render(game.world(), &camera, &mut frame);
            let pixels = frame.rows().flatten().copied();
            let is_compared = frames % COMPARED == 0;
            if is_compared {
                truth.look(frame.width() as usize, pixels.map(linear));
            }
            for trial in &mut trials {
                trial.take(&game, &camera, &frame, is_compared.then_some(&truth));
            }
            frames += 1;
        }
        let Some(intents) = intents.next() else { break };
        game.step(intents);
        let before = steps * u64::from(plan.frames_per_second.get()) / u64::from(STEPS_PER_SECOND);
        steps += 1;
        let after = steps * u64::from(plan.frames_per_second.get()) / u64::from(STEPS_PER_SECOND);
        is_due = after > before;
    }
    let mut rows: Vec<PaletteRow> = Vec::new();
    for trial in trials {
        let row = trial.finish(name, truth.share_of_grey(), rows.first());
        rows.push(row);
    }
    rows
}

/// The means of all levels, a row for each method.
fn total(rows: &[PaletteRow]) -> Vec<PaletteRow> {
    let mut totals: Vec<PaletteRow> = Vec::new();
    for &method in methods::NAMES {
        let of_method: Vec<&PaletteRow> = rows.iter().filter(|row| row.method == method).collect();
        let mean = |value: fn(&PaletteRow) -> f64| {
            of_method.iter().map(|row| value(row)).sum::<f64>() / of_method.len().max(1) as f64
        };
        let (error, bytes) = (mean(|row| row.error), mean(|row| row.bytes));
        let (first_error, first_bytes) =
            totals.first().map_or((error, bytes), |first| (first.error, first.bytes));
        totals.push(PaletteRow {
            level: "all".to_owned(),
            method,
            grey: mean(|row| row.grey),
            true_grey: mean(|row| row.true_grey),
            grey_pixels: mean(|row| row.grey_pixels),
            error,
            error_ratio: error / first_error,
            bytes,
            bytes_ratio: bytes / first_bytes,
        });
    }
    totals
}

/// A method at work, and what it has come to so far.
struct Trial {
    name: &'static str,
    method: Box<dyn Method>,
    writer: CellWriter<Vec<u8>>,
    indices: Vec<u8>,
    /// Of each frame.
    bytes: Vec<usize>,
    seen: Seen,
    error: f64,
    windows: usize,
}

impl Trial {
    fn new(name: &'static str, plan: &PalettePlan) -> Self {
        Self {
            name,
            method: method(name, plan.depth),
            writer: CellWriter::new(Vec::new(), plan.size),
            indices: Vec::new(),
            bytes: Vec::new(),
            seen: Seen::default(),
            error: 0.0,
            windows: 0,
        }
    }

    fn take(&mut self, game: &Game, camera: &Camera, frame: &Frame, truth: Option<&Seen>) {
        self.indices.clear();
        self.method.draw(game.world(), camera, frame, &mut self.indices);
        let width = frame.width() as usize;
        let indices = &self.indices;
        self.writer.draw_frame(|screen| {
            for (y, rows) in (0..).zip(indices.chunks_exact(2 * width)) {
                let (upper, lower) = rows.split_at(width);
                let halves = upper.iter().zip(lower);
                let halves = halves.map(|(&top, &bottom)| [top, bottom].map(Color::Indexed));
                screen.draw_halves(0, y, halves);
            }
        });
        // Memory takes everything.
        _ = Backend::flush(&mut self.writer);
        self.bytes.push(self.writer.output_mut().drain(..).len());
        if let Some(truth) = truth {
            let light = |&index: &u8| linear(of_256(index));
            self.seen.look(width, self.indices.iter().map(light));
            self.error += self.seen.distances(truth).sum::<f64>();
            self.windows += self.seen.windows();
        }
    }

    fn finish(self, level: &str, true_grey: f64, first: Option<&PaletteRow>) -> PaletteRow {
        let later = self.bytes.get(1..).unwrap_or_default();
        let bytes = later.iter().sum::<usize>() as f64 / later.len().max(1) as f64;
        let error = self.error / self.windows.max(1) as f64;
        PaletteRow {
            level: level.to_owned(),
            method: self.name,
            grey: self.seen.share_of_grey(),
            true_grey,
            grey_pixels: self.seen.share_of_grey_pixels(),
            error,
            error_ratio: error / first.map_or(error, |first| first.error),
            bytes,
            bytes_ratio: bytes / first.map_or(bytes, |first| first.bytes),
        }
    }
}
