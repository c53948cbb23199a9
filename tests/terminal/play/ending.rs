//! However the program ends, it restores the terminal.

use std::fs;
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};
use vt100::{MouseProtocolEncoding, MouseProtocolMode};

use super::game::{ENVIRONMENT, Game, Key, PROGRAM, looks};
use crate::emulator::{Modes, Speaks};
use crate::player::Player;

#[test]
fn the_terminal_is_taken_while_the_game_is_played() {
    let game = Game::start();
    game.wait_for_releases();
    assert_eq!(game.modes(), TAKEN);
    assert!(!game.attributes_restored());
}

const TAKEN: Modes = Modes {
    alternate_screen: true,
    cursor_hidden: true,
    wrap: false,
    synchronized: false,
    focus: true,
    mouse: (MouseProtocolMode::None, MouseProtocolEncoding::Default),
    mouse_pixels: false,
    key_flags: [0, 1],
};

/// A key release arrives whenever the game ends, and must not reach the shell.
#[test]
fn q_and_escape_ask_before_leaving_and_control_c_leaves_at_once() {
    let (q, escape, enter) = (Key::Char('q').event(1), Key::Escape.event(1), Key::Enter.event(1));
    let released = Key::Char('q').event(3);
    let twice = format!("{q}{released}{q}");
    for leave in [twice, q + &enter, escape + &enter, "\x1b[99;5u".to_owned()] {
        let mut game = Game::start();
        game.press(Key::Char('w'));
        game.send(leave);
        let ending = game.wait_for_end();
        ending.assert_given_back();
        assert!(ending.status.success());
    }
    for leave in ["qq", "q\r", "\x03"] {
        let mut game = Game::with(Speaks::Plain, (80, 24), None, &[], &[]);
        game.send(leave);
        game.wait_for_end().assert_given_back();
    }
}

#[test]
fn leaving_asks_first_and_escape_continues_the_game() {
    let mut game = Game::with(Speaks::Plain, (80, 24), None, &[], &[]);
    for _ in 0..2 {
        game.send("q");
        game.wait_for("any other key cancels");
        game.send("\x1b");
        game.wait_until("went on", |emulator| !emulator.text().contains("cancels"));
    }
    game.send("?");
    game.wait_for("keep walking");
    game.send("\x1b");
    game.wait_until("closed the help", |emulator| !emulator.text().contains("keep walking"));
    game.send("\x1b");
    game.wait_for("any other key cancels");
    game.send("\r");
    game.wait_for_end().assert_given_back();
}

#[test]
fn signals_end_the_game_in_the_middle_of_a_walk() {
    for signal in [Signal::TERM, Signal::HUP, Signal::INT] {
        let mut game = Game::start();
        game.press(Key::Right);
        game.wait_for_arrow("turned", |arrow| arrow.points != '→');
        game.signal(signal);
        let ending = game.wait_for_end();
        ending.assert_given_back();
        assert!(ending.status.success(), "{ending:?}");
    }
}

/// Otherwise a shell would print the answer to the last request.
#[test]
fn the_game_waits_for_a_late_answer() {
    for signal in [None, Some(Signal::TERM), Some(Signal::USR1)] {
        let mut game = Game::start();
        game.wait_for_releases();
        game.wait_for_rest();
        game.set_answer_time(Duration::from_millis(1500));
        match signal {
            Some(signal) => game.signal(signal),
            None => game.send("\x1b[99;5u"),
        }
        // A signal in the middle of the wait does not end it.
        thread::sleep(Duration::from_millis(700));
        game.signal(Signal::WINCH);
        game.wait_for_end().assert_given_back();
    }
}

/// A game in which the player has turned, on a terminal that has stopped reading and has no room for more.
fn with_full_terminal() -> Game {
    let game = Game::start();
    game.press(Key::Right);
    game.wait_for_arrow("turned", |arrow| arrow.points != '→');
    game.set_reading(false);
    game.wait_until_full();
    game
}

#[test]
fn the_game_ends_even_while_the_link_is_down() {
    let mut game = with_full_terminal();
    game.signal(Signal::TERM);
    let ending = game.wait_for_end();
    assert_eq!(ending.modes, Modes::default());
    assert!(ending.attributes_restored);
}

/// The line about the game has nowhere to go.
#[test]
fn the_game_ends_even_if_the_terminal_stays_full() {
    let mut game = with_full_terminal();
    game.keep_full();
    game.signal(Signal::TERM);
    assert!(game.wait_for_end().attributes_restored);
}

#[cfg(debug_assertions)]
#[test]
fn a_panic_restores_the_terminal_and_then_prints_one_sentence() {
    const F12: &str = "\x1b[24~";
    let demand = [("CELLCASTER_PANIC", "1")];
    let mut game = Game::with(Speaks::Kitty, (120, 40), None, &[], &demand);
    game.wait_for_releases();
    game.send(F12);
    let ending = game.wait_for_end();
    ending.assert_given_back();
    assert_eq!(ending.status.code(), Some(101));
    game.wait_for("had to stop: CELLCASTER_PANIC is set, and F12 was pressed (at");
}

