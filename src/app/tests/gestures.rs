//! Gestures: combinations of keys with their timing and their meaning, on every keyboard.

use std::ops::Range;

use super::*;
use crate::game::{Intent, Intents, Script};
use crate::tui::tap_steps;

/// The duration of a tap, in milliseconds.
const TAP: u64 = 60;
/// The longest duration of a step, in milliseconds.
const STEP: u64 = 20;
/// The times for which a key may still count as held after its release, in milliseconds: while a
/// repeat may yet come, after a newer key was held meanwhile, and after a newer key was tapped.
const RELEASED: u64 = 200;
const AFTER_HOLD: u64 = 520;
const AFTER_TAP: u64 = 1400;

/// The keys that move the player, with their intents.
const MOVES: [(Key, Intent); 6] = [
    (W, Intent::Forward),
    (Key::Char('s'), Intent::Back),
    (Key::Char('a'), Intent::StrafeLeft),
    (Key::Char('d'), Intent::StrafeRight),
    (Key::Left, Intent::TurnLeft),
    (Key::Right, Intent::TurnRight),
];
const A: Key = Key::Char('a');
const S: Key = Key::Char('s');
const D: Key = Key::Char('d');
const F: Key = Key::Char('f');
const E: Key = Key::Char('e');
const LEFT: Key = Key::Left;
const RIGHT: Key = Key::Right;

/// The expected effect of a key.
#[derive(Clone, Debug)]
enum Effect {
    /// This number of taps, exact to the step.
    Taps(u32),
    /// The key counts as held throughout `times`, in milliseconds, and no longer than `coasts`
    /// after the end. With a repeating keyboard, the start is later by the keyboard's delay and two
    /// intervals.
    Held { times: Range<u64>, coasts: u64 },
    /// As `Held`, but the start does not depend on the time at which the keyboard begins to repeat.
    HeldAtOnce { times: Range<u64>, coasts: u64 },
}
use Effect::{Held, HeldAtOnce, Taps};

/// A key that is down during a range of milliseconds.
type Stroke = (Key, Range<u64>);

/// The player's intents in each step.
fn wanted(rate: Option<Rate>, strokes: &[Stroke]) -> Vec<Intents> {
    let mut rig = Rig::new(floor(), rate);
    let ends = strokes.iter().map(|(_, times)| times.end).max().unwrap_or(0);
    for milliseconds in 0..=ends {
        // If one key is released and another pressed at the same time, the release comes first.
        for (key, _) in strokes.iter().filter(|(_, times)| times.end == milliseconds) {
            rig.release(*key);
        }
        for (key, _) in strokes.iter().filter(|(_, times)| times.start == milliseconds) {
            rig.press(*key);
        }
        rig.wait(1);
    }
    rig.wait(2000);
    let script = Script::parse(&rig.app.log.script(), "it").unwrap();
    script.iter().map(|(_, intents)| intents).collect()
}

/// Returns true if the player has `intent` at this time after the first key of a gesture.
fn is_wanted(steps: &[Intents], intent: Intent, milliseconds: u64) -> bool {
    // The rig waits for 20 ms before its first use.
    let step = (20 + milliseconds) * 60 / 1000;
    steps.get(step as usize).is_some_and(|intents| intents.contains(intent))
}

/// Checks the effects of a gesture on every keyboard. Keys that are not mentioned must not move the
/// player.
#[track_caller]
fn check(name: &str, strokes: &[Stroke], effects: &[(Key, Effect)]) {
    for rate in keyboards() {
        let steps = wanted(rate, strokes);
        for (key, intent) in MOVES {
            let effect = effects.iter().find(|(other, _)| *other == key);
            let effect = effect.map_or(Taps(0), |(_, effect)| effect.clone());
            let case = format!("{name}: {key} should be {effect:?} with {rate:?}");
            let begins = rate.map_or(0, |(delay, rate)| delay + 2000 / u64::from(rate) + 30);
            let (times, coasts) = match effect {
                Taps(count) => {
                    let tapped = steps.iter().filter(|step| step.contains(intent)).count();
                    assert_eq!(tapped as u32, count * tap_steps(intent), "{case}");
                    continue;
                }
                Held { times, coasts } => (times.start + begins..times.end, coasts),
                HeldAtOnce { times, coasts } => (times, coasts),
            };
            // A step that ends after the release counts the key as up.
            let mut held = (times.start..times.end - STEP).step_by(10);
            let gap = held.find(|&time| !is_wanted(&steps, intent, time));
            assert_eq!(gap, None, "{case}");
            let mut late = (times.end + coasts..times.end + coasts + 2000).step_by(10);
            assert_eq!(late.find(|&time| is_wanted(&steps, intent, time)), None, "{case}");
        }
    }
}

fn held(times: Range<u64>) -> Effect {
    Held { times, coasts: RELEASED }
}

/// All pairs of different keys that move the player, and whether the two cancel each other.
fn pairs() -> impl Iterator<Item = (Key, Key, bool)> {
    MOVES.into_iter().flat_map(|(one, wants)| {
        let others = MOVES.into_iter().filter(move |&(other, _)| other != one);
        others.map(move |(other, also)| (one, other, wants.opposes(also)))
    })
}

#[test]
fn a_tap_before_a_hold_is_recognized() {
    for (adjusts, goes, _) in pairs() {
        for apart in (60..=300).step_by(40) {
            // A finger may leave the first key only after another finger has pressed the second.
            let tap = if apart == 60 { 80 } else { TAP };
            check(
                &format!("{adjusts} tapped for {tap} ms, {goes} after {apart} ms"),
                &[(adjusts, 0..tap), (goes, apart..apart + 1500)],
                &[(adjusts, Taps(1)), (goes, held(apart..apart + 1500))],
            );
        }
    }
}

