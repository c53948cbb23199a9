//! The contents of the screen.

use std::thread;
use std::time::{Duration, Instant};

use super::game::{Game, Key};
use crate::emulator::Speaks;

#[test]
fn the_game_starts_with_a_picture_a_minimap_and_a_status_line() {
    for speaks in [Speaks::Nothing, Speaks::Plain, Speaks::Kitty] {
        let game = Game::with(speaks, (80, 24), None, &[], &[]);
        game.wait_for("Cellar");
        game.wait_for("┌map");
        assert_eq!(game.arrow().points, '→');
        game.wait_for_picture(&[]);
    }
}

#[test]
fn a_terminal_that_says_it_has_all_colours_gets_them() {
    let game = Game::with(Speaks::Kitty, (80, 24), None, &[], &[("COLORTERM", "")]);
    game.wait_for_picture(&[]);
}

#[test]
fn the_picture_fills_a_window_of_any_size() {
    let game = Game::start();
    game.tap(Key::Char('m'));
    for (columns, rows) in [(120, 40), (33, 9), (500, 200), (20, 6), (80, 24)] {
        game.resize(columns, rows);
        game.wait_for_bare_picture(&[]);
        game.wait_for("Find the");
    }
}

#[test]
fn a_window_too_small_says_so_and_the_game_resumes_when_it_grows() {
    let game = Game::start();
    game.resize(19, 5);
    game.wait_for("Too small to play:");
    game.wait_for("20×6");
    game.resize(1, 1);
    game.wait_until("drew one cell", |emulator| emulator.text().trim() == "T");
    game.resize(80, 24);
    game.wait_for("┌map");
    game.wait_for_picture(&[]);
}

#[test]
fn no_series_of_resizes_does_any_harm() {
    let mut game = Game::start();
    game.press(Key::Right);
    for size in 0..60 {
        game.resize(1 + size * 37 % 150, 1 + size * 23 % 50);
        thread::sleep(Duration::from_millis(5));
    }
    game.release(Key::Right);
    game.resize(80, 24);
    game.wait_for("Cellar");
    game.wait_for("┌map");
    game.leave();
    game.wait_for_end().assert_given_back();
}

#[test]
fn m_and_tab_hide_the_minimap_and_show_it_again() {
    let game = Game::with(Speaks::Plain, (80, 24), None, &[], &[]);
    for key in ["m", "\t", "\x1b[Z"] {
        game.wait_for("┌map");
        game.send(key);
        game.wait_for_bare_picture(&[]);
        game.send("m");
    }
    game.wait_for("┌map");
}

#[test]
fn help_names_the_keys_until_it_is_closed() {
    let game = Game::start();
    // The key with the slash produces the question mark with Shift.
    for close in ["\x1b[47:63;2u", "\x1b[27u"] {
        game.press(Key::Char('?'));
        game.wait_for("keep walking");
        game.wait_for("q escape");
        game.send(close);
        game.wait_for_picture(&[]);
    }
}

#[test]
fn the_goal_shows_until_the_player_has_moved() {
    let game = Game::start();
    game.wait_for("Find the way out");
    game.press(Key::Right);
    game.wait_until("stopped telling the goal", |emulator| {
        !emulator.text().contains("Find the way out")
    });
    game.wait_for("Cellar");
}

#[test]
fn help_scrolls_in_a_small_window() {
    let game = Game::with(Speaks::Plain, (40, 12), None, &[], &[]);
    game.send("?");
    game.wait_for("? closes; q leaves");
    game.wait_for("1-7 of ");
    game.send("\x1b[B");
    game.wait_for("2-8 of ");
    for _ in 0..9 {
        game.send("\x1b[6~");
    }
    game.wait_for("notes violet");
    game.send("?");
    game.wait_until("closed help", |emulator| !emulator.text().contains("closes"));
}

#[test]
fn plus_and_minus_change_the_field_of_view() {
    let game = Game::start();
    game.tap(Key::Char('+'));
    game.wait_for_picture(&["--fov", "72"]);
    for _ in 0..2 {
        game.tap(Key::Char('-'));
    }
    game.wait_for_picture(&["--fov", "60"]);
    for _ in 0..20 {
        game.tap(Key::Char('='));
    }
    game.wait_for_picture(&["--fov", "120"]);
}

#[test]
fn a_pause_stops_the_clock_and_everything_else() {
    let started = Instant::now();
    let game = Game::start_map("way_out");
    game.tap(Key::Char('p'));
    game.wait_for("p resumes");
    let paused = Instant::now();
    game.tap(Key::Char('w'));
    game.press(Key::Char('w'));
    game.wait_for_rest();
    game.wait_for_rest();
    let paused = paused.elapsed();
    game.tap(Key::Char('p'));
    game.wait_for("you found the way out");
    let without_pause = started.elapsed().saturating_sub(paused).as_secs_f64();
    let shown = seconds(&game.text());
    assert!(shown <= without_pause, "{shown} s are shown of {without_pause} s");
}

/// The time that the game reports: minutes, seconds, tenths.
fn seconds(text: &str) -> f64 {
    let (_, time) = text.split_once(" in ").unwrap();
    let (minutes, seconds) = time.split_whitespace().next().unwrap().split_once(':').unwrap();
    minutes.parse::<f64>().unwrap() * 60.0 + seconds.parse::<f64>().unwrap()
}
