//! Looking up and ahead again, jumping and ducking.

use super::game::{Game, Key};
use crate::emulator::Speaks;

#[test]
fn page_up_looks_up_and_home_ahead_again() {
    for speaks in [Speaks::Kitty, Speaks::Plain] {
        let game = Game::with(speaks, (80, 24), None, &[], &[]);
        game.wait_for_picture(&[]);
        for _ in 0..20 {
            game.tap(Key::PageUp);
        }
        game.press(Key::PageUp);
        if speaks == Speaks::Kitty {
            game.wait_for_picture(&["--pitch", "30"]);
        }
        game.release(Key::PageUp);
        game.tap(Key::Home);
        game.wait_for_picture(&[]);
    }
}

#[test]
fn ducking_lowers_the_view_and_a_jump_comes_down_again() {
    let game = Game::start();
    game.press(Key::Char('c'));
    game.wait_for_picture(&["--eye", "0.3"]);
    game.release(Key::Char('c'));
    game.wait_for_picture(&[]);
    game.tap(Key::Char('x'));
    game.wait_for("ducking");
    game.wait_for_picture(&["--eye", "0.3"]);
    game.tap(Key::Char('x'));
    game.wait_for_picture(&[]);
    let before = game.text();
    game.tap(Key::Char(' '));
    game.wait_until("jumped", |emulator| emulator.text() != before);
    game.wait_for_picture(&[]);
}