#[test]
fn taps_around_a_hold_are_recognized() {
    for apart in [80, 140, 220, 300] {
        let times = [0, apart, 2 * apart, 2 * apart + 1800];
        check(
            &format!("→ → W ←, {apart} ms apart"),
            &[
                (RIGHT, times[0]..times[0] + TAP),
                (RIGHT, times[1]..times[1] + TAP),
                (W, times[2]..times[2] + 1500),
                (LEFT, times[3]..times[3] + TAP),
            ],
            &[(RIGHT, Taps(2)), (W, held(times[2]..times[2] + 1500)), (LEFT, Taps(1))],
        );
        check(
            &format!("→ W → W, {apart} ms apart"),
            &[
                (RIGHT, 0..TAP),
                (W, apart..apart + TAP),
                (RIGHT, 2 * apart..2 * apart + TAP),
                (W, 3 * apart..3 * apart + TAP),
            ],
            &[(RIGHT, Taps(2)), (W, Taps(2))],
        );
    }
}

/// The two key presses overlap, or leave a short gap.
#[test]
fn a_newer_key_takes_over_from_a_held_turn() {
    for next in [1410, 1460, 1499, 1520, 1560, 1600] {
        check(
            &format!("→ held for 1500 ms, W after {next} ms"),
            &[(RIGHT, 0..1500), (W, next..next + 1500)],
            &[(RIGHT, held(0..next.min(1500))), (W, held(next..next + 1500))],
        );
        for acts in [F, E, SPACE] {
            check(
                &format!("→ held for 1500 ms, {acts} after {next} ms"),
                &[(RIGHT, 0..1500), (acts, next..next + TAP)],
                &[(RIGHT, held(0..next.min(1500)))],
            );
        }
    }
}

#[test]
fn keys_pressed_together_are_both_held() {
    for (one, other, _) in pairs().filter(|&(.., are_opposed)| !are_opposed) {
        for apart in [0, 20, 40] {
            check(
                &format!("{one} and {other}, {apart} ms apart"),
                &[(one, 0..2500), (other, apart..2500)],
                &[
                    (one, Held { times: apart..2500, coasts: AFTER_HOLD }),
                    (other, held(apart..2500)),
                ],
            );
        }
    }
}

#[test]
fn turning_or_strafing_does_not_stop_a_walk() {
    for also in [RIGHT, LEFT, D, A] {
        check(
            &format!("W, then {also}"),
            &[(W, 0..3500), (also, 1500..3500)],
            &[(W, Held { times: 0..3500, coasts: AFTER_HOLD }), (also, held(1500..3500))],
        );
    }
    for apart in [200, 400, 500, 660] {
        let taps = (0..4).map(|tap| (RIGHT, 1500 + tap * apart..1500 + tap * apart + TAP));
        let ends = 1500 + 3 * apart + TAP;
        let strokes: Vec<Stroke> = [(W, 0..ends)].into_iter().chain(taps).collect();
        check(
            &format!("W, and → tapped every {apart} ms"),
            &strokes,
            &[(W, Held { times: 0..ends, coasts: AFTER_TAP }), (RIGHT, Taps(4))],
        );
    }
    for acts in [F, E] {
        check(
            &format!("W, and {acts} tapped"),
            &[(W, 0..2000), (acts, 1500..1500 + TAP)],
            &[(W, Held { times: 0..2000, coasts: AFTER_TAP })],
        );
    }
}

#[test]
fn a_key_tapped_after_a_walk_is_one_tap() {
    check(
        "W, then S to stop",
        &[(W, 0..1500), (S, 1500..1500 + TAP)],
        &[(W, Held { times: 0..1500, coasts: STEP }), (S, Taps(1))],
    );
    check(
        "W, then → 200 ms later",
        &[(W, 0..1500), (RIGHT, 1700..1700 + TAP)],
        &[(W, held(0..1500)), (RIGHT, Taps(1))],
    );
}

#[test]
fn jumps_do_not_disturb_other_keys() {
    check(
        "W, and Space on the run",
        &[(W, 0..1900), (SPACE, 1500..1500 + TAP)],
        &[(W, Held { times: 0..1900, coasts: AFTER_TAP })],
    );
    for apart in [20, 100, 220] {
        check(
            &format!("W, and Space after {apart} ms"),
            &[(W, 0..900), (SPACE, apart..apart + TAP)],
            &[(W, HeldAtOnce { times: 240..800, coasts: AFTER_TAP })],
        );
    }
    for apart in (60..=300).step_by(40) {
        check(
            &format!("→ tapped, Space after {apart} ms"),
            &[(RIGHT, 0..TAP), (SPACE, apart..apart + TAP)],
            &[(RIGHT, Taps(1))],
        );
        check(
            &format!("A tapped, W after {apart} ms, Space after 200 ms more"),
            &[(A, 0..TAP), (W, apart..apart + 800), (SPACE, apart + 200..apart + 200 + TAP)],
            &[(A, Taps(1)), (W, HeldAtOnce { times: apart + 220..apart + 700, coasts: AFTER_TAP })],
        );
        check(
            &format!("W, A tapped on the run, Space after {apart} ms"),
            &[(W, 0..1900), (A, 1500..1500 + TAP), (SPACE, 1500 + apart..1500 + apart + TAP)],
            &[(A, Taps(1)), (W, Held { times: 0..1900, coasts: AFTER_TAP })],
        );
    }
}
