//! Turning, tilting and opening with the mouse, and the loss of the focus.

use std::fs;
use std::path::Path;

use super::game::{Game, Key};
use crate::asciicast::Asciicast;
use crate::emulator::{Emulator, Speaks};
use crate::support::output_of;

/// A motion of the pointer to this cell or pixel, counted from 1.
fn motion(column: u16, row: u16) -> String {
    format!("\x1b[<35;{column};{row}M")
}

/// A press and release of the left button there.
fn click(column: u16, row: u16) -> String {
    format!("\x1b[<0;{column};{row}M\x1b[<0;{column};{row}m")
}

fn switch_on(game: &Game) {
    game.tap(Key::Char('v'));
    game.wait_for("  mouse");
}

fn reports_the_mouse(emulator: &Emulator) -> bool {
    emulator.modes().mouse != crate::emulator::Modes::default().mouse
}

#[test]
fn moving_the_pointer_turns_and_tilts_by_as_much_as_it_moves() {
    for speaks in [Speaks::Kitty, Speaks::Plain] {
        let game = Game::with(speaks, (80, 24), None, &[], &[]);
        switch_on(&game);
        game.send(motion(40, 12));
        game.send(motion(55, 12));
        game.wait_for_picture(&["--camera", "1.5,1.5,30"]);
        game.send(motion(25, 12));
        game.wait_for_picture(&["--camera", "1.5,1.5,-30"]);
        game.send(motion(25, 2));
        game.wait_until("looked up", |emulator| emulator.text().contains("mouse"));
        game.send(motion(40, 12));
        game.wait_for_picture(&[]);
        let written = game.bytes_written();
        game.wait_for_rest();
        assert_eq!(game.bytes_written(), written, "the pointer rests, and bytes are written");
    }
}

#[test]
fn a_terminal_that_reports_pixels_turns_by_less_than_a_cell() {
    let game = Game::start();
    game.wait_for_releases();
    game.resize_in_pixels((80, 24), (640, 384));
    game.wait_for_rest();
    switch_on(&game);
    game.wait_until("asked for pixels", |emulator| emulator.modes().mouse_pixels);
    game.send(motion(320, 200));
    game.send(motion(346, 200));
    // A cell is 8 pixels wide, and corresponds to a turn of 2°.
    game.wait_for_picture(&["--camera", "1.5,1.5,6.5"]);
}

#[test]
fn a_mouse_that_is_off_turns_nothing() {
    let game = Game::start();
    game.wait_for_picture(&[]);
    assert!(!game.look(reports_the_mouse));
    switch_on(&game);
    assert!(game.look(reports_the_mouse));
    game.tap(Key::Char('v'));
    game.wait_until("gave the mouse back", |emulator| !reports_the_mouse(emulator));
    game.wait_for_rest();
    let written = game.bytes_written();
    for column in 20..60 {
        game.send(motion(column, 12));
    }
    game.wait_for_rest();
    assert_eq!(game.bytes_written(), written, "a motion that came too late was drawn");
}

#[test]
fn a_button_opens_a_door() {
    let game = Game::start_map("oak_door");
    switch_on(&game);
    game.wait_for_rest();
    let closed = game.text();
    game.send(click(40, 12));
    game.wait_until("moved the door", |emulator| emulator.text() != closed);
}

#[test]
fn a_walk_by_mouse_replays_to_the_same_picture() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("mouse.script");
    let options = ["--force", "--record", path.to_str().unwrap()];
    let mut game = Game::with(Speaks::Kitty, (80, 24), None, &options, &[]);
    switch_on(&game);
    game.press(Key::Char('w'));
    for column in 30..55 {
        game.send(motion(column, 20 - column / 4));
    }
    game.wait_for_arrow("turned", |arrow| arrow.points != '→');
    game.release(Key::Char('w'));
    game.tap(Key::Char('v'));
    game.wait_for_rest();
    let played = game.look(super::game::looks);
    game.leave();
    game.wait_for_end();

    let script = fs::read_to_string(&path).unwrap();
    assert!(script.contains("turn:") && script.contains("tilt:"), "{script}");
    let file = output_of(&["share", path.to_str().unwrap(), "--format", "cast", "--fps", "30"]);
    let recording = Asciicast::read(&String::from_utf8(file).unwrap());
    let (_, frames) = recording.events.split_last().unwrap();
    let mut terminal = Emulator::new(80, 24, Speaks::Nothing);
    for event in frames {
        terminal.process(event.data.as_bytes());
    }
    assert!(super::game::looks(&terminal) == played, "{script}");
}

#[test]
fn losing_focus_releases_all_keys() {
    let game = Game::with(Speaks::Kitty, (120, 40), Some("corridor"), &[], &[]);
    let before = game.arrow();
    game.press(Key::Char('w'));
    game.wait_for_arrow("walked", |arrow| arrow.column > before.column);
    game.send("\x1b[O");
    game.wait_for_rest();
    let after = game.arrow();
    assert!(after.column < before.column + 16, "it walked on without the focus");
    // The release went to another window.
    game.send("\x1b[I");
    game.press(Key::Char('s'));
    game.wait_for_arrow("walked back", |arrow| arrow.column < after.column);
}
