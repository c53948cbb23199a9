//! The time for which a key counts as held, with and without key releases.

use std::thread;
use std::time::Duration;

use super::game::{Arrow, Game, Key};
use crate::emulator::Speaks;

const LARGE: (u16, u16) = (120, 40);

fn in_a_corridor(speaks: Speaks, environment: &[(&str, &str)]) -> Game {
    Game::with(speaks, LARGE, Some("corridor"), &[], environment)
}

/// A distance in columns that taps do not reach.
const FAR: u16 = 4;

#[test]
fn a_key_is_held_without_repetition_until_its_release() {
    let game = in_a_corridor(Speaks::Kitty, &[]);
    let before = game.arrow();
    game.press(Key::Char('w'));
    game.wait_for_arrow("walked far", |arrow| arrow.column > before.column + FAR);
    game.release(Key::Char('w'));
    game.wait_for_rest();
    assert!(game.arrow().column < before.column + 32, "it walked to the end");
}

/// In a plain terminal without releases, and in a multiplexer that claims to report them.
#[test]
fn without_releases_a_tap_walks_a_little_and_stops() {
    let multiplexers: [&[_]; 4] = [
        &[],
        &[("TMUX", "/tmp/socket,1,0")],
        &[("STY", "1.pts-0.host")],
        &[("TERM", "screen-256color")],
    ];
    let games = multiplexers.map(|environment| {
        let speaks = if environment.is_empty() { Speaks::Plain } else { Speaks::Kitty };
        let game = in_a_corridor(speaks, environment);
        let before = game.arrow();
        // Three taps are three quarters of a cell.
        game.send("www");
        (environment, game, before)
    });
    for (environment, game, before) in games {
        game.wait_for_arrow("walked", |arrow| arrow.column > before.column);
        game.wait_for_rest();
        assert_eq!(game.arrow().column, before.column + 1, "it walked on by itself");
        if !environment.is_empty() {
            assert!(!speaks_kitty(&game.bytes()), "the protocol was asked for in {environment:?}");
        }
    }
}

fn speaks_kitty(bytes: &[u8]) -> bool {
    [&b"\x1b[?u"[..], b"\x1b[>15u"]
        .iter()
        .any(|query| bytes.windows(query.len()).any(|w| w == *query))
}

#[test]
fn without_releases_repetition_walks_and_an_opposing_key_reverses() {
    const REPETITION: Duration = Duration::from_millis(30);
    let game = in_a_corridor(Speaks::Plain, &[]);
    let before = game.arrow();
    let hold_until = |key: &str, condition: &dyn Fn(Arrow) -> bool| {
        for _ in 0..600 {
            if condition(game.arrow()) {
                return;
            }
            game.send(key);
            thread::sleep(REPETITION);
        }
        panic!("holding {key} did not help");
    };
    hold_until("w", &|arrow| arrow.column > before.column + FAR);
    hold_until("s", &|arrow| arrow.column <= before.column + 1);
}

/// The position at the wall ahead of the start: a quarter of a cell from it, which is the smallest
/// distance.
const AT_THE_WALL_AHEAD: [&str; 2] = ["--camera", "6.75,1.5,0"];

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
