//! Maps that are played to their exits by bytes that a keyboard could send to a terminal without
//! key releases.
//!
//! A simulated player observes their own position, and presses and releases keys. The keyboard
//! converts the keys to bytes, with at most one key repeating at a time, and the game receives
//! nothing else. The player follows the path of the level's script, segment by segment. The
//! script's own intents cannot be used, because no keyboard can produce them.

use std::f64::consts::PI;

use super::*;
use crate::game::{Intent, Script};
use crate::world::Cell;

/// Two levels without their guards. A player who stops to look around cannot evade the guards.
pub(crate) const CISTERN: &str = include_str!("../../../tests/maps/cistern.toml");
pub(crate) const OBSERVATORY: &str = include_str!("../../../tests/maps/observatory.toml");
const CISTERN_SCRIPT: &str = include_str!("../../../maps/cistern.script");
const OBSERVATORY_SCRIPT: &str = include_str!("../../../maps/observatory.script");

/// The default on most systems.
const RATE: Rate = (500, 30);
/// The tolerances: the position in cells, and the heading in radians.
const NEAR: f64 = 0.14;
const AIMED: f64 = PI / 72.0;
/// The distance after which the player aims again, in cells.
const FAR: f64 = 3.0;
/// The distance below which the player walks by taps, in cells.
const BY_TAPS: f64 = 1.2;
/// The distance from the middle of a pillar to its edge, with a margin, in cells.
const ON_PILLAR: f64 = 0.35;
/// The distance above which a jump needs a run, in cells.
const FAR_JUMP: f64 = 2.4;

/// A straight part of the path, from standstill to standstill.
#[derive(Clone, Copy, Debug)]
struct Segment {
    from: DVec2,
    to: DVec2,
    /// The distance after which the player jumps, in cells.
    jumps_after: Option<f64>,
    ducks: bool,
}

/// The segments of `script` in `world`.
fn segments(world: World, script: &Script) -> Vec<Segment> {
    let mut game = Game::new(world);
    let position = |game: &Game| game.camera(FieldOfView::default()).position();
    let mut segments: Vec<Segment> = Vec::new();
    let mut walked = false;
    for (_, intents) in script.iter() {
        let here = position(&game);
        let walks = intents.contains(Intent::Forward);
        if walks && !walked {
            segments.push(Segment { from: here, to: here, jumps_after: None, ducks: false });
        }
        if let Some(segment) = segments.last_mut() {
            segment.to = here;
            if walks && intents.contains(Intent::Jump) && segment.jumps_after.is_none() {
                segment.jumps_after = Some(here.distance(segment.from));
            }
            segment.ducks |= walks && intents.contains(Intent::Duck);
        }
        walked = walks;
        game.step(intents);
    }
    if let Some(segment) = segments.last_mut() {
        segment.to = position(&game);
    }
    segments
}

impl Rig {
    fn taps(&mut self, key: Key, count: usize) {
        for _ in 0..count {
            self.tap(key, 60);
            self.wait(90);
        }
    }

    fn settle(&mut self) {
        self.wait(650);
    }

    fn direction(&self) -> DVec2 {
        self.game().camera(FieldOfView::default()).heading.direction()
    }

    /// The distances to `target`: ahead, and to the right.
    fn way_to(&self, target: DVec2) -> DVec2 {
        let (direction, way) = (self.direction(), target - self.position());
        DVec2::new(direction.dot(way), direction.perp().dot(way))
    }

    /// Turns towards `target` in steps of 5 degrees.
    fn face(&mut self, target: DVec2) {
        for _ in 0..3 {
            let way = self.way_to(target);
            let angle = way.y.atan2(way.x);
            if way.length() < NEAR || angle.abs() <= AIMED {
                return;
            }
            let turns = (angle.abs() / (PI / 36.0)).round() as usize;
            self.taps(if angle > 0.0 { Key::Right } else { Key::Left }, turns);
            self.settle();
        }
    }

    /// Stops at once. A tap in the opposite direction leads back to the place where the key was
    /// released.
    fn brake(&mut self) {
        self.release(W);
        self.tap(Key::Char('s'), 60);
        self.settle();
    }

    /// Waits until `target` is at most `left` cells ahead, or until the player no longer moves.
    fn wait_until_near(&mut self, target: DVec2, left: f64) {
        let (mut last, mut still) = (self.position(), 0);
        while self.way_to(target).x > left && still < 1500 && !self.game().is_finished() {
            self.wait(1);
            still = if self.position().distance(last) > 1e-4 { 0 } else { still + 1 };
            last = self.position();
        }
    }

    /// Approaches `target` by taps in any direction.
    fn shuffle(&mut self, target: DVec2) {
        for _ in 0..4 {
            let way = self.way_to(target);
            let [ahead, aside] = [way.x, way.y].map(|way| (way.abs() / 0.25).round() as usize);
            if self.game().is_finished() || ahead + aside == 0 {
                return;
            }
            self.taps(if way.x > 0.0 { W } else { Key::Char('s') }, ahead);
            self.taps(Key::Char(if way.y > 0.0 { 'd' } else { 'a' }), aside);
            self.settle();
        }
    }

    fn walk(&mut self, target: DVec2) {
        for _ in 0..12 {
            self.face(target);
            let way = self.way_to(target).x;
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
        self.shuffle(target);
    }

    /// The distance to the edge of the floor ahead, if it is less than `most` cells. On a pillar,
    /// the edge is on all sides.
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

    /// Taps quickly until `target` is reached. This is as fast as walking.
    fn run_up(&mut self, target: DVec2) {
        for millisecond in 0..1500 {
            if self.way_to(target).x <= 0.0 {
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

    /// Walks `after` cells, then jumps to `target`.
    fn jump(&mut self, after: f64, target: DVec2) {
        let after = self.edge(after + 1.0).map_or(after, |edge| edge + 0.16);
        // A key takes effect in the next step.
        let takes_off = self.position() + self.direction() * (after - 0.06);
        let runs = takes_off.distance(target) > FAR_JUMP;
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
        self.wait_until_near(target, 0.0);
        self.brake();
        if runs {
            self.tap(Key::Char('r'), 60);
        }
        self.shuffle(target);
    }

    fn go(&mut self, segment: Segment) {
        if segment.ducks != self.app.controls.toggles.ducks {
            self.tap(Key::Char('x'), 60);
            self.settle();
        }
        match segment.jumps_after {
            Some(after) => {
                self.shuffle(segment.from);
                self.face(segment.to);
                self.jump(after, segment.to);
            }
            None => self.walk(segment.to),
        }
    }
}

#[test]
fn cistern_and_observatory_can_be_played_to_the_exit() {
    let files =
        [("cistern", CISTERN, CISTERN_SCRIPT), ("observatory", OBSERVATORY, OBSERVATORY_SCRIPT)];
    for (name, map, script) in files {
        let world = parse_str(map).unwrap_or_else(|faults| panic!("{faults}"));
        let script = Script::parse(script, name).unwrap_or_else(|faults| panic!("{faults}"));
        let mut rig = Rig::new(world.clone(), Some(RATE));
        for (index, segment) in segments(world, &script).into_iter().enumerate() {
            if rig.game().is_finished() {
                break;
            }
            rig.go(segment);
            let (position, feet) = (rig.position(), rig.game().feet());
            println!(
                "{name} {index}: {segment:.2?} -> {position:.2} at {feet:.2}, {:.1?}",
                rig.now
            );
        }
        // The script ends in the exit's cell, but the player may stop a tap short of it.
        rig.taps(W, 1);
        rig.settle();
        assert!(rig.game().is_finished(), "{name}: at {}", rig.position());
    }
}
