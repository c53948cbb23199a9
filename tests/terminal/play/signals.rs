//! Every signal at every moment, and terminals that stop reading or constantly change their size.

use std::thread;
use std::time::Duration;

use rustix::process::Signal;

use super::game::{ENVIRONMENT, Game, Key, PROGRAM};
use crate::emulator::{Modes, Speaks};
use crate::player::Player;

/// The signals that ask the program to end. It stores the game, and then ends by itself.
const REQUESTS: [Signal; 3] = [Signal::TERM, Signal::HUP, Signal::INT];

/// Signals that end the program at once.
const ENDS: [Signal; 6] =
    [Signal::QUIT, Signal::ABORT, Signal::USR1, Signal::USR2, Signal::ALARM, Signal::XCPU];

const ENTERED: &[u8] = b"\x1b[?1049h";

/// Starts a program for each signal. It must restore the terminal, and then the signal must take
/// effect.
#[track_caller]
fn end_by_each_signal(start: impl Fn() -> Player) {
    for signal in REQUESTS.into_iter().chain(ENDS) {
        let mut player = start();
        player.signal(signal);
        let ending = player.wait_for_end();
        ending.assert_given_back();
        if REQUESTS.contains(&signal) {
            assert!(ending.status.success(), "{signal:?}: {ending:?}");
        } else {
            assert_eq!(ending.signal(), Some(signal.as_raw()), "{ending:?}");
        }
    }
}

#[test]
fn signals_end_the_game_right_after_the_start() {
    end_by_each_signal(|| {
        let arguments = ["play", "cellar"];
        let player = Player::start((80, 24), Speaks::Kitty, PROGRAM, arguments, &ENVIRONMENT);
        player.wait_until("took the terminal", |emulator| {
            emulator.bytes().windows(ENTERED.len()).any(|bytes| bytes == ENTERED)
        });
        player
    });
}

#[test]
fn signals_end_the_game_at_rest() {
    end_by_each_signal(|| {
        let game = Game::start();
        game.wait_for_releases();
        game.into_player()
    });
}

#[test]
fn signals_end_the_game_in_motion() {
    end_by_each_signal(|| {
        let game = Game::start();
        game.press(Key::Right);
        game.wait_for_arrow("turned", |arrow| arrow.points != '→');
        game.into_player()
    });
}

#[test]
fn signals_end_the_game_with_the_mouse_on() {
    end_by_each_signal(|| {
        let game = Game::start();
        game.press(Key::Char('v'));
        game.wait_until("took the mouse", |emulator| {
            emulator.modes().mouse != Modes::default().mouse
        });
        game.into_player()
    });
}

#[test]
fn signals_end_the_game_in_a_terminal_that_never_answers() {
    end_by_each_signal(|| Game::with(Speaks::Nothing, (80, 24), None, &[], &[]).into_player());
}

/// SIGSTKFLT, SIGIO, SIGPWR and the real-time signals end the program with the status that a shell
/// reports for them.
#[cfg(target_os = "linux")]
#[test]
fn signals_without_a_name_end_the_game_with_their_number() {
    for number in [16, 29, 30].into_iter().chain(35..=64) {
        let game = Game::start();
        game.wait_for_releases();
        let mut player = game.into_player();
        player.signal_number(number);
        let ending = player.wait_for_end();
        ending.assert_given_back();
        assert_eq!(ending.status.code(), Some(128 + number), "{ending:?}");
    }
}

/// The key for SIGQUIT is pressed while the terminal interprets keys.
#[cfg(target_os = "linux")]
#[test]
fn the_quit_key_does_not_end_the_game_while_keys_are_interpreted() {
    let mut game = Game::start();
    game.wait_for_releases();
    game.wait_for_rest();
    game.interpret_keys();
    game.send("\x1c");
    thread::sleep(Duration::from_millis(300));
    assert!(!game.has_ended());
    // This is the state after a stop.
    game.signal(Signal::CONT);
    game.press(Key::Right);
    game.wait_for_arrow("turned", |arrow| arrow.points != '→');
    game.leave();
    let ending = game.wait_for_end();
    ending.assert_given_back();
    assert!(ending.status.success(), "{ending:?}");
}

/// The terminal answers while the first frame is too long for it, so the program wants to push
/// keyboard flags but cannot.
#[test]
fn flags_that_were_not_pushed_are_not_popped() {
    const FRAME: &[u8] = b"\x1b[?2026h";
    for signal in [Signal::TERM, Signal::QUIT] {
        let arguments = ["play", "cellar"];
        let size = (400, 120);
        let mut player =
            Player::start_stalling(size, Speaks::Kitty, FRAME, PROGRAM, arguments, &ENVIRONMENT);
        player.wait_until_stalled();
        player.wait_until_full();
        player.wait_until_read();
        player.signal(signal);
        player.wait_for_end().assert_given_back();
        assert!(!player.bytes().windows(3).any(|bytes| bytes == b"\x1b[<"));
    }
}

#[test]
fn signals_end_the_game_in_a_terminal_that_does_not_read() {
    for signal in [Signal::TERM, Signal::QUIT] {
        let mut game = Game::with(Speaks::Plain, (300, 100), None, &[], &[]);
        game.set_reading(false);
        for _ in 0..20 {
            game.send("\x1b[C");
            thread::sleep(Duration::from_millis(20));
        }
        game.wait_until_full();
        game.signal(signal);
        let ending = game.wait_for_end();
        assert_eq!(ending.modes, Modes::default());
        assert!(ending.attributes_restored);
    }
}

#[test]
fn the_picture_is_whole_after_a_storm_of_resizes() {
    let mut game = Game::start();
    for number in 0..400_u16 {
        game.resize(1 + number * 37 % 160, 1 + number * 23 % 50);
        if number % 8 == 0 {
            thread::sleep(Duration::from_millis(3));
        }
    }
    game.resize(80, 24);
    game.wait_for_picture(&[]);
    game.leave();
    game.wait_for_end().assert_given_back();
}
