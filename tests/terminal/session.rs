//! Properties of a session that no game can show: the end of a program that hangs, or that panics
//! outside its session.
//!
//! The program under test is this test program. It starts itself again, in a pseudo-terminal, to
//! run only [`program`].
#![cfg(all(unix, feature = "terminal"))]

use std::env;
use std::thread;
use std::time::Duration;

use cellcaster::terminal::{Event, Key, Phase, Session, SessionOptions};
use cellcaster::tui::canvas::Canvas;
use ratatui::widgets::{Paragraph, Wrap};
use rustix::process::Signal;

use crate::emulator::{Modes, Speaks};
use crate::player::Player;

const ROLE: &str = "PROGRAM_UNDER_TEST";
const ITSELF: [&str; 4] = ["--exact", "session::program", "--nocapture", "--test-threads=1"];

/// Shows the events that arrive, and obeys keys. Does nothing unless the process was started for
/// this purpose.
#[test]
fn program() {
    if env::var_os(ROLE).is_none() {
        return;
    }
    let variable = |name: &str| env::var(name).ok();
    let mut session = Session::enter(SessionOptions::from_environment(variable)).unwrap();
    let mut lines = vec!["ready".to_owned()];
    loop {
        show(&mut session, &lines.join("\n"));
        let Some(event) = session.next_event(None).unwrap() else { continue };
        lines.push(format!("{event:?}"));
        match event {
            Event::Quit(_) => return,
            Event::Key(key) if key.phase == Phase::Press => match key.key {
                Key::Char('q') => return,
                Key::Char('x') => drop(thread::spawn(|| panic!("beside")).join()),
                Key::Char('h') => hang(&mut session),
                Key::Char('m') => session.set_mouse(true).unwrap(),
                _ => {}
            },
            _ => {}
        }
    }
}

/// Stops drawing and reading.
fn hang(session: &mut Session) -> ! {
    show(session, "hanging");
    loop {
        thread::park();
    }
}

fn show(session: &mut Session, text: &str) {
    let text = Paragraph::new(text).wrap(Wrap { trim: false });
    session.draw(|screen| screen.draw_widget(text, screen.bounds())).unwrap();
}

fn start(speaks: Speaks) -> Player {
    let itself = env::current_exe().unwrap();
    let player = Player::start((80, 24), speaks, itself, ITSELF, &[(ROLE, "yes")]);
    player.wait_for("ready");
    player
}

/// The palette entries that are probed, and reset at once.
const PROBED: &str = "254;255";

/// Asserts that exactly the palette entries that may be defined were reset.
fn assert_palette_given_back(player: &Player) {
    let text = String::from_utf8(player.bytes()).unwrap();
    assert!(text.contains("\x1b]4;255;?\x07"), "the palette was not asked for");
    let lists = text.split("\x1b]104;").skip(1).map(|rest| rest.split_once('\x07').unwrap().0);
    let all = lists.skip_while(|list| *list == PROBED);
    let entries: Vec<u8> =
        all.flat_map(|list| list.split(';').map(|entry| entry.parse().unwrap())).collect();
    assert_eq!(entries, (24..=255).collect::<Vec<u8>>());
}

#[test]
fn answers_are_never_seen_as_keys() {
    let mut player = start(Speaks::Plain);
    player.wait_for("KeyReleases(false)");
    // The answers that report the repetition of a half block and the definition of the palette.
    player.send("\x1b[2;5R\x1b[2;2R\x1b]4;255;rgb:1212/abab/5656\x1b\\\x1b]4;255;rgb:0/0/0\x07");
    player.send("w");
    player.wait_for("Char('w')");
    assert_eq!(player.text().matches("Key(").count(), 1, "{}", player.text());
    player.send("q");
    player.wait_for_end().assert_given_back();
    assert_palette_given_back(&player);
}

#[test]
fn the_mouse_uses_pixels_once_the_terminal_reports_their_number() {
    let mut player = start(Speaks::Kitty);
    player.wait_for("KeyReleases(true)");
    player.send("\x1b[109u");
    let cells = "\x1b[<35;9;17M";
    player.wait_until("took the mouse", |emulator| {
        emulator.modes().mouse != Modes::default().mouse && !emulator.modes().mouse_pixels
    });
    player.send(cells);
    player.wait_for("x: 544, y: 1056, kind: Moved");
    player.resize_in_pixels((80, 24), (640, 384));
    player.wait_until("asked for pixels", |emulator| emulator.modes().mouse_pixels);
    // The program drops events that arrive before the terminal has changed units.
    for _ in 0..500 {
        player.send(cells);
        thread::sleep(Duration::from_millis(10));
        if player.text().contains("x: 64, y: 64, kind: Moved") {
            player.send("\x1b[113u");
            return player.wait_for_end().assert_given_back();
        }
    }
    panic!("no place was in pixels; the screen:\n{}", player.text());
}

/// Apple's Terminal prints the last character of a query (DECRQM) that it does not understand.
#[test]
fn query_text_printed_by_a_terminal_is_erased() {
    const QUERY: &str = "\x1b[?1016$p";
    let written = |environment: &[(&str, &str)]| {
        let environment = [&[(ROLE, "yes")], environment].concat();
        let itself = env::current_exe().unwrap();
        let player = Player::start((80, 24), Speaks::Plain, itself, ITSELF, &environment);
        player.wait_for("ready");
        String::from_utf8(player.bytes()).unwrap()
    };
    let text = written(&[]);
    let (_, after) = text.split_once(QUERY).unwrap();
    let (before_frame, _) = after.split_once("\x1b[?2026h").unwrap();
    let (_, after) = before_frame.split_once("\x1b[H\x1b[J").unwrap();
    assert_eq!(after, "\x1b[5n\x1b[c");
    assert!(!written(&[("TERM_PROGRAM", "Apple_Terminal")]).contains(QUERY));
}

#[test]
fn focus_changes_are_reported() {
    let mut player = start(Speaks::Plain);
    player.send("\x1b[O");
    player.wait_for("FocusLost");
    player.send("\x1b[I");
    player.wait_for("FocusGained");
    player.send("q");
    player.wait_for_end().assert_given_back();
}

#[test]
fn a_panic_in_another_thread_ends_the_session() {
    let mut player = start(Speaks::Plain);
    player.send("x");
    player.wait_for_end().assert_given_back();
    assert_palette_given_back(&player);
    player.wait_for("had to stop: beside");
}

#[test]
fn a_signal_ends_a_hanging_program() {
    let mut player = start(Speaks::Kitty);
    player.wait_for("KeyReleases(true)");
    player.send("\x1b[104u");
    player.wait_for("hanging");
    player.signal(Signal::TERM);
    let ending = player.wait_for_end();
    ending.assert_given_back();
    assert_eq!(ending.signal(), Some(Signal::TERM.as_raw()));
    assert_palette_given_back(&player);
}
