//! The whole pipeline: from a player's intents to the bytes for the terminal.
//!
//! Several games play the same script, each with its own encoder. They take turns frame by frame,
//! so that a busy machine slows all of them.

use std::time::{Duration, Instant};

use ratatui::backend::{Backend, CrosstermBackend};
use ratatui::layout::Size;
use ratatui::{Terminal, TerminalOptions, Viewport};

use super::showcase;
use crate::report::{Diagram, Row, Table, Value, headings, median};
use crate::wire::Sink;
use cellcaster::app::Replay;
use cellcaster::cli::Error;
use cellcaster::cli::replay::SHOWCASE;
use cellcaster::game::{Intents, STEPS_PER_SECOND, Script};
use cellcaster::terminal::{CellWriter, Fidelity};

/// The windows that are measured.
const WINDOWS: [Size; 2] = [Size::new(80, 24), Size::new(200, 60)];
/// The speeds of the links for which frame rates are reported, in megabits per second.
const LINKS: [f64; 3] = [1.0, 10.0, 100.0];
/// The number of frames drawn per second.
const FRAMES_PER_SECOND: u32 = 30;
const STEPS_A_FRAME: usize = (STEPS_PER_SECOND / FRAMES_PER_SECOND) as usize;
/// The smallest number of steps played of each stretch, unless the stretch is shorter.
const MIN_STEPS: u32 = 4;

/// Plays the showcase in each window, with ratatui's own encoder (`stock`) and with Cellcaster's at
/// the named fidelities. Plays as much of each stretch as `time` allows.
pub(crate) fn measure_pipeline(time: Duration) -> Result<Table, Error> {
    let script = SHOWCASE.script()?;
    let mut rows = Vec::new();
    for size in WINDOWS {
        rows.extend(measure(&script, size, time / WINDOWS.len() as u32)?);
    }
    Ok(Table {
        name: "pipeline",
        title: "A frame from the player's intents to bytes, compared with ratatui's own encoder (stock),\n\
                and the frames a second over a link of 1, 10 and 100 Mbit/s"
            .to_owned(),
        keys: ["", "encoder", "window"],
        columns: headings([
            "cells",
            "frames",
            "time, µs/frame",
            "time/stock",
            "bytes",
            "1 Mbit/s",
            "10 Mbit/s",
            "100 Mbit/s",
        ]),
        rows,
        diagrams: vec![Diagram { columns: [0, 2], range: Diagram::ALL }],
    })
}

/// The rows of one window.
fn measure(script: &Script, size: Size, time: Duration) -> Result<Vec<Row>, Error> {
    let mut playbacks =
        vec![Playback::new("stock".to_owned(), showcase(size)?, stock_screen(size))];
    for fidelity in [Fidelity::EXACT, Fidelity::HIGH, Fidelity::LOW] {
        let screen = screen(size, fidelity);
        playbacks.push(Playback::new(fidelity.to_string(), showcase(size)?, screen));
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
    let stock = median(playbacks[0].times.clone()).max(f64::MIN_POSITIVE);
    Ok(playbacks.into_iter().map(|playback| playback.row(size, stock)).collect())
}

/// The intents of `script` for each step, or the same fraction of each of its stretches, for a
/// total of about `most` steps.
fn shortened(script: &Script, most: usize) -> Vec<Intents> {
    let share = script.iter().count().div_ceil(most.max(1)) as u32;
    let stretches = script.sections().iter().flat_map(|section| &section.stretches);
    let steps = stretches.flat_map(|stretch| {
        let count = stretch.steps.div_ceil(share.max(1)).max(MIN_STEPS).min(stretch.steps);
        std::iter::repeat_n(stretch.intents, count as usize)
    });
    steps.collect()
}

/// A game and its screen.
struct Playback {
    name: String,
    replay: Replay,
    screen: Screen,
    times: Vec<f64>,
    bytes: usize,
}

impl Playback {
    fn new(name: String, replay: Replay, screen: Screen) -> Self {
        Self { name, replay, screen, times: Vec::new(), bytes: 0 }
    }

    /// Plays `steps`, and shows the result.
    fn play(&mut self, steps: &[Intents]) {
        let start = Instant::now();
        for &intents in steps {
            self.replay.step(intents);
        }
        let bytes = (self.screen)(&mut self.replay);
        self.times.push(start.elapsed().as_secs_f64());
        self.bytes += bytes;
    }

    fn reset(&mut self) {
        self.times.clear();
        self.bytes = 0;
    }

    /// The row of this encoder. `stock` is the time of ratatui's encoder.
    fn row(self, size: Size, stock: f64) -> Row {
        let frames = self.times.len();
        let time = median(self.times);
        let bytes = self.bytes as f64 / frames.max(1) as f64;
        // The time to draw also limits the rate.
        let rate = |megabits: f64| (bytes * 8.0 / (megabits * 1e6)).max(time).recip();
        let mut values = vec![
            Value::Count(size.area().into()),
            Value::Count(frames as u64),
            Value::Number(time * 1e6),
            Value::Number(time / stock),
            Value::Count(bytes.round() as u64),
        ];
        values.extend(LINKS.map(|link| Value::Number(rate(link))));
        Row::new(["", &self.name, &format!("{}x{}", size.width, size.height)], values)
    }
}

/// Shows a game, and returns the number of bytes sent.
type Screen = Box<dyn FnMut(&mut Replay) -> usize>;

/// Ratatui's terminal with its own encoder.
fn stock_screen(size: Size) -> Screen {
    let sink = Sink::default();
    // With a fixed viewport, ratatui does not query the size.
    let viewport = Viewport::Fixed(size.into());
    let backend = CrosstermBackend::new(sink.clone());
    let terminal = Terminal::with_options(backend, TerminalOptions { viewport });
    let mut terminal = terminal.expect("there is nothing to ask of a sink");
    Box::new(move |replay| {
        // Writing to a sink cannot fail.
        _ = terminal.draw(|frame| replay.draw(frame.buffer_mut()));
        sink.drain()
    })
}

fn screen(size: Size, fidelity: Fidelity) -> Screen {
    let mut writer = CellWriter::new(Sink::default(), size);
    writer.set_fidelity(fidelity);
    Box::new(move |replay| {
        writer.draw_frame(|screen| replay.draw(screen));
        _ = Backend::flush(&mut writer);
        writer.output_mut().drain()
    })
}
