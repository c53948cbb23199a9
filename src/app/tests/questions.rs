//! Questions, and the keys that answer them.

use super::*;

/// The exit is a few cells ahead.
const WAY_OUT: &str = r##"
grid = '''
#########
#@....X.#
#########
'''
[tiles]
"#" = { wall = "brick" }
[things]
"@" = { start = 0 }
"X" = { exit = true }
"##;

const ENTER: Key = Key::Enter;

fn start(rate: Option<Rate>) -> Rig {
    Rig::new(parse_str(WAY_OUT).unwrap(), rate)
}

/// A game at the exit, with `key` held for `milliseconds` before the panel appears.
fn at_the_exit(rate: Option<Rate>, key: Key, milliseconds: u64) -> Rig {
    let mut rig = start(rate);
    rig.tap(Key::Char('g'), 10);
    // The exit is reached after 1570 ms.
    rig.wait(1590 - milliseconds);
    rig.press(key);
    while rig.app.screen == Screen::Playing {
        rig.wait(1);
    }
    rig
}

#[test]
fn a_repetition_confirms_nothing_and_a_fresh_press_does() {
    for rate in [None, Some((250, 15)), Some((500, 30)), Some((660, 40))] {
        for milliseconds in (20..1500).step_by(70) {
            for key in [SPACE, ENTER] {
                let mut rig = at_the_exit(rate, key, milliseconds);
                rig.wait(3000);
                assert_eq!(rig.app.screen, Screen::LevelDone, "{rate:?} {milliseconds} {key}");
                rig.release(key);
                rig.wait(400);
                rig.tap(key, 50);
                rig.wait(200);
                assert_eq!(rig.app.screen, Screen::End, "{rate:?} {milliseconds} {key}");
            }
        }
    }
}

#[test]
fn nothing_confirms_in_the_first_half_second() {
    for rate in [None, Some((500, 30))] {
        let mut rig = at_the_exit(rate, Key::Char('k'), 50);
        rig.release(Key::Char('k'));
        rig.wait(300);
        rig.tap(ENTER, 50);
        assert_eq!(rig.app.screen, Screen::LevelDone);
        // The time to the second press could be the keyboard's delay.
        rig.wait(400);
        rig.tap(ENTER, 50);
        rig.wait(200);
        assert_eq!(rig.app.screen, Screen::End);
        rig.tap(ENTER, 50);
        rig.wait(600);
        assert!(!rig.app.has_left);
        rig.tap(ENTER, 50);
        rig.wait(200);
        assert!(rig.app.has_left);
    }
}

#[test]
fn escape_closes_help_and_pause_and_leaving_is_asked_once() {
    for rate in [None, Some((500, 30))] {
        let mut rig = start(rate);
        for opens in ['?', 'p'] {
            rig.tap(Key::Char(opens), 50);
            assert_ne!(rig.app.screen, Screen::Playing);
            rig.tap(Key::Escape, 50);
            assert_eq!(rig.app.screen, Screen::Playing, "after {opens}");
            rig.wait(2000);
        }
        for (asks, goes_on) in [('q', Key::Escape), ('q', W), ('q', SPACE)] {
            rig.tap(Key::Char(asks), 50);
            assert_eq!(rig.app.screen, Screen::Leaving);
            rig.tap(goes_on, 50);
            assert_eq!((rig.app.screen, rig.app.has_left), (Screen::Playing, false));
            rig.wait(2000);
        }
        // A held key does not confirm its own question.
        rig.press(Key::Char('q'));
        rig.wait(3000);
        assert_eq!((rig.app.screen, rig.app.has_left), (Screen::Leaving, false));
        rig.release(Key::Char('q'));
        rig.wait(1000);
        rig.tap(Key::Char('q'), 50);
        rig.wait(200);
        assert!(rig.app.has_left);

        let mut rig = start(rate);
        rig.tap(Key::Escape, 50);
        assert_eq!(rig.app.screen, Screen::Leaving);
        rig.tap(ENTER, 50);
        assert!(rig.app.has_left);
    }
}
