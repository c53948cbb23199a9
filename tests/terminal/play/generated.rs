//! Levels that are generated while the player walks.

use super::game::{Game, Key};
use crate::emulator::{Emulator, Speaks};

/// The level and the player's position, read from the status line.
fn whereabouts(emulator: &Emulator) -> String {
    let text = emulator.text();
    let line = text.lines().last().unwrap_or_default();
    // Two blanks separate the parts of the line.
    let parts: Vec<&str> = line.trim().split("  ").take(2).collect();
    parts.join("  ")
}

fn start(options: &[&str]) -> Game {
    let options = [&["--generate", "maze", "--seed", "7"], options].concat();
    Game::with(Speaks::Kitty, (80, 24), None, &options, &[])
}

#[test]
fn the_status_line_shows_the_level_and_the_players_cell() {
    let mut game = start(&[]);
    assert_eq!(game.look(whereabouts), "Maze 7  1, 1");
    game.press(Key::Char('w'));
    game.wait_until("walked out of the first cell", |emulator| {
        let place = whereabouts(emulator);
        place.starts_with("Maze 7  ") && place != "Maze 7  1, 1"
    });
    game.release(Key::Char('w'));
    game.leave();
    let ending = game.wait_for_end();
    ending.assert_given_back();
    assert!(ending.status.success());
}

#[test]
fn a_place_a_billion_cells_away_is_like_any_other() {
    let mut game = start(&["--start", "1000000000,-1000000000"]);
    let place = game.look(whereabouts);
    assert!(place.starts_with("Maze 7  10000000") && place.contains(", -"), "{place}");
    game.press(Key::Char('w'));
    game.wait_until("walked on", |emulator| whereabouts(emulator) != place);
    game.leave();
    assert!(game.wait_for_end().status.success());
}
