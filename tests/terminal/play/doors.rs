//! Doors and keys.

use super::game::{Game, Key};

#[test]
fn the_key_opens_one_door_and_the_exit_is_behind_another() {
    let game = Game::start_map("door");
    game.press(Key::Char('w'));
    game.wait_for("This door needs the brass key.");
    game.release(Key::Char('w'));
    game.press(Key::Char('s'));
    game.wait_for("You have the brass key.");
    game.release(Key::Char('s'));
    game.press(Key::Char('w'));
    game.wait_for("you found the way out");
}

#[test]
fn a_door_opens_stays_open_without_a_byte_and_closes() {
    let game = Game::start_map("oak_door");
    game.wait_for_picture(&[]);
    let closed = game.text();
    game.tap(Key::Char(' '));
    game.wait_until("moved the door", |emulator| emulator.text() != closed);
    game.wait_for_rest();
    assert_ne!(game.text(), closed, "the door closed at once");
    game.wait_for_picture(&[]);
}
