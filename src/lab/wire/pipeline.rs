//! The whole pipeline: from what a player wants to the bytes that the terminal gets.
//!
//! A script is played by several games at once, each with an encoder of its own, and they take their
//! turns frame by frame: a machine that is busy slows all of them down.

use std::time::{Duration, Instant};

use ratatui::backend::{Backend, CrosstermBackend};
use ratatui::layout::Size;
use ratatui::{Terminal, TerminalOptions, Viewport};

use super::encoder::Sink;
use crate::app::Replay;
use crate::game::{Intents, STEPS_PER_SECOND, Script};
use crate::lab::speed::median;
use crate::terminal::{CellWriter, Fidelity};

/// What was measured of one encoder in a window of one size.
#[derive(Clone, Debug, PartialEq)]
pub struct PipelineRow {
    /// The window, in cells.
    pub size: Size,
    /// What the encoder is called: `stock`, or a fidelity.
    pub encoder: String,
    /// How many frames were played, the first not among them.
    pub frames: usize,
    /// What a frame takes, in the median: two steps of the game, drawing, and encoding.
    pub time: Duration,
    /// What a frame takes in bytes, in the mean.
    pub bytes: f64,
}

/// How many frames a second are drawn.
const FRAMES_PER_SECOND: u32 = 30;
const STEPS_A_FRAME: usize = (STEPS_PER_SECOND / FRAMES_PER_SECOND) as usize;
/// How many steps of a stretch are played at least, if it has as many.
const FEWEST_STEPS: u32 = 4;

/// Plays `script` in games that `begin` makes, in a window of `size`: as much of
/// each stretch as there is time for.
/// The first row is ratatui's own encoder, the others are ours at the fidelities that have a name.
///
/// # Errors
/// The first that `begin` has.
pub fn measure_pipeline<E>(
    script: &Script,
    size: Size,
    time: Duration,
    mut begin: impl FnMut(Size) -> Result<Replay, E>,
) -> Result<Vec<PipelineRow>, E> {
    let mut players = Vec::new();
    let stock = Stock::new(size);
    players.push(Player::new("stock".to_owned(), begin(size)?, Box::new(stock)));
    for fidelity in [Fidelity::EXACT, Fidelity::HIGH, Fidelity::LOW] {
        let mut writer = CellWriter::new(Sink::default(), size);
        writer.set_fidelity(fidelity);
        players.push(Player::new(fidelity.to_string(), begin(size)?, Box::new(writer)));
    }
    let begun = Instant::now();
    for player in &mut players {
        player.play(&[]);
        player.forget();
    }
    // The first frame, which paints everything, takes longer than most.
    let affordable = time.as_secs_f64() / begun.elapsed().as_secs_f64().max(f64::MIN_POSITIVE);
    let wanted = shortened(script, affordable as usize * STEPS_A_FRAME);
    for steps in wanted.chunks_exact(STEPS_A_FRAME) {
        for player in &mut players {
            player.play(steps);
        }
    }
    Ok(players.into_iter().map(|player| player.finish(size)).collect())
}

/// What `script` wants step by step, or the same share of each of its stretches, so that it is about
/// `most` steps.
fn shortened(script: &Script, most: usize) -> Vec<Intents> {
    let share = script.iter().count().div_ceil(most.max(1)) as u32;
    let stretches = script.sections().iter().flat_map(|section| &section.stretches);
    let steps = stretches.flat_map(|stretch| {
        let count = stretch.steps.div_ceil(share.max(1)).max(FEWEST_STEPS).min(stretch.steps);
        std::iter::repeat_n(stretch.intents, count as usize)
    });
    steps.collect()
}

/// A game and what shows it.
struct Player {
    name: String,
    replay: Replay,
    window: Box<dyn Show>,
    times: Vec<f64>,
    bytes: usize,
}

impl Player {
    fn new(name: String, replay: Replay, window: Box<dyn Show>) -> Self {
        Self { name, replay, window, times: Vec::new(), bytes: 0 }
    }

    /// Plays so many steps, and shows what has come of it.
    fn play(&mut self, steps: &[Intents]) {
        let start = Instant::now();
        for &intents in steps {
            self.replay.step(intents);
        }
        let bytes = self.window.show(&mut self.replay);
        self.times.push(start.elapsed().as_secs_f64());
        self.bytes += bytes;
    }

    fn forget(&mut self) {
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

/// What shows a game, and tells how many bytes that took.
trait Show {
    fn show(&mut self, replay: &mut Replay) -> usize;
}

/// Ratatui's window and its own encoder.
struct Stock {
    terminal: Terminal<CrosstermBackend<Sink>>,
    sink: Sink,
}

impl Stock {
    fn new(size: Size) -> Self {
        let sink = Sink::default();
        // A window whose size is given asks nobody for it.
        let viewport = Viewport::Fixed(size.into());
        let backend = CrosstermBackend::new(sink.clone());
        let terminal = Terminal::with_options(backend, TerminalOptions { viewport });
        Self { terminal: terminal.expect("there is nothing to ask of a sink"), sink }
    }
}

impl Show for Stock {
    fn show(&mut self, replay: &mut Replay) -> usize {
        // A sink takes everything.
        _ = self.terminal.draw(|frame| replay.draw(frame.buffer_mut()));
        self.sink.drain()
    }
}

impl Show for CellWriter<Sink> {
    fn show(&mut self, replay: &mut Replay) -> usize {
        self.draw_frame(|screen| replay.draw(screen));
        _ = Backend::flush(self);
        self.output_mut().drain()
    }
}
