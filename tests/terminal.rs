//! A session in a real terminal: it is taken, used, and always given back.
//!
//! The program under test is this one: it starts itself again, under a pseudo-terminal, to run
//! nothing but [`program`].
#![cfg(all(unix, feature = "terminal"))]

#[path = "support/emulator.rs"]
mod emulator;
#[path = "support/player.rs"]
mod player;

use std::env;
use std::time::Duration;

use cellcaster::terminal::{Event, Key, Options, Phase, Session};
use ratatui::widgets::{Paragraph, Wrap};
use rustix::process::Signal;

use self::emulator::{Modes, Speaks};
use self::player::Player;

const ROLE: &str = "PROGRAM_UNDER_TEST";
const ITSELF: [&str; 4] = ["--exact", "program", "--nocapture", "--test-threads=1"];

/// Shows the events that arrive, and does what the keys say. Only a process that was started for
/// it has the role.
#[test]
fn program() {
    if env::var_os(ROLE).is_none() {
        return;
    }
    let variable = |name: &str| env::var(name).ok();
    let mut session = Session::enter(Options::from_environment(variable))
        .unwrap_or_else(|error| panic!("{error}"));
    let mut lines = vec!["ready".to_owned()];
    loop {
        show(&mut session, &lines.join("\n"));
        let Some(event) = session.next_event(None).unwrap() else { continue };
        lines.push(describe(&session, event));
        let excess = lines.len().saturating_sub(usize::from(session.size().rows));
        lines.drain(..excess);
        match event {
            Event::Suspend => session.suspend().unwrap(),
            Event::Quit(_) => return,
            Event::Key(key) if key.phase == Phase::Press => match key.key {
                Key::Char('q') => return,
                Key::Char('p') => panic!("as asked"),
                Key::Char('x') => drop(std::thread::spawn(|| panic!("beside")).join()),
                Key::Char('h') => hang(&mut session),
                Key::Char('f') => flood(&mut session),
                _ => {}
            },
            _ => {}
        }
    }
}

fn describe(session: &Session, event: Event) -> String {
    match event {
        Event::Key(key) => format!("{:?} {}", key.phase, key.key),
        Event::Resized => format!("{} by {}", session.size().columns, session.size().rows),
        other => format!("{other:?}"),
    }
}

/// Neither draws nor listens any more.
fn hang(session: &mut Session) -> ! {
    show(session, "hanging");
    loop {
        std::thread::sleep(Duration::from_secs(1));
    }
}

/// Draws for as long as the terminal takes it.
fn flood(session: &mut Session) {
    for count in 0_u64.. {
        show(session, &format!("{count:09}{}", "*".repeat(30)).repeat(24));
    }
}

fn show(session: &mut Session, text: &str) {
    let text = Paragraph::new(text).wrap(Wrap { trim: false });
    session.draw(|frame| frame.render_widget(text, frame.area())).unwrap();
}

fn start(speaks: Speaks) -> Player {
    start_with(speaks, &[])
}

fn start_with(speaks: Speaks, environment: &[(&str, &str)]) -> Player {
    let environment = [&[(ROLE, "yes")], environment].concat();
    let player = Player::start((40, 24), speaks, env::current_exe().unwrap(), ITSELF, &environment);
    player.wait_for("ready");
    player
}

const TAKEN: Modes = Modes {
    alternate_screen: true,
    cursor_hidden: true,
    wrap: false,
    synchronized: false,
    key_flags: [0, 0],
};

#[test]
fn the_first_frame_waits_for_no_answer_and_quitting_gives_the_terminal_back() {
    let mut player = start(Speaks::Nothing);
    player.wait_until("took the terminal", |emulator| emulator.modes() == TAKEN);
    assert!(!player.attributes_restored());
    player.send("q");
    let ending = player.wait_for_end();
    ending.assert_given_back();
    assert!(ending.status.success());
}

#[test]
fn answers_are_never_seen_as_keys() {
    let mut player = start(Speaks::Plain);
    player.wait_for("KeyReleases(false)");
    player.send("w");
    player.wait_for("Press w");
    assert_eq!(player.text().matches("Press").count(), 1, "{}", player.text());
    player.send("q");
    player.wait_for_end().assert_given_back();
}

#[test]
fn releases_are_reported_where_the_terminal_can_and_none_leaks_into_the_shell() {
    let mut player = start(Speaks::Kitty);
    player.wait_for("KeyReleases(true)");
    player.wait_until("pushed the flags", |emulator| emulator.modes().key_flags == [0, 1]);
    player.send("\x1b[119;1u\x1b[119;1:3u");
    player.wait_for("Release w");
    player.send("\x1b[113u");
    player.wait_for_end().assert_given_back();
}

#[test]
fn the_colour_depth_is_raised_where_the_terminal_says_so_and_was_not_known() {
    let mut guessed = start(Speaks::Kitty);
    guessed.wait_for("ColorDepth(True)");
    guessed.send("q");
    guessed.wait_for_end().assert_given_back();

    let mut known = start_with(Speaks::Kitty, &[("COLORTERM", "truecolor")]);
    known.wait_for("KeyReleases(true)");
    assert!(!known.text().contains("ColorDepth"), "{}", known.text());
    known.send("q");
    known.wait_for_end().assert_given_back();
}

