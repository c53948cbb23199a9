//! The whole pipeline, from intents to bytes, and the encoder alone.
//!
//! The script of the showcase is played at exact fidelity, with each stretch shortened.

use std::hint::black_box;

use cellcaster::app::{Levels, Replay, Settings};
use cellcaster::game::{Intents, Script};
use cellcaster::map::builtin;
use cellcaster::terminal::CellWriter;
use cellcaster::tui::GlyphSet;
use ratatui::backend::Backend;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Size;

use super::counted;

/// The number of steps of the game in a frame.
const STEPS_A_FRAME: usize = 2;
/// Each stretch is shortened to this fraction of its length.
const SHARE: u32 = 16;

/// The changed cells of a frame.
type Changes = Vec<(u16, u16, Cell)>;

/// Plays the script on a screen of this size.
pub(crate) fn play(glyphs: GlyphSet, columns: u16, rows: u16) {
    let size = Size::new(columns, rows);
    let (mut replay, intents) = (replay(glyphs, size), intents());
    let mut writer = CellWriter::new(Vec::new(), size);
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
    send(writer);
}

/// Encodes the changed cells of the same frames.
pub(crate) fn encode(columns: u16, rows: u16) {
    let size = Size::new(columns, rows);
    let frames = frames(size);
    let mut writer = CellWriter::new(Vec::new(), size);
    let mut encode = |frame: &Changes| {
        // Writing to memory cannot fail.
        _ = writer.draw(frame.iter().map(|(x, y, cell)| (*x, *y, cell)));
        send(&mut writer);
    };
    let (first, others) = frames.split_first().expect("there is a first frame");
    encode(first);
    counted(|| others.iter().for_each(encode));
}

/// Sends the drawn cells. Writing to memory cannot fail.
fn send(writer: &mut CellWriter<Vec<u8>>) {
    writer.output_mut().clear();
    _ = Backend::flush(writer);
    black_box(writer.output_mut());
}

fn frames(size: Size) -> Vec<Changes> {
    let mut replay = replay(GlyphSet::Half, size);
    let mut before = Buffer::empty(size.into());
    let mut frame = |steps: &[Intents]| {
        steps.iter().for_each(|&intents| replay.step(intents));
        let picture = replay.picture();
        let changes = before.diff(picture).into_iter();
        let changes = changes.map(|(x, y, cell)| (x, y, cell.clone())).collect();
        before.clone_from(picture);
        changes
    };
    let mut frames = vec![frame(&[])];
    frames.extend(intents().chunks(STEPS_A_FRAME).map(frame));
    frames
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
