//! The end of a level.

use std::thread;
use std::time::Duration;

use super::game::{Game, Key};

/// The pause before Enter, which confirms a result only after half a second.
const RESULT: Duration = Duration::from_millis(700);

#[test]
fn the_exit_shows_the_time_and_a_single_map_is_followed_by_the_end() {
    let mut game = Game::start_map("way_out");
    game.press(Key::Char('w'));
    game.wait_for("you found the way out");
    game.wait_for(" in 0:");
    game.release(Key::Char('w'));
    thread::sleep(RESULT);
    game.tap(Key::Enter);
    game.wait_for("the end");
    game.wait_for("all levels");
    game.wait_for(" in 0:");
    thread::sleep(RESULT);
    // Enter ends the game, long before the key is released.
    game.press(Key::Enter);
    let ending = game.wait_for_end();
    ending.assert_given_back();
    assert!(ending.status.success());
}
