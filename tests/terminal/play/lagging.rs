//! The game on a link that lags, stalls, or loses answers.

use std::thread;
use std::time::Duration;

use super::game::{Game, Key};
use crate::emulator::{Modes, Speaks};

fn turning() -> Game {
    let game = Game::start();
    game.press(Key::Right);
    game.wait_for_arrow("turned", |arrow| arrow.points != '→');
    game
}

#[test]
fn few_frames_are_in_flight_and_lost_answers_do_not_end_the_game() {
    let game = turning();
    game.lose_statuses(true);
    // Answers count as lost only after a while.
    thread::sleep(Duration::from_millis(800));
    let unanswered = game.lost_statuses();
    assert!((1..=4).contains(&unanswered), "{unanswered} frames are unanswered");
    let before = game.arrow();
    game.wait_for_arrow("went on turning", |arrow| arrow.points != before.points);
    game.lose_statuses(false);
    let before = game.bytes_written();
    game.wait_until("went on", |emulator| emulator.bytes().len() > before + 10_000);
}

#[test]
fn keys_act_while_the_link_is_stuck() {
    let mut game = turning();
    game.set_reading(false);
    game.wait_until_full();
    game.send(Key::Char('q').event(1) + &Key::Enter.event(1));
    let ending = game.wait_for_end();
    assert!(ending.status.success());
    assert_eq!(ending.modes, Modes::default());
    assert!(ending.attributes_restored);
}

#[test]
fn the_newest_frame_comes_next_after_a_stuck_link() {
    let game = turning();
    game.set_reading(false);
    game.wait_until_full();
    let before = game.bytes_written();
    thread::sleep(Duration::from_secs(1));
    game.release(Key::Right);
    thread::sleep(Duration::from_millis(200));
    game.set_reading(true);
    game.wait_for_rest();
    // The frames are the ones that were stuck, a few coarse frames after the stall, and the frames
    // that make the newest one exact. None of the 36 frames in between is sent.
    let frames = game.look(|emulator| {
        emulator.bytes()[before..].windows(8).filter(|bytes| bytes == b"\x1b[?2026l").count()
    });
    assert!(frames <= 22, "{frames} frames");
}

#[test]
fn the_game_plays_in_a_terminal_that_never_answers() {
    for speaks in [Speaks::Nothing, Speaks::Plain] {
        let game = Game::with(speaks, (80, 24), None, &[], &[]);
        for _ in 0..3 {
            let before = game.arrow();
            for _ in 0..20 {
                game.send("\x1b[C");
                thread::sleep(Duration::from_millis(30));
            }
            game.wait_for_arrow("turned", |arrow| arrow.points != before.points);
        }
        let bytes = game.bytes();
        let requests = bytes.windows(4).filter(|bytes| bytes == b"\x1b[5n").count();
        assert!(requests <= 4, "{requests} requests to a terminal that {speaks:?} answers");
    }
}

#[test]
fn stats_show_on_demand_and_stop_with_the_game() {
    let game = turning();
    assert!(!game.text().contains(" fps "));
    game.press(Key::Char('i'));
    game.wait_for(" fps ");
    game.wait_for("fidelity exact");
    game.release(Key::Right);
    game.wait_for_rest();
    game.press(Key::Char('i'));
    game.wait_until("hid them", |emulator| !emulator.text().contains(" fps "));
    let game = Game::with(Speaks::Kitty, (80, 24), None, &["--stats", "--fidelity", "low"], &[]);
    game.press(Key::Right);
    game.wait_for("fidelity low");
}
