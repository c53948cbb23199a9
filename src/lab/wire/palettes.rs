//! Bytes and colour errors of methods to choose colours from a small palette.
//!
//! A script walks through each level, and each method draws every frame in a small palette. The
//! result is compared with the frame in true colour as both appear from a distance: the linear
//! light of each window of 2×2 cells, which are 2×4 pixels, is averaged, and the error is the
//! distance of the averages in Oklab. Choosing the nearest colour has the least error for each
//! pixel, so that an error without such a blur could not tell a wall without hue from one with it.
//!
//! A colour with an Oklab chroma below [`GREY`] counts as grey: people can just tell such a colour
//! from grey.

mod blur;
mod methods;

use std::num::NonZeroU32;

use ratatui::backend::Backend;
use ratatui::layout::Size;
use ratatui::style::Color;

use crate::canvas::Canvas;
use crate::color::palette::{ColorDepth, of_256};
use crate::color::srgb::linear;
use crate::game::{Game, STEPS_PER_SECOND, Script};
use crate::render::{Frame, FrameSize, PixelAspect, Renderer};
use crate::terminal::CellWriter;
use crate::world::{Camera, FieldOfView, World};
use blur::BlurredPicture;
use methods::{Method, method};

/// The Oklab chroma below which a colour counts as grey.
pub const GREY: f64 = 0.02;

/// The script for each level.
const TOUR: &str = "\
[tour]
1 s    forward
1 s    turn-left
0.5 s  forward turn-right
1 s    turn-right aim
0.5 s  strafe-left
";

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

/// The results of one method in one level.
#[derive(Clone, Debug, PartialEq)]
pub struct PaletteRow {
    /// The level's name; `all` for all of them.
    pub level: String,
    /// The method's name. The first row of a level is `nearest`; the game uses `mixed`.
    pub method: &'static str,
    /// The grey fraction of the blurred picture, from 0 to 1.
    pub grey: f64,
    /// The grey fraction of the blurred picture in true colour.
    pub true_grey: f64,
    /// The grey fraction of the pixels before the blur.
    pub grey_pixels: f64,
    /// The mean error of the blurred picture, in Oklab.
    pub error: f64,
    /// The ratio of the error to that of `nearest`.
    pub error_ratio: f64,
    /// The mean number of bytes per frame, without the first.
    pub bytes: f64,
    /// The ratio of the bytes to those of `nearest`.
    pub bytes_ratio: f64,
}

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
    let total = total(&rows);
    rows.extend(total);
    rows
}

fn report_level(plan: &PalettePlan, name: &str, mut game: Game) -> Vec<PaletteRow> {
    let script = Script::parse(TOUR, "tour").unwrap_or_else(|faults| unreachable!("{faults}"));
    let size = FrameSize::new(u32::from(plan.size.width), 2 * u32::from(plan.size.height));
    let mut frame = Frame::new(size.expect("a picture has cells"), PixelAspect::SQUARE);
    let mut renderer = Renderer::new();
    let mut runs: Vec<MethodRun> =
        methods::NAMES.iter().map(|&name| MethodRun::new(name, plan)).collect();
    let mut truth = BlurredPicture::default();
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
                truth.add(frame.width() as usize, pixels.map(linear));
            }
            for run in &mut runs {
                run.take(&game, &camera, &frame, is_compared.then_some(&truth));
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
    for run in runs {
        let row = run.finish(name, truth.share_of_grey(), rows.first());
        rows.push(row);
    }
    rows
}

/// The means over all levels, one row for each method.
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

/// A method and its sums so far.
struct MethodRun {
    name: &'static str,
    method: Box<dyn Method>,
    writer: CellWriter<Vec<u8>>,
    indices: Vec<u8>,
    /// The bytes of each frame.
    bytes: Vec<usize>,
    blurred: BlurredPicture,
    error: f64,
    windows: usize,
}

impl MethodRun {
    fn new(name: &'static str, plan: &PalettePlan) -> Self {
        Self {
            name,
            method: method(name, plan.depth),
            writer: CellWriter::new(Vec::new(), plan.size),
            indices: Vec::new(),
            bytes: Vec::new(),
            blurred: BlurredPicture::default(),
            error: 0.0,
            windows: 0,
        }
    }

    fn take(
        &mut self,
        game: &Game,
        camera: &Camera,
        frame: &Frame,
        truth: Option<&BlurredPicture>,
    ) {
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
        // Writing to memory cannot fail.
        _ = Backend::flush(&mut self.writer);
        self.bytes.push(self.writer.output_mut().drain(..).len());
        if let Some(truth) = truth {
            let light = |&index: &u8| linear(of_256(index));
            self.blurred.add(width, self.indices.iter().map(light));
            self.error += self.blurred.distances(truth).sum::<f64>();
            self.windows += self.blurred.windows();
        }
    }

    fn finish(self, level: &str, true_grey: f64, first: Option<&PaletteRow>) -> PaletteRow {
        let later = self.bytes.get(1..).unwrap_or_default();
        let bytes = later.iter().sum::<usize>() as f64 / later.len().max(1) as f64;
        let error = self.error / self.windows.max(1) as f64;
        PaletteRow {
            level: level.to_owned(),
            method: self.name,
            grey: self.blurred.share_of_grey(),
            true_grey,
            grey_pixels: self.blurred.share_of_grey_pixels(),
            error,
            error_ratio: error / first.map_or(error, |first| first.error),
            bytes,
            bytes_ratio: bytes / first.map_or(bytes, |first| first.bytes),
        }
    }
}
