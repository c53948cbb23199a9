//! The amount and the timing of output: idle visitors, slow terminals, and windows of any size.

use std::time::Duration;

use proptest::prelude::*;

use super::*;
use crate::config::Config;

#[test]
fn idle_visitors_cost_no_bytes() {
    for speaks in [Speaks::Kitty, Speaks::Plain] {
        let mut rig = Rig::new(Mode::Roam);
        let visitors = [
            rig.member("Mara", (80, 24), speaks),
            rig.member("Jon", (80, 24), speaks),
            rig.visitor("Lu", (80, 24), speaks),
        ];
        rig.pump(20_000);
        let bytes = |rig: &Rig| visitors.map(|index| rig.clients[index].bytes());
        let before = bytes(&rig);
        rig.pump(60_000);
        assert_eq!(bytes(&rig), before);
    }
}

#[test]
fn an_unresponsive_terminal_gets_no_second_frame() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.member("Mara", (80, 24), Speaks::Kitty);
    let other = rig.member("Jon", (80, 24), Speaks::Kitty);
    rig.clients[one].set(|conditions| conditions.answers = false);
    rig.pump(20_000);
    let before = rig.clients[one].bytes();
    for _ in 0..60 {
        rig.press(other, "\x1b[119;1:1u");
        rig.press(other, "\x1b[119;1:3u\x1b[98;1:1u\x1b[98;1:3u");
    }
    // At most one frame and the query whether the terminal is still there.
    let more = rig.clients[one].bytes() - before;
    assert!(more < 6_000, "{more}");
    let again = rig.clients[one].bytes();
    rig.pump(30_000);
    assert_eq!(rig.clients[one].bytes(), again);
}

#[test]
fn a_window_without_columns_gets_no_frame_after_the_first() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.member("Mara", (80, 24), Speaks::Kitty);
    for size in [(0, 24), (80, 0), (0, 0)] {
        rig.clients[one].resize(size.0, size.1);
        rig.pump(1_000);
        assert!(rig.session(one, |session, room| session.is_settled(room)), "{size:?}");
    }
}

#[test]
fn actions_carry_the_step_that_was_seen() {
    for milliseconds in [0, 100, 200] {
        let mut rig = Rig::new(Mode::Roam);
        let one = rig.member("Mara", (80, 24), Speaks::Kitty);
        let other = rig.member("Jon", (80, 24), Speaks::Kitty);
        rig.clients[one].set(|link| link.latency = Duration::from_millis(milliseconds));
        rig.send(other, "\x1b[97;1:1u");
        rig.send(other, "\x1b[119;1:1u");
        rig.send(one, "\x1b[119;1:1u");
        let before = rig.logs.text(ROOM).len();
        rig.pump(1_500);
        let log = rig.logs.text(ROOM);
        let lags: Vec<u64> = log[before..].lines().filter_map(lag).collect();
        let expected = milliseconds * 60 / 1_000;
        let late = lags.last().unwrap();
        // Frames come every two or three steps, and the next one at the latest when the previous one is acknowledged.
        assert!((expected..=2 * expected + 5).contains(late), "{milliseconds} ms: {lags:?}");
    }
}

/// The number of steps between the frame that the first member saw and the intents that followed it.
fn lag(entry: &str) -> Option<u64> {
    let mut words = entry.split(' ');
    let step: u64 = words.next()?.parse().ok()?;
    (words.next()? == "want" && words.next()? == "1").then_some(())?;
    Some(step - words.next()?.parse::<u64>().ok()?)
}

#[test]
fn a_key_is_answered_before_the_next_regular_frame() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.member("Mara", (80, 24), Speaks::Kitty);
    let other = rig.member("Jon", (80, 24), Speaks::Kitty);
    rig.live.replace(Config { frames_per_second: 5, ..Config::default() });
    rig.pump(300);
    rig.send(other, "\x1b[119;1:1u");
    rig.pump(400);
    let before = rig.text(one);
    rig.send(one, "\x1b[109;1:1u");
    rig.pump(40);
    assert_ne!(rig.text(one), before, "the map is hidden");
}

/// A rig at this frame rate, with a member whose terminal repeats `key` for a second.
fn holding(key: &str, frames_per_second: u32) -> (Rig, usize) {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.member("Mara", (80, 24), Speaks::Plain);
    rig.live.replace(Config { frames_per_second, ..Config::default() });
    rig.send(one, key);
    rig.pump(507);
    for _ in 0..30 {
        rig.send(one, key);
        rig.pump(33);
    }
    (rig, one)
}

