//! Levels played to their exits by bytes that a keyboard could send at a terminal without releases.
//!
//! Somebody looks where they are, and presses and releases keys; the keyboard makes bytes of that, one key
//! repeating at a time, and the game has nothing but those. The way is that of the level's script, leg by
//! leg; the script's own intents are of no use, since no keyboard can send them.

use std::f64::consts::PI;

use super::*;
use crate::game::{Intent, Script};
use crate::map::builtin;
use crate::world::Cell;

/// As most systems have it.
const RATE: Rate = (500, 30);
/// How far from where the script stands somebody may be, in cells, and turned, in radians.
const NEAR: f64 = 0.14;
const AIMED: f64 = PI / 72.0;
/// How far somebody walks before they aim anew, in cells.
const FAR: f64 = 3.0;
/// What is less far is walked by taps, in cells.
const BY_TAPS: f64 = 1.2;
/// How far from the middle of a pillar its edge is, and a bit less, in cells.
const ON_PILLAR: f64 = 0.35;
/// What is further is jumped running, in cells.
const FAR_JUMP: f64 = 2.4;

/// A straight part of the way, from rest to rest.
#[derive(Clone, Copy, Debug)]
struct Leg {
    from: DVec2,
    to: DVec2,
    /// After how many cells of it the player jumps.
    jumps_after: Option<f64>,
    ducks: bool,
}

/// The legs of `script` in `world`.
fn legs(world: World, script: &Script) -> Vec<Leg> {
    let mut game = Game::new(world);
    let place = |game: &Game| game.camera(FieldOfView::default()).position();
    let mut legs: Vec<Leg> = Vec::new();
    let mut walked = false;
    for (_, intents) in script.iter() {
        let here = place(&game);
        let walks = intents.contains(Intent::Forward);
        if walks && !walked {
            legs.push(Leg { from: here, to: here, jumps_after: None, ducks: false });
        }
        if let Some(leg) = legs.last_mut() {
            leg.to = here;
            if walks && intents.contains(Intent::Jump) && leg.jumps_after.is_none() {
                leg.jumps_after = Some(here.distance(leg.from));
            }
            leg.ducks |= walks && intents.contains(Intent::Duck);
        }
        walked = walks;
        game.step(intents);
    }
    if let Some(leg) = legs.last_mut() {
        leg.to = place(&game);
    }
    legs
}

impl Rig {
    fn taps(&mut self, key: Key, count: usize) {
        for _ in 0..count {
            self.tap(key, 60);
            self.wait(90);
        }
    }

    fn rest(&mut self) {
        self.wait(650);
    }

    fn direction(&self) -> DVec2 {
        self.game().camera(FieldOfView::default()).heading.direction()
    }

    /// How far ahead, and how far to the right, `place` is.
    fn way_to(&self, place: DVec2) -> DVec2 {
        let (direction, way) = (self.direction(), place - self.position());
        DVec2::new(direction.dot(way), direction.perp().dot(way))
    }

    /// Turns towards `place`, by 5 degrees at a time.
    fn face(&mut self, place: DVec2) {
        for _ in 0..3 {
            let way = self.way_to(place);
            let angle = way.y.atan2(way.x);
            if way.length() < NEAR || angle.abs() <= AIMED {
                return;
            }
            let turns = (angle.abs() / (PI / 36.0)).round() as usize;
            self.taps(if angle > 0.0 { Key::Right } else { Key::Left }, turns);
            self.rest();
        }
    }

    /// Stops at once: whoever walks the other way for a tap is back where they began to.
    fn brake(&mut self) {
        self.release(W);
        self.tap(Key::Char('s'), 60);
        self.rest();
    }

    /// Waits until `place` is no more than `left` cells ahead, or nothing moves any more.
    fn wait_until_near(&mut self, place: DVec2, left: f64) {
        let (mut last, mut still) = (self.position(), 0);
        while self.way_to(place).x > left && still < 1500 && !self.game().is_finished() {
            self.wait(1);
            still = if self.position().distance(last) > 1e-4 { 0 } else { still + 1 };
            last = self.position();
        }
    }

