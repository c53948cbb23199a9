//! The whole pipeline: from a player's intents to the bytes for the terminal.
//!
//! Several games play the same script, each with its own encoder. They take turns frame by frame,
//! so that a busy machine slows all of them.

use std::time::{Duration, Instant};

use ratatui::backend::{Backend, CrosstermBackend};
use ratatui::layout::Size;
use ratatui::{Terminal, TerminalOptions, Viewport};

use super::encoder::Sink;
use crate::speed::median;
use cellcaster::app::Replay;
use cellcaster::game::{Intents, STEPS_PER_SECOND, Script};
use cellcaster::terminal::{CellWriter, Fidelity};

/// The results of one encoder in a window of one size.
#[derive(Clone, Debug, PartialEq)]
pub struct PipelineRow {
    /// The window, in cells.
    pub size: Size,
    /// The encoder's name: `stock`, or a fidelity.
    pub encoder: String,
    /// The number of frames, without the first.
    pub frames: usize,
    /// The median time of a frame: two steps of the game, drawing, and encoding.
    pub time: Duration,
    /// The mean number of bytes per frame.
    pub bytes: f64,
}

/// The number of frames drawn per second.
const FRAMES_PER_SECOND: u32 = 30;
const STEPS_A_FRAME: usize = (STEPS_PER_SECOND / FRAMES_PER_SECOND) as usize;
/// The least number of steps played of a stretch that has as many.
const FEWEST_STEPS: u32 = 4;

/// Plays `script` in games that `begin` creates, in a window of `size`: as much of each stretch as
/// `time` allows. The first row is ratatui's own encoder; the others are Cellcaster's at the named
/// fidelities.
///
/// # Errors
/// Returns the first error of `begin`.
pub fn measure_pipeline<E>(
    script: &Script,
    size: Size,
    time: Duration,
    mut begin: impl FnMut(Size) -> Result<Replay, E>,
) -> Result<Vec<PipelineRow>, E> {
    let mut playbacks = Vec::new();
    let stock = Stock::new(size);
    playbacks.push(Playback::new("stock".to_owned(), begin(size)?, Box::new(stock)));
    for fidelity in [Fidelity::EXACT, Fidelity::HIGH, Fidelity::LOW] {
        let mut writer = CellWriter::new(Sink::default(), size);
        writer.set_fidelity(fidelity);
        playbacks.push(Playback::new(fidelity.to_string(), begin(size)?, Box::new(writer)));
    }
    let begun = Instant::now();
    for playback in &mut playbacks {
        playback.play(&[]);
        playback.reset();
    }
    // The first frame, which paints everything, takes longer than most.
    let affordable = time.as_secs_f64() / begun.elapsed().as_secs_f64().max(f64::MIN_POSITIVE);
    let wanted = shortened(script, affordable as usize * STEPS_A_FRAME);
    for steps in wanted.chunks_exact(STEPS_A_FRAME) {
        for playback in &mut playbacks {
            playback.play(steps);
        }
    }
    Ok(playbacks.into_iter().map(|playback| playback.finish(size)).collect())
}

/// The intents of `script` for each step, or the same fraction of each of its stretches, for a
/// total of about `most` steps.
fn shortened(script: &Script, most: usize) -> Vec<Intents> {
    let share = script.iter().count().div_ceil(most.max(1)) as u32;
    let stretches = script.sections().iter().flat_map(|section| &section.stretches);
    let steps = stretches.flat_map(|stretch| {
        let count = stretch.steps.div_ceil(share.max(1)).max(FEWEST_STEPS).min(stretch.steps);
        std::iter::repeat_n(stretch.intents, count as usize)
    });
    steps.collect()
}

/// A game and its screen.
struct Playback {
    name: String,
    replay: Replay,
    screen: Box<dyn Screen>,
    times: Vec<f64>,
    bytes: usize,
}

impl Playback {
    fn new(name: String, replay: Replay, screen: Box<dyn Screen>) -> Self {
        Self { name, replay, screen, times: Vec::new(), bytes: 0 }
    }

    /// Plays `steps`, and shows the result.
    fn play(&mut self, steps: &[Intents]) {
        let start = Instant::now();
        for &intents in steps {
            self.replay.step(intents);
        }
        let bytes = self.screen.show(&mut self.replay);
        self.times.push(start.elapsed().as_secs_f64());
        self.bytes += bytes;
    }

    fn reset(&mut self) {
        self.times.clear();
        self.bytes = 0;
    }

    fn finish(self, size: Size) -> PipelineRow {
        let frames = self.times.len();
        PipelineRow {
            size,
            encoder: self.name,
            frames,
            time: Duration::from_secs_f64(median(self.times)),
            bytes: self.bytes as f64 / frames.max(1) as f64,
        }
    }
}

/// A screen that shows a game, and returns the number of bytes sent.
trait Screen {
    fn show(&mut self, replay: &mut Replay) -> usize;
}

/// Ratatui's terminal with its own encoder.
struct Stock {
    terminal: Terminal<CrosstermBackend<Sink>>,
    sink: Sink,
}

impl Stock {
    fn new(size: Size) -> Self {
        let sink = Sink::default();
        // With a fixed viewport, ratatui does not query the size.
        let viewport = Viewport::Fixed(size.into());
        let backend = CrosstermBackend::new(sink.clone());
        let terminal = Terminal::with_options(backend, TerminalOptions { viewport });
        Self { terminal: terminal.expect("there is nothing to ask of a sink"), sink }
    }
}

impl Screen for Stock {
    fn show(&mut self, replay: &mut Replay) -> usize {
        // Writing to a sink cannot fail.
        _ = self.terminal.draw(|frame| replay.draw(frame.buffer_mut()));
        self.sink.drain()
    }
}

impl Screen for CellWriter<Sink> {
    fn show(&mut self, replay: &mut Replay) -> usize {
        self.draw_frame(|screen| replay.draw(screen));
        _ = Backend::flush(self);
        self.output_mut().drain()
    }
}