#[test]
fn control_z_returns_to_the_shell_and_fg_repaints() {
    let script = "set -m; \"$0\" play cellar; echo stopped; read line; fg; echo ended";
    let arguments = ["-c", script, PROGRAM];
    let mut player = Player::start((80, 24), Speaks::Kitty, "/bin/sh", arguments, &ENVIRONMENT);
    let taken = |player: &Player| {
        player.wait_until("took the terminal", |emulator| emulator.modes() == TAKEN);
        player.wait_for("? help");
    };
    taken(&player);
    let before = player.look(looks);
    player.send("\x1b[122;5u");
    player.wait_for("stopped");
    assert_eq!(player.modes(), Modes::default());
    assert!(player.attributes_restored());
    player.send("\r");
    taken(&player);
    assert!(player.look(looks) == before, "it was painted otherwise");
    player.send(Key::Char('q').event(1) + &Key::Enter.event(1));
    player.wait_for("ended");
    player.wait_for_end().assert_given_back();
}

#[test]
fn control_z_does_nothing_if_no_shell_could_resume_the_game() {
    let mut game = Game::start();
    game.wait_for_releases();
    game.send("\x1b[122;5u");
    game.wait_until("took the terminal again", |emulator| {
        let taken = b"\x1b[?1049h";
        let times = emulator.bytes().windows(taken.len()).filter(|bytes| bytes == taken).count();
        times == 2 && emulator.modes() == TAKEN
    });
    game.press(Key::Right);
    game.wait_for_arrow("turned", |arrow| arrow.points != '→');
    game.leave();
    game.wait_for_end().assert_given_back();
}

/// The modes that are set while the mouse turns the player.
const TAKEN_WITH_MOUSE: Modes = Modes {
    mouse: (MouseProtocolMode::AnyMotion, MouseProtocolEncoding::Sgr),
    mouse_pixels: true,
    ..TAKEN
};

/// A game with the mouse on, in a terminal that reports its size in pixels.
fn with_mouse() -> Game {
    let game = Game::with(Speaks::Kitty, (80, 24), None, &[], &[("CELLCASTER_PANIC", "1")]);
    game.wait_for_releases();
    game.resize_in_pixels((80, 24), (640, 384));
    game.wait_for_rest();
    game.press(Key::Char('v'));
    game.wait_until("took the mouse", |emulator| emulator.modes() == TAKEN_WITH_MOUSE);
    game
}

/// Mouse motions arrive whenever the game ends, and must not reach the shell.
#[test]
fn the_mouse_is_released_however_the_game_ends() {
    type End = fn(&Game);
    let ends: [End; 5] = [
        |game| game.press(Key::Char('v')),
        |game| game.send("\x1b[99;5u"),
        |game| game.signal(Signal::TERM),
        |game| game.signal(Signal::HUP),
        |game| game.send("\x1b[24~"),
    ];
    for (number, end) in ends.into_iter().enumerate() {
        let mut game = with_mouse();
        game.send("\x1b[<35;300;200M");
        end(&game);
        if number == 0 {
            game.wait_until("gave the mouse back", |emulator| emulator.modes() == TAKEN);
            game.leave();
        }
        game.wait_for_end().assert_given_back();
    }
}

#[test]
fn the_mouse_is_released_on_suspend_and_taken_on_resume() {
    let game = with_mouse();
    game.send("\x1b[122;5u");
    game.wait_until("took the terminal again", |emulator| {
        let enabled = b"\x1b[?1016h";
        let times =
            emulator.bytes().windows(enabled.len()).filter(|bytes| bytes == enabled).count();
        times == 2 && emulator.modes() == TAKEN_WITH_MOUSE
    });
    let bytes = game.bytes();
    let left = b"\x1b[?1003l\x1b[?1006l\x1b[?1016l";
    assert!(bytes.windows(left.len()).any(|bytes| bytes == left), "it was never given back");
}

/// Kills the shell, which closes its terminal.
#[cfg(target_os = "linux")]
#[test]
fn the_game_ends_when_the_terminal_is_gone() {
    let arguments = ["-c", "\"$0\" play cellar; true", PROGRAM];
    let player = Player::start((80, 24), Speaks::Kitty, "/bin/sh", arguments, &ENVIRONMENT);
    player.wait_for("? help");
    let shell = player.process();
    let children = fs::read_to_string(format!("/proc/{shell}/task/{shell}/children")).unwrap();
    let game = children.trim();
    let is_alive = || {
        let status = fs::read_to_string(format!("/proc/{game}/stat"));
        status.is_ok_and(|status| !status.contains(") Z "))
    };
    assert!(is_alive());
    player.signal(Signal::KILL);
    let deadline = Instant::now() + Duration::from_secs(20);
    while is_alive() {
        if Instant::now() > deadline {
            let game = Pid::from_raw(game.parse().unwrap()).unwrap();
            kill_process(game, Signal::KILL).unwrap();
            panic!("it lives on without a terminal");
        }
        thread::sleep(Duration::from_millis(5));
    }
}
