//! The end of a level.

use super::game::{Game, Key};

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