#[test]
fn a_multiplexer_is_not_trusted_with_releases() {
    let mut player = start_with(Speaks::Kitty, &[("TMUX", "/tmp/socket,1,0")]);
    player.send("q");
    player.wait_for_end().assert_given_back();
    let pushed = player.bytes().windows(2).any(|bytes| bytes == b"[>");
    assert!(!pushed, "the flags were pushed");
}

#[test]
fn escape_arrives_by_itself() {
    let mut player = start(Speaks::Plain);
    player.send("\x1b");
    player.wait_for("Press escape");
    player.send("q");
    player.wait_for_end().assert_given_back();
}

#[test]
fn a_resized_window_is_reported_and_painted_in_its_new_size() {
    let mut player = start(Speaks::Plain);
    player.resize(60, 5);
    player.wait_for("60 by 5");
    player.resize(1, 1);
    player.resize(50, 20);
    player.wait_for("50 by 20");
    player.send("q");
    player.wait_for_end().assert_given_back();
}

#[test]
fn a_panic_gives_the_terminal_back_and_then_says_one_sentence() {
    let mut player = start(Speaks::Kitty);
    player.wait_for("KeyReleases(true)");
    player.send("\x1b[112u");
    let ending = player.wait_for_end();
    ending.assert_given_back();
    assert_eq!(ending.status.code(), Some(101));
    player.wait_for("had to end: as asked (at");
}

#[test]
fn a_panic_in_another_thread_ends_the_session() {
    let mut player = start(Speaks::Plain);
    player.send("x");
    player.wait_for_end().assert_given_back();
    player.wait_for("had to end: beside");
}

#[test]
fn control_c_and_the_signals_that_end_a_program_give_the_terminal_back() {
    let mut player = start(Speaks::Plain);
    player.send("\x03");
    player.wait_for_end().assert_given_back();
    for signal in [Signal::TERM, Signal::INT, Signal::HUP] {
        let mut player = start(Speaks::Kitty);
        player.wait_for("KeyReleases(true)");
        player.signal(signal);
        let ending = player.wait_for_end();
        ending.assert_given_back();
        assert!(ending.status.success(), "{ending:?}");
    }
}

#[test]
fn a_program_that_hangs_is_ended_all_the_same() {
    let mut player = start(Speaks::Kitty);
    player.wait_for("KeyReleases(true)");
    player.send("\x1b[104u");
    player.wait_for("hanging");
    player.signal(Signal::TERM);
    let ending = player.wait_for_end();
    ending.assert_given_back();
    assert_eq!(ending.signal(), Some(Signal::TERM.as_raw()));
}

#[test]
fn a_program_whose_terminal_takes_no_bytes_is_ended_all_the_same() {
    let mut player = start(Speaks::Plain);
    player.send("f");
    player.wait_for("00000001");
    player.set_reading(false);
    player.wait_until_full();
    player.signal(Signal::TERM);
    player.wait_for_end().assert_given_back();
}

#[test]
fn a_suspended_program_gives_the_terminal_back_and_takes_it_again() {
    let script = "set -m; \"$0\" \"$@\"; echo stopped; read line; fg; echo ended";
    let program = env::current_exe().unwrap();
    let arguments = ["-c".as_ref(), script.as_ref(), program.as_os_str()]
        .into_iter()
        .chain(ITSELF.iter().map(AsRef::as_ref));
    let mut player = Player::start((40, 24), Speaks::Kitty, "/bin/sh", arguments, &[(ROLE, "yes")]);
    player.wait_for("KeyReleases(true)");
    player.send("\x1b[122;5u");
    player.wait_for("stopped");
    assert_eq!(player.modes(), Modes::default());
    assert!(player.attributes_restored());
    player.send("\r");
    player.wait_until("taken again", |emulator| {
        emulator.modes() == Modes { key_flags: [0, 1], ..TAKEN }
            && emulator.text().contains("40 by 24")
    });
    player.send("\x1b[113u");
    player.wait_for("ended");
    player.wait_for_end().assert_given_back();
}

#[test]
fn a_program_that_no_shell_would_continue_does_not_stop() {
    let mut player = start(Speaks::Plain);
    player.send("\x1a");
    player.wait_for("40 by 24");
    player.send("q");
    player.wait_for_end().assert_given_back();
}

#[test]
fn without_a_terminal_the_error_names_what_works() {
    let mut player = Player::start(
        (80, 24),
        Speaks::Plain,
        "/bin/sh",
        [
            "-c",
            "\"$0\" --exact program --nocapture < /dev/null",
            env::current_exe().unwrap().to_str().unwrap(),
        ],
        &[(ROLE, "yes")],
    );
    player.wait_for_end().assert_given_back();
    let said = String::from_utf8_lossy(&player.bytes()).into_owned();
    assert!(said.contains("standard input is not a terminal"), "{said}");
    assert!(said.contains("`cellcaster snapshot`"), "{said}");
}