#[test]
fn a_new_key_is_answered_early_while_another_repeats() {
    let (mut rig, one) = holding("\x1b[C", 5);
    let before = rig.text(one);
    rig.send(one, "m");
    rig.pump(60);
    assert_ne!(rig.text(one), before, "the map is hidden");
}

#[test]
fn taps_are_answered_early_while_another_key_repeats() {
    for frames_per_second in [10, 20] {
        let (mut rig, one) = holding("w", frames_per_second);
        let key_time = rig.metrics().key_time.0.clone();
        let (count, sum) = (key_time.count(), key_time.sum());
        for tap in 0..40 {
            rig.send(one, ["l", "\x1b[C"][tap % 2]);
            for _ in 0..10 + tap % 7 {
                rig.send(one, "w");
                rig.pump(33);
            }
        }
        let mean = (key_time.sum() - sum) / (key_time.count() - count) as f64;
        assert!(mean < 0.030, "{mean} s at {frames_per_second} frames a second");
    }
}

#[test]
fn a_held_key_turns_as_far_at_any_frame_rate() {
    let [slow, fast] = [5, 30].map(|frames_per_second| {
        let (mut rig, one) = holding("\x1b[C", frames_per_second);
        rig.pump(1_000);
        let member = rig.member_id(one).unwrap();
        let view = rig.view();
        let player = view.member(member).unwrap().player.unwrap();
        view.game.seen_by(player).unwrap().camera(FieldOfView::default()).heading
    });
    assert_eq!(slow, fast);
}

#[test]
fn keys_without_effect_are_not_timed() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.member("Mara", (80, 24), Speaks::Kitty);
    let other = rig.member("Jon", (80, 24), Speaks::Kitty);
    // An unbound key, and a key that steps back into the wall behind Mara, while Jon takes a step now and then.
    let [unbound, back] = [120, 115].map(|key| format!("\x1b[{key};1:1u\x1b[{key};1:3u"));
    rig.send(one, "\x1b[115;1:1u");
    rig.pump(2_000);
    rig.send(one, "\x1b[115;1:3u");
    rig.pump(1_000);
    for _ in 0..4 {
        for key in [&unbound, &back] {
            rig.send(one, key);
            rig.pump(2_500);
        }
        rig.press(other, "\x1b[119;1:1u\x1b[119;1:3u");
    }
    // Keys that a frame answers: a change of the screen, and an effect in the room.
    let before = rig.metrics().key_time.0.count();
    for key in ["\x1b[109;1:1u\x1b[109;1:3u", "\x1b[1;1:1C", "\x1b[1;1:3C"] {
        rig.press(one, key);
    }
    let key_time = &rig.metrics().key_time.0;
    let (count, mean) = (key_time.count(), key_time.sum() / key_time.count() as f64);
    assert!((2..=3).contains(&(count - before)), "{before} and {count}");
    assert!(mean < 0.05, "{mean} s");
}

/// An action of a hostile or unlucky client.
#[derive(Clone, Debug)]
enum Event {
    Bytes(Vec<u8>),
    Resize(u16, u16),
    Wait(u64),
    Other,
}

fn events() -> impl Strategy<Value = Vec<Event>> {
    let keys = prop::sample::select(vec![
        "\r", "\x1b", "\t", "1", ";", "/", "w", "d", "p", "?", "\x1b[A", "\x1b[B", "x", " ", "m",
    ]);
    let size = prop_oneof![0_u16..4, 0_u16..30, 60_u16..260];
    let event = prop_oneof![
        6 => keys.prop_map(|key| Event::Bytes(key.as_bytes().to_vec())),
        2 => prop::collection::vec(any::<u8>(), 0..40).prop_map(Event::Bytes),
        3 => (size.clone(), size).prop_map(|(columns, rows)| Event::Resize(columns, rows)),
        3 => (0_u64..1_000).prop_map(Event::Wait),
        1 => Just(Event::Other),
    ];
    prop::collection::vec(event, 0..40)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn no_input_breaks_a_session(
        events in events(),
        mode in prop::sample::select(&Mode::ALL[..5]),
    ) {
        let mut rig = Rig::new(mode);
        let one = rig.visitor("Mara", (80, 24), Speaks::Kitty);
        let other = rig.member("Jon", (40, 12), Speaks::Kitty);
        for _ in 0..3 {
            rig.press(one, ENTER);
        }
        for event in events {
            match event {
                Event::Bytes(bytes) => rig.send(one, bytes),
                Event::Resize(columns, rows) => rig.clients[one].resize(columns, rows),
                Event::Wait(milliseconds) => rig.pump(milliseconds),
                Event::Other => rig.press(other, "\x1b[119;1:1u"),
            }
        }
        rig.pump(300);
    }
}
