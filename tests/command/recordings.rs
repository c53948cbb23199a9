//! Scripts played off screen: a recording shows the frames of the game.
#![cfg(feature = "cli")]

use std::fs;
use std::num::{NonZeroU16, NonZeroU32};
use std::path::Path;

use crate::asciicast::Asciicast;
use crate::looks::{Look, looks};
use crate::support::{complaint_about, output_of};
use cellcaster::app::{Levels, Replay, Settings};
use cellcaster::game::Script;
use cellcaster::map::builtin;
use cellcaster::terminal::CellWriter;
use ratatui::backend::Backend;
use ratatui::buffer::Buffer;
use ratatui::layout::Size;
use vt100::Parser;

const SCRIPT: &str =
    "0.5 s stand\n[out]\n7 steps forward\n1 s forward turn-right run\n20 steps open\n";
const SIZE: Size = Size { width: 60, height: 20 };
const FRAMES_PER_SECOND: NonZeroU32 = NonZeroU32::new(20).unwrap();

fn file(name: &str, text: &str) -> String {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

fn terminal() -> Parser {
    let length = |cells| NonZeroU16::new(cells).unwrap();
    Parser::new(length(SIZE.height), length(SIZE.width), 0)
}

/// The cells of a terminal that has received the whole `picture`.
fn drawn(picture: &Buffer) -> Vec<Look> {
    let mut bytes = Vec::new();
    let mut writer = CellWriter::new(&mut bytes, SIZE);
    writer.draw(Buffer::empty(SIZE.into()).diff(picture).into_iter()).unwrap();
    Backend::flush(&mut writer).unwrap();
    let mut terminal = terminal();
    terminal.process(&bytes);
    looks(terminal.screen())
}

#[test]
fn a_recording_shows_every_frame_of_the_game_at_its_time() {
    let script = file("frames.script", SCRIPT);
    let file = output_of(&["replay", &script, "museum", "--size", "60x20", "--fps", "20"]);
    let recording = Asciicast::read(&String::from_utf8(file).unwrap());
    assert_eq!((recording.columns, recording.rows), (60, 20));
    let mut terminal = terminal();
    let mut events = recording.events.iter().peekable();
    // The sequence for the alternate screen has the same time as the first frame.
    terminal.process(events.next().unwrap().data.as_bytes());

    let levels = Levels::new(builtin::LEVELS[1].world().unwrap().into(), std::iter::empty());
    let levels = levels.numbered(2, builtin::LEVELS.len());
    let mut replay = Replay::new(levels, Settings::default(), SIZE);
    let mut last = 0;
    let shown = replay.play(
        &Script::parse(SCRIPT, "it").unwrap(),
        FRAMES_PER_SECOND,
        |frame, _, picture| {
            while let Some(event) = events.next_if(|event| event.time <= frame * 50) {
                if event.data.contains("\x1b[?1049l") {
                    break;
                }
                terminal.process(event.data.as_bytes());
            }
            last = frame;
            if looks(terminal.screen()) == drawn(picture) { Ok(()) } else { Err(frame) }
        },
    );
    assert_eq!(shown, Ok(()));
    assert_eq!(last, 39);
    assert!(events.next().is_none());
}

#[test]
fn the_same_script_makes_the_same_recording() {
    let script = file("same.script", SCRIPT);
    let cast = file("same.cast", "");
    let written = output_of(&["replay", &script]);
    assert_eq!(output_of(&["replay", &script, "cellar", "--cast", &cast]), b"");
    assert!(fs::read(&cast).unwrap() == written && !written.is_empty());
}

#[test]
fn mistakes_are_told() {
    let bad = file("bad.script", "[x]\n1 s foward\n");
    let complaints = [
        complaint_about(&["replay"]),
        complaint_about(&["replay", "absent.script"]),
        complaint_about(&["replay", &bad]),
        complaint_about(&["replay", &bad, "--size", "0x3"]),
        complaint_about(&["replay", &bad, "--size", "1000x1000"]),
    ];
    let folder = format!("{}/", env!("CARGO_TARGET_TMPDIR"));
    insta::assert_snapshot!(complaints.join("\n").replace(&folder, ""));
}
