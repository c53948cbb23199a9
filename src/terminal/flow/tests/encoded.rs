//! Flow control together with the encoder: frames of the game over a simulated link.

use ratatui::backend::Backend;
use ratatui::layout::Size;

use super::*;
use crate::app::{Levels, Replay, Settings};
use crate::color::palette::ColorDepth;
use crate::game::{Intents, STEPS_PER_SECOND, Script};
use crate::map::builtin;
use crate::terminal::CellWriter;
use crate::tui::GlyphSet;

/// A game in which the player moves without a pause, and its encoder.
struct Game {
    replay: Replay,
    /// The intents of each step, repeated for ever.
    intents: Vec<Intents>,
    steps: usize,
    writer: CellWriter<Vec<u8>>,
}

impl Game {
    fn new(glyphs: GlyphSet, depth: ColorDepth) -> Self {
        let size = Size::new(120, 40);
        let level = builtin::LEVELS.iter().find(|level| level.name == "citadel").unwrap();
        let levels = Levels::new(level.world().unwrap().into(), std::iter::empty());
        let settings = Settings { depth: Some(depth), glyphs, ..Settings::default() };
        let walk = Script::parse("3 s forward\n3 s turn-left\n2 s strafe-left", "walk").unwrap();
        Self {
            replay: Replay::new(levels, settings, size),
            intents: walk.iter().map(|(_, intents)| intents).collect(),
            steps: 0,
            writer: CellWriter::new(Vec::new(), size),
        }
    }
}

impl FrameSource for Game {
    fn bytes(&mut self, now: Duration, fidelity: Fidelity, _: f64) -> f64 {
        let steps = (now.as_secs_f64() * f64::from(STEPS_PER_SECOND)) as usize;
        for step in self.steps..steps {
            self.replay.step(self.intents[step % self.intents.len()]);
        }
        self.steps = steps;
        self.writer.set_fidelity(fidelity);
        self.writer.draw_frame(|screen| self.replay.draw(screen));
        Backend::flush(&mut self.writer).unwrap();
        self.writer.output_mut().drain(..).len() as f64
    }

    fn carried(&self, _: Fidelity) -> f64 {
        1.0
    }
}

/// When fidelity had no effect on palettes and characters, 256 colours gave 12 frames a second and
/// characters 8.
#[test]
fn in_every_depth_and_glyph_mode_a_megabit_carries_twenty_frames_a_second() {
    let link = Conditions { delay: 50 * MILLISECOND, jitter: Duration::ZERO, rate: MEGABIT };
    for (glyphs, depth) in [
        (GlyphSet::Half, ColorDepth::True),
        (GlyphSet::Half, ColorDepth::Indexed256),
        (GlyphSet::Half, ColorDepth::Indexed16),
        (GlyphSet::Ascii, ColorDepth::True),
    ] {
        let mut simulation = Simulation::of_source(link, Game::new(glyphs, depth));
        simulation.walk(10 * SECOND);
        let shown = simulation.players[0].shown_since(2 * SECOND);
        let arrived = shown.iter().filter(|frame| frame.at.is_some_and(|at| at <= 10 * SECOND));
        let count = arrived.count();
        assert!(count >= 8 * 20, "{glyphs:?} {depth:?}: {count} frames in 8 s");
    }
}
