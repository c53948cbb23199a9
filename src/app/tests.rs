//! The keys of the game in simulated time, from timed bytes to the player's motion.

mod by_default;
mod colours;
mod gestures;
mod guards;
mod interruption;
mod kept;
mod missions;
mod panels;
mod playback;
mod questions;
mod rebinding;
mod redraws;
mod saved;
mod screens;
mod taking_back;
mod taps;
mod titles;
mod tmux_offers;

use std::iter;
use std::time::Duration;

use glam::DVec2;

use super::*;
use crate::app::store::Store;
use crate::game::{Game, Rank, Tally};
use crate::map::{Level, parse_str};
use crate::terminal::{Key, KeyEvent, Modifiers, Phase};
use crate::tui::held::tests::Keyboard;
use crate::world::{FieldOfView, World};

const W: Key = Key::Char('w');
const SPACE: Key = Key::Char(' ');

/// A keyboard's delay in milliseconds, and its repeats per second.
type Rate = (u64, u32);

/// A game with a keyboard. Without a rate, the terminal reports key releases.
struct Rig {
    app: App,
    keyboard: Option<Keyboard<Key>>,
    now: Duration,
}

impl Rig {
    fn new(world: World, rate: Option<Rate>) -> Self {
        let levels = Levels::new(Level::Grid(Box::new(world)), iter::empty());
        Self::of(App::new(levels, Settings::default()), rate)
    }

    fn of(mut app: App, rate: Option<Rate>) -> Self {
        app.controls.held.set_reports_releases(rate.is_none());
        let keyboard = rate.map(|(delay, rate)| Keyboard::new(Duration::from_millis(delay), rate));
        let mut rig = Self { app, keyboard, now: Duration::ZERO };
        rig.wait(20);
        rig
    }

    fn send(&mut self, key: Key, phase: Phase) {
        self.app
            .key(KeyEvent { key, base: None, modifiers: Modifiers::default(), phase }, self.now);
    }

    fn press(&mut self, key: Key) {
        let now = self.now;
        let key = self.keyboard.as_mut().map_or(key, |keyboard| keyboard.press(key, now));
        self.send(key, Phase::Press);
    }

    fn release(&mut self, key: Key) {
        match &mut self.keyboard {
            Some(keyboard) => keyboard.release(key),
            None => self.send(key, Phase::Release),
        }
    }

    fn tap(&mut self, key: Key, milliseconds: u64) {
        self.press(key);
        self.wait(milliseconds);
        self.release(key);
    }

    fn wait(&mut self, milliseconds: u64) {
        for _ in 0..milliseconds {
            self.now += Duration::from_millis(1);
            while let Some((key, due)) =
                self.keyboard.as_mut().and_then(|keyboard| keyboard.next_byte(self.now))
            {
                let modifiers = Modifiers::default();
                let event = KeyEvent { key, base: None, modifiers, phase: Phase::Press };
                self.app.key(event, due);
            }
            self.app.advance(self.now);
        }
    }

    fn game(&self) -> &Game {
        self.app.game.grid().expect("tests play in grids")
    }

    fn position(&self) -> DVec2 {
        self.game().camera(FieldOfView::default()).position()
    }

    fn degrees(&self) -> f64 {
        self.game().camera(FieldOfView::default()).heading.degrees()
    }
}

/// All keyboards: every combination of delay and rate, and a terminal that reports releases.
fn keyboards() -> impl Iterator<Item = Option<Rate>> {
    let delays = [250, 400, 500, 660].into_iter();
    delays.flat_map(|delay| [15, 25, 30, 40].map(|rate| Some((delay, rate)))).chain([None])
}

/// A level with an open floor. The player starts in the middle, looking east.
fn floor() -> World {
    let (wall, row) = ("#".repeat(61), format!("#{}#", ".".repeat(59)));
    let middle = format!("#{}@{}#", ".".repeat(29), ".".repeat(29));
    let mut rows = vec![wall.clone()];
    rows.extend(iter::repeat_n(row.clone(), 29));
    rows.push(middle);
    rows.extend(iter::repeat_n(row, 29));
    rows.push(wall);
    let text = format!(
        "grid = '''\n{}\n'''\n[tiles]\n\"#\" = {{ wall = \"brick\" }}\n[things]\n\"@\" = {{ start = 0 }}\n",
        rows.join("\n")
    );
    parse_str(&text).unwrap_or_else(|faults| panic!("{faults}"))
}