    /// Goes nearer to `place` by taps, in whatever direction.
    fn shuffle(&mut self, place: DVec2) {
        for _ in 0..4 {
            let way = self.way_to(place);
            let [ahead, aside] = [way.x, way.y].map(|way| (way.abs() / 0.25).round() as usize);
            if self.game().is_finished() || ahead + aside == 0 {
                return;
            }
            self.taps(if way.x > 0.0 { W } else { Key::Char('s') }, ahead);
            self.taps(Key::Char(if way.y > 0.0 { 'd' } else { 'a' }), aside);
            self.rest();
        }
    }

    fn walk(&mut self, place: DVec2) {
        for _ in 0..12 {
            self.face(place);
            let way = self.way_to(place).x;
            if way < BY_TAPS || self.game().is_finished() {
                break;
            }
            let before = self.position();
            let stop = self.position() + self.direction() * way.min(FAR);
            self.press(W);
            self.wait_until_near(stop, 0.0);
            self.brake();
            if self.position().distance(before) < NEAR {
                break;
            }
        }
        self.shuffle(place);
    }

    /// How far ahead, at most `most` cells, the floor falls away. Who stands on a pillar has it round them.
    fn edge(&self, most: f64) -> Option<f64> {
        let (world, feet) = (self.game().world(), self.game().feet());
        let places = (0..).map(|index| f64::from(index) * 0.01).take_while(|&ahead| ahead < most);
        let falls_away = |ahead: &f64| {
            let DVec2 { x, y } = self.position() + self.direction() * *ahead;
            world.floor_at(Cell { column: x as u32, row: y as u32 }) < feet - 0.35
        };
        let edge = places.into_iter().find(falls_away)?;
        Some(if edge > 0.0 { edge } else { ON_PILLAR })
    }

    /// Taps quickly until `place` is reached: that is as fast as walking.
    fn run_up(&mut self, place: DVec2) {
        for millisecond in 0..1500 {
            if self.way_to(place).x <= 0.0 {
                break;
            }
            match millisecond % 85 {
                0 => self.press(W),
                45 => self.release(W),
                _ => {}
            }
            self.wait(1);
        }
    }

    /// Jumps to `place`, `after` so many cells.
    fn jump(&mut self, after: f64, place: DVec2) {
        let after = self.edge(after + 1.0).map_or(after, |edge| edge + 0.16);
        // A key takes until the next step.
        let takes_off = self.position() + self.direction() * (after - 0.06);
        let runs = takes_off.distance(place) > FAR_JUMP;
        if runs {
            self.tap(Key::Char('r'), 60);
        }
        if after > BY_TAPS {
            self.press(W);
            self.wait_until_near(takes_off, 0.0);
        } else {
            self.run_up(takes_off);
            if after < NEAR {
                self.press(W);
                self.wait(30);
            }
        }
        self.tap(SPACE, 60);
        self.wait_until_near(place, 0.0);
        self.brake();
        if runs {
            self.tap(Key::Char('r'), 60);
        }
        self.shuffle(place);
    }

    fn go(&mut self, leg: Leg) {
        if leg.ducks != self.app.controls.gait.ducks {
            self.tap(Key::Char('x'), 60);
            self.rest();
        }
        match leg.jumps_after {
            Some(after) => {
                self.shuffle(leg.from);
                self.face(leg.to);
                self.jump(after, leg.to);
            }
            None => self.walk(leg.to),
        }
    }
}

#[test]
fn cistern_and_observatory_are_played_to_the_exit() {
    for (name, text) in [
        ("cistern", include_str!("../../../maps/cistern.script")),
        ("observatory", include_str!("../../../maps/observatory.script")),
    ] {
        let level = builtin::LEVELS.iter().find(|level| level.name == name).unwrap();
        let script = Script::parse(text, name).unwrap_or_else(|faults| panic!("{faults}"));
        let mut rig = Rig::new(level.world().unwrap(), Some(RATE));
        for (index, leg) in legs(level.world().unwrap(), &script).into_iter().enumerate() {
            if rig.game().is_finished() {
                break;
            }
            rig.go(leg);
            let (place, feet) = (rig.position(), rig.game().feet());
            println!("{name} {index}: {leg:.2?} -> {place:.2} at {feet:.2}, {:.1?}", rig.now);
        }
        // The script ends as it reaches the exit's cell; somebody may stand a tap before it.
        rig.taps(W, 1);
        rig.rest();
        assert!(rig.game().is_finished(), "{name}: at {}", rig.position());
    }
}
