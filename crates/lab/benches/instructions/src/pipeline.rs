//! The whole pipeline, from intents to bytes: the script of the showcase, with each stretch shortened.

use std::hint::black_box;

use cellcaster::app::{Levels, Replay, Settings};
use cellcaster::game::{Intents, Script};
use cellcaster::map::builtin;
use cellcaster::terminal::{CellWriter, Effort, Fidelity};
use cellcaster::tui::GlyphSet;
use ratatui::backend::Backend;
use ratatui::layout::Size;

use super::counted;

/// The number of steps of the game in a frame.
const STEPS_A_FRAME: usize = 2;
/// Each stretch is shortened to this fraction of its length.
const SHARE: u32 = 16;

/// Plays the script on a screen of this size, at `fidelity` and with the greedy effort.
pub(crate) fn play(glyphs: GlyphSet, size: Size, fidelity: Fidelity) {
    let (mut replay, intents) = (replay(glyphs, size), intents());
    let mut writer = CellWriter::new(Vec::new(), size);
    writer.set_fidelity(fidelity);
    writer.set_effort(Effort::Greedy);
    show(&mut replay, &mut writer, &[]);
    counted(|| {
        for intents in intents.chunks(STEPS_A_FRAME) {
            show(&mut replay, &mut writer, intents);
        }
    });
}

fn show(replay: &mut Replay, writer: &mut CellWriter<Vec<u8>>, intents: &[Intents]) {
    intents.iter().for_each(|&intents| replay.step(intents));
    writer.draw_frame(|screen| replay.draw(screen));
    writer.output_mut().clear();
    // Writing to memory cannot fail.
    _ = Backend::flush(writer);
    black_box(writer.output_mut());
}

fn replay(glyphs: GlyphSet, size: Size) -> Replay {
    let citadel = builtin::LEVELS.iter().find(|level| level.name == "citadel");
    let world = citadel.expect("it is built in").world().expect("built-in levels have no faults");
    let settings = Settings { glyphs, ..Settings::default() };
    Replay::new(Levels::new(world.into(), std::iter::empty()), settings, size)
}

/// The intents of each step.
fn intents() -> Vec<Intents> {
    let script = include_str!("../../../../../maps/showcase.script");
    let script = Script::parse(script, "showcase").expect("the committed script has no faults");
    let stretches = script.sections().iter().flat_map(|section| &section.stretches);
    stretches
        .flat_map(|stretch| std::iter::repeat_n(stretch.intents, (stretch.steps / SHARE) as usize))
        .collect()
}
