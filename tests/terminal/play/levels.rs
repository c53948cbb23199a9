//! Transitions between levels.

use super::game::{Game, Key};
use crate::emulator::Speaks;

#[test]
fn the_exit_shows_the_time_and_a_single_map_is_followed_by_the_end() {
    let mut game = Game::start_map("way_out");
    game.press(Key::Char('w'));
    game.wait_for("you found the way out");
    game.wait_for(" in 0:");
    game.confirm();
    game.wait_for("the end");
    game.wait_for("all levels");
    game.wait_for(" in 0:");
    game.confirm();
    let ending = game.wait_for_end();
    ending.assert_given_back();
    assert!(ending.status.success());
}

/// Leaves the cellar by its only way, sliding along the walls.
#[test]
fn the_first_level_is_followed_by_the_second() {
    let game = Game::with(Speaks::Kitty, (80, 24), None, &[], &[]);
    let start = game.arrow();
    game.press(Key::Char('d'));
    game.wait_for_picture(&["--camera", "1.5,3.75,0"]);
    game.press(Key::Char('w'));
    game.wait_for_arrow("went through the gap", |arrow| arrow.column >= start.column + 4);
    game.release(Key::Char('d'));
    game.wait_for_arrow("passed the alcove", |arrow| arrow.column >= start.column + 10);
    game.tap(Key::Char('r'));
    game.press(Key::Char('d'));
    game.wait_for("you found the way out");
    game.wait_for(" in 0:");
    game.confirm();
    game.wait_for("Museum");
    assert!(!game.text().contains("Cellar"));
}
