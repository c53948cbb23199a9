//! Questions, and the keys that answer them.

use super::*;

/// A level whose exit is a few cells ahead.
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

/// A game at the exit. `key` is held for the last `milliseconds` before the panel appears.
fn at_the_exit(rate: Option<Rate>, key: Key, milliseconds: u64) -> Rig {
    let mut rig = start(rate);
    rig.tap(Key::Char('g'), 10);
    // The player reaches the exit after 1570 ms.
    rig.wait(1590 - milliseconds);
    rig.press(key);
    while rig.app.screen() == AppScreen::Playing {
        rig.wait(1);
    }
    rig
}

#[test]
fn only_a_fresh_press_confirms() {
    for rate in [None, Some((250, 15)), Some((500, 30)), Some((660, 40))] {
        for milliseconds in (20..1500).step_by(70) {
            for key in [SPACE, ENTER] {
                let mut rig = at_the_exit(rate, key, milliseconds);
                rig.wait(3000);
                assert_eq!(rig.app.screen(), AppScreen::LevelDone, "{rate:?} {milliseconds} {key}");
                rig.release(key);
                rig.wait(400);
                rig.tap(ENTER, 50);
                rig.wait(200);
                assert_eq!(rig.app.screen(), AppScreen::End, "{rate:?} {milliseconds} {key}");
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
        assert_eq!(rig.app.screen(), AppScreen::LevelDone);
        // The time until the second press could be the keyboard's delay.
        rig.wait(400);
        rig.tap(ENTER, 50);
        rig.wait(200);
        assert_eq!(rig.app.screen(), AppScreen::End);
        rig.tap(ENTER, 50);
        rig.wait(1000);
        assert!(!rig.app.has_left);
        rig.tap(ENTER, 50);
        rig.wait(200);
        assert!(rig.app.has_left);
    }
}

/// A corridor of spikes.
const DEADLY: &str = r##"
grid = '''
####################
#^^^^^^^^@^^^^^^^^^#
####################
'''
[tiles]
"#" = { wall = "brick" }
[things]
"@" = { start = 0 }
"^" = { spikes = 1.0 }
"##;

/// A game whose player walks over spikes until a walking key is pressed.
fn on_spikes(rate: Option<Rate>) -> Rig {
    let mut rig = Rig::new(parse_str(DEADLY).unwrap(), rate);
    rig.tap(Key::Char('g'), 10);
    rig.wait(100);
    rig
}

/// Waits until the player is dead. Returns the time in milliseconds.
fn wait_for_death(rig: &mut Rig) -> u64 {
    for milliseconds in 0..20_000 {
        if rig.app.screen() == AppScreen::Dead {
            return milliseconds;
        }
        rig.wait(1);
    }
    panic!("alive at {} with {:?}", rig.position(), rig.game().health());
}

const KEYBOARDS: [Option<Rate>; 4] = [None, Some((250, 15)), Some((500, 30)), Some((660, 40))];

#[test]
fn keys_held_at_death_do_nothing_on_the_panel() {
    for rate in KEYBOARDS {
        let lives = wait_for_death(&mut on_spikes(rate));
        let letters = ['w', 's', 'r', 'l', 'd', ' '].map(Key::Char);
        for key in letters.into_iter().chain([Key::Up, Key::Down, ENTER]) {
            for milliseconds in [20, 200, 620, 1400] {
                let case = format!("{key} pressed {milliseconds} ms before the death, {rate:?}");
                let mut rig = on_spikes(rate);
                rig.wait(lives - milliseconds);
                rig.press(key);
                wait_for_death(&mut rig);
                rig.wait(3000);
                let shown = (rig.app.screen(), rig.app.pages.menu.selected(), rig.app.has_left);
                assert_eq!(shown, (AppScreen::Dead, 0, false), "{case}");
                rig.release(key);
                rig.wait(400);
                rig.tap(ENTER, 50);
                rig.wait(200);
                let goes_on = (rig.app.screen(), rig.game().tally().deaths);
                assert_eq!(goes_on, (AppScreen::Playing, 1), "{case}");
            }
        }
    }
}

#[test]
fn a_panel_waits_for_held_keys_to_be_released_or_one_second() {
    for (released, answered, is_answered) in [
        (Some(100), 300, false),
        (Some(100), 600, true),
        (Some(700), 600, false),
        (Some(700), 800, true),
        (None, 950, false),
        (None, 1050, true),
    ] {
        let mut rig = on_spikes(None);
        rig.press(W);
        wait_for_death(&mut rig);
        for milliseconds in 0..answered {
            if released == Some(milliseconds) {
                rig.release(W);
            }
            rig.wait(1);
        }
        rig.tap(ENTER, 10);
        let case = format!("released after {released:?} ms, answered after {answered}");
        assert_eq!(rig.app.screen() == AppScreen::Playing, is_answered, "{case}");
    }
    // Without release reports, a repeating key is up once it stops repeating. A tapped key may be
    // down for as long as the first repeat may take.
    for (key_lasts, answered, is_answered) in
        [(300, 550, true), (3000, 900, false), (3000, 1050, true)]
    {
        let mut rig = on_spikes(Some((500, 30)));
        rig.press(W);
        wait_for_death(&mut rig);
        for milliseconds in 0..answered {
            if milliseconds == key_lasts {
                rig.release(W);
            }
            rig.wait(1);
        }
        rig.tap(ENTER, 10);
        let case = format!("released after {key_lasts} ms, answered after {answered}");
        assert_eq!(rig.app.screen() == AppScreen::Playing, is_answered, "{case}");
    }
}

#[test]
fn a_result_obeys_only_enter_and_arrows_and_does_not_wrap() {
    let dead = |rate| {
        let mut rig = on_spikes(rate);
        wait_for_death(&mut rig);
        rig
    };
    let won = |rate| at_the_exit(rate, Key::Char('k'), 1);
    for rate in KEYBOARDS {
        for result in [&dead as &dyn Fn(_) -> _, &won] {
            let mut rig = result(rate);
            rig.release(Key::Char('k'));
            rig.wait(1100);
            let screen = rig.app.screen();
            let named = [
                Key::Left,
                Key::Right,
                Key::Escape,
                Key::Backspace,
                Key::PageDown,
                Key::End,
                Key::Tab,
            ];
            for key in (' '..='~').map(Key::Char).chain(named) {
                rig.tap(key, 20);
                rig.wait(20);
                let shown = (rig.app.screen(), rig.app.pages.menu.selected(), rig.app.has_left);
                assert_eq!(shown, (screen, 0, false), "{key}");
            }
            for (key, selected) in [
                (Key::Up, 0),
                (Key::Down, 1),
                (Key::Down, 2),
                (Key::Down, 2),
                (Key::Up, 1),
                (Key::Up, 0),
                (Key::Up, 0),
            ] {
                rig.tap(key, 20);
                rig.wait(300);
                assert_eq!(rig.app.pages.menu.selected(), selected, "{screen:?} {key} {rate:?}");
            }
            rig.tap(Key::Down, 20);
            rig.tap(Key::Down, 20);
            rig.tap(ENTER, 20);
            assert!(rig.app.has_left, "{rate:?}");
        }
    }
}

#[test]
fn escape_closes_help_and_pause_and_leaving_asks_once() {
    for rate in [None, Some((500, 30))] {
        let mut rig = start(rate);
        for opens in ['?', 'p'] {
            rig.tap(Key::Char(opens), 50);
            assert_ne!(rig.app.screen(), AppScreen::Playing);
            rig.tap(Key::Escape, 50);
            assert_eq!(rig.app.screen(), AppScreen::Playing, "after {opens}");
            rig.wait(2000);
        }
        for (asks, goes_on) in [('q', Key::Escape), ('q', W), ('q', SPACE)] {
            rig.tap(Key::Char(asks), 50);
            assert_eq!(rig.app.screen(), AppScreen::Leaving);
            rig.tap(goes_on, 50);
            assert_eq!((rig.app.screen(), rig.app.has_left), (AppScreen::Playing, false));
            rig.wait(2000);
        }
        // A held key must not confirm the question that it opened.
        rig.press(Key::Char('q'));
        rig.wait(3000);
        assert_eq!((rig.app.screen(), rig.app.has_left), (AppScreen::Leaving, false));
        rig.release(Key::Char('q'));
        rig.wait(1000);
        rig.tap(Key::Char('q'), 50);
        rig.wait(200);
        assert!(rig.app.has_left);

        let mut rig = start(rate);
        rig.tap(Key::Escape, 50);
        assert_eq!(rig.app.screen(), AppScreen::Leaving);
        rig.tap(ENTER, 50);
        assert!(rig.app.has_left);
    }
}
