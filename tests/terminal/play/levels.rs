//! The end of a level.

use std::time::Duration;
use std::{fs, thread};

use super::clock::{CLOCK, Typist};
use super::game::{ENVIRONMENT, Game, Key, PROGRAM};
use super::titles::folder;

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

/// A corridor of spikes.
const DEADLY: &str = r##"
grid = '''
####################
#@^^^^^^^^^^^^^^^^^#
####################
'''
[tiles]
"#" = { wall = "brick" }
[things]
"@" = { start = 0 }
"^" = { spikes = 1.0 }
"##;

/// The terminal reports no releases, and the player dies while walking and continues to press keys
/// of the game.
#[test]
fn after_a_death_only_enter_and_the_arrows_act() {
    let path = folder("deadly").join("deadly.toml");
    fs::write(&path, DEADLY).unwrap();
    let environment = [&ENVIRONMENT[..], &[CLOCK]].concat();
    let arguments = ["play", path.to_str().unwrap()];
    for held in ["w", "\x1b[A"] {
        let mut typist = Typist::start(PROGRAM, &arguments, &environment);
        typist.wait_to_see("? help");
        typist.hold(held, 60);
        for _ in 0..600 {
            if typist.text().contains("you are dead") {
                break;
            }
            typist.tap(held, 2);
        }
        typist.wait_to_see("> Try again");
        for _ in 0..60 {
            typist.tap(held, 2);
        }
        for key in ["w", "s", "l", "r", "q", "\x1b", " ", "2", "f"] {
            typist.tap(key, 20);
            typist.wait_to_see("> Try again");
        }
        for (key, selected) in [
            ("\x1b[A", "> Try again"),
            ("\x1b[B", "> Take back 10 s"),
            ("\x1b[B", "> Restart the level"),
            ("\x1b[B", "> Leave"),
            ("\x1b[B", "> Leave"),
            ("\x1b[A", "> Restart the level"),
            ("\x1b[A", "> Take back 10 s"),
            ("\x1b[A", "> Try again"),
        ] {
            typist.tap(key, 20);
            typist.wait_to_see(selected);
        }
        typist.tap("\r", 20);
        typist.wait_to_see("? help");
        typist.send("q\r");
        typist.wait_for_end().assert_given_back();
    }
}