/// A pit one cell wide. A running jump crosses it.
const PIT: &str = r##"
ceiling = "sky"
grid = '''
#############
#@....~.....#
#############
'''
[tiles]
"#" = { wall = "brick" }
"~" = { floor = "#204060", floor_height = -2 }
[things]
"@" = { start = 0 }
"##;

#[test]
fn looking_ahead_works_whatever_was_pressed_before() {
    let pitch = |rig: &Rig| rig.game().camera(FieldOfView::default()).pitch.slope();
    for rate in [None, Some((250, 40)), Some((500, 30)), Some((660, 15))] {
        for (held, between) in [(10, 0), (10, 60), (10, 200), (900, 0), (900, 60)] {
            let mut rig = Rig::new(floor(), rate);
            rig.tap(Key::PageUp, held);
            rig.wait(between);
            rig.tap(Key::Home, 10);
            rig.wait(2000);
            assert_eq!(pitch(&rig), 0.0, "{rate:?}: {held} ms, {between} ms before");
            rig.tap(Key::PageUp, 10);
            rig.wait(1000);
            assert!(pitch(&rig) > 0.0, "{rate:?}: {held} ms, {between} ms before");
        }
    }
}

#[test]
fn walking_while_turning_traces_a_circle() {
    for (delay, rate) in [(250, 40), (500, 30), (660, 15)] {
        let mut rig = Rig::new(floor(), Some((delay, rate)));
        rig.press(W);
        rig.wait(1000);
        rig.press(Key::Right);
        rig.wait(1500);
        // At 3 cells and 2.4 radians per second, the circle has a radius of 1.25 cells.
        let positions: Vec<DVec2> = (0..6)
            .map(|_| {
                rig.wait(437);
                rig.position()
            })
            .collect();
        // The six positions are a sixth of a turn apart, so opposite ones are a diameter apart.
        for (one, other) in positions.iter().zip(&positions[3..]) {
            let diameter = one.distance(*other);
            assert!((diameter - 2.5).abs() < 0.05, "{delay} ms, {rate} Hz: {positions:?}");
        }
    }
}

#[test]
fn taps_add_up_in_one_read_and_apart() {
    for gap in [0, 1, 50, 150, 300, 500] {
        for (key, one) in [(W, 0.25), (Key::Right, 5.0), (Key::Char('o'), 5.0)] {
            for taps in 1..=4 {
                let mut rig = Rig::new(floor(), Some((500, 30)));
                let start = rig.position();
                for _ in 0..taps {
                    rig.press(key);
                    rig.release(key);
                    rig.wait(gap);
                }
                rig.wait(2500);
                let done = rig.position().distance(start) + rig.degrees();
                let expected = f64::from(taps) * one;
                assert!((done - expected).abs() < 1e-3, "{key} {taps} times: {done}");
            }
        }
    }
}

#[test]
fn losing_the_focus_releases_all_keys() {
    for rate in [None, Some((500, 30))] {
        let mut rig = Rig::new(floor(), rate);
        rig.press(W);
        rig.wait(1000);
        rig.press(Key::Right);
        rig.wait(100);
        rig.app.release_keys();
        // From now on, another window receives the keyboard's bytes.
        if let Some(keyboard) = &mut rig.keyboard {
            keyboard.release(Key::Right);
        }
        rig.wait(1200);
        let (position, degrees) = (rig.position(), rig.degrees());
        rig.wait(1000);
        assert_eq!((rig.position(), rig.degrees()), (position, degrees));
    }
}

#[test]
fn a_walking_key_ends_automatic_walking() {
    let mut rig = Rig::new(floor(), Some((500, 30)));
    rig.tap(Key::Char('g'), 50);
    rig.wait(1000);
    rig.tap(Key::Right, 50);
    rig.wait(1000);
    assert!(rig.position().distance(DVec2::new(30.5, 30.5)) > 5.0);
    rig.tap(Key::Char('s'), 50);
    rig.wait(1000);
    let position = rig.position();
    rig.wait(1000);
    assert_eq!(rig.position(), position);
}

#[test]
fn turning_around_turns_180_degrees() {
    let mut rig = Rig::new(floor(), Some((500, 30)));
    rig.tap(Key::Char('b'), 50);
    rig.wait(1000);
    assert!((rig.degrees() - 180.0).abs() < 1e-9, "{}", rig.degrees());
}
