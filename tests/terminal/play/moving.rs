//! Walking, strafing, turning, and walls.

use super::game::{Game, Key};

/// The positions at the wall ahead of the start, at the wall to its right, and at the wall behind:
/// a quarter of a cell from each, which is the smallest distance.
const AT_THE_WALL_AHEAD: [&str; 2] = ["--camera", "6.75,1.5,0"];
const AT_THE_WALL_TO_THE_RIGHT: [&str; 2] = ["--camera", "1.5,3.75,0"];
const AT_THE_WALL_BEHIND: [&str; 2] = ["--camera", "1.25,1.5,0"];

#[test]
fn forward_walks_up_to_the_wall_and_no_further() {
    let game = Game::start();
    let before = game.arrow();
    game.press(Key::Char('w'));
    game.wait_for_picture(&AT_THE_WALL_AHEAD);
    let after = game.arrow();
    assert_eq!((after.column, after.row, after.points), (before.column + 5, before.row, '→'));

    let written = game.bytes_written();
    game.wait_for_rest();
    assert_eq!(game.bytes_written(), written, "it still moves");
    game.tap(Key::Char('m'));
    game.wait_for_bare_picture(&AT_THE_WALL_AHEAD);
}

#[test]
fn the_back_key_walks_back_and_arrow_keys_work_too() {
    let game = Game::start();
    game.press(Key::Char('s'));
    game.wait_for_picture(&AT_THE_WALL_BEHIND);
    game.release(Key::Char('s'));
    game.send("\x1b[A");
    game.wait_for_picture(&AT_THE_WALL_AHEAD);
}

#[test]
fn strafing_goes_sideways_and_turns_nothing() {
    let game = Game::start();
    let before = game.arrow();
    game.press(Key::Char('d'));
    game.wait_for_picture(&AT_THE_WALL_TO_THE_RIGHT);
    let after = game.arrow();
    assert_eq!((after.column, after.row, after.points), (before.column, before.row + 1, '→'));
    game.release(Key::Char('d'));
    game.press(Key::Char('a'));
    game.wait_for_picture(&["--camera", "1.5,1.25,0"]);
}

#[test]
fn the_player_slides_along_a_wall_met_at_an_angle() {
    let game = Game::start();
    game.press(Key::Char('a'));
    game.press(Key::Char('w'));
    game.wait_for_picture(&["--camera", "6.75,1.25,0"]);
}

#[test]
fn turning_turns_the_arrow_on_the_spot() {
    let game = Game::start();
    let before = game.arrow();
    for (key, points) in [(Key::Right, '↓'), (Key::Left, '↗')] {
        game.press(key);
        game.wait_for_arrow("turned", |arrow| arrow.points == points);
        game.release(key);
        game.wait_for_rest();
        let after = game.arrow();
        assert_eq!((after.column, after.row), (before.column, before.row));
    }
}

#[test]
fn r_runs_until_it_is_pressed_again() {
    let game = Game::start();
    game.tap(Key::Char('r'));
    game.wait_for("running");
    game.tap(Key::Char('r'));
    game.wait_until("walked again", |emulator| !emulator.text().contains("running"));
}
