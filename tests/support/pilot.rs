//! A player that finds its own way. It walks, ducks, jumps, opens and throws towards given cells,
//! and records its intents as a script.

use std::fmt::Write;

use cellcaster::game::{Game, Intent, Intents, Look};
use cellcaster::world::{Cell, FieldOfView};
use glam::DVec2;

use crate::ways::Ways;

/// The largest turn in a step, in degrees.
const TURN: f64 = 6.0;
/// The distance from the middle of a cell at which the player has arrived, in cells.
const NEAR: f64 = 0.25;
/// The largest distance at which a cell can be opened or pulled, measured to its middle, in cells.
const REACH: f64 = 0.72;

/// The player's pace on the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pace {
    /// Ducking.
    Duck,
    /// Walking.
    Walk,
    /// Running.
    Run,
}

/// The way in which the player controls the game.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Control {
    /// Turns and steps of any size.
    Free,
    /// Taps on the walking keys, without turning. Such a script can be typed at a keyboard that
    /// reports no releases.
    Taps,
}

/// The number of steps that a tap walks, and the number of steps between two taps. No keyboard
/// repeats this slowly.
const TAP: u32 = 5;
const BETWEEN_TAPS: u32 = 2;

/// A game, and the intents that led to its state.
#[derive(Clone)]
pub(crate) struct Pilot {
    /// The game.
    pub(crate) game: Game,
    control: Control,
    stretches: Vec<(u32, Intents)>,
}

impl Pilot {
    /// A pilot at the start of a game.
    pub(crate) fn new(game: Game) -> Self {
        Self { game, control: Control::Free, stretches: Vec::new() }
    }

    /// A pilot who taps keys.
    pub(crate) fn tapping(game: Game) -> Self {
        Self { control: Control::Taps, ..Self::new(game) }
    }

    /// Returns whether the pilot only taps keys.
    pub(crate) fn taps(&self) -> bool {
        self.control == Control::Taps
    }

    /// The number of recorded steps.
    pub(crate) fn steps(&self) -> u64 {
        self.stretches.iter().map(|&(steps, _)| u64::from(steps)).sum()
    }

    /// The recorded intents, as lines of a script.
    pub(crate) fn script(&self) -> String {
        let mut text = String::new();
        for &(steps, intents) in &self.stretches {
            let stretch = cellcaster::game::Stretch { steps, intents };
            _ = writeln!(text, "{stretch}");
        }
        text
    }

    /// The player's position.
    pub(crate) fn position(&self) -> DVec2 {
        self.game.camera(FieldOfView::default()).position()
    }

    /// The cell that the player is in.
    pub(crate) fn cell(&self) -> Cell {
        let DVec2 { x, y } = self.position();
        Cell { column: x as u32, row: y as u32 }
    }

    /// Advances by one step.
    pub(crate) fn step(&mut self, intents: Intents) {
        self.game.step(intents);
        match self.stretches.last_mut() {
            Some((steps, last)) if *last == intents => *steps += 1,
            _ => self.stretches.push((1, intents)),
        }
    }

    /// Stands for a number of steps.
    pub(crate) fn wait(&mut self, steps: u32) {
        (0..steps).for_each(|_| self.step(Intents::new()));
    }

    /// Goes along `ways` for at most `steps` steps. Returns whether the player has arrived.
    pub(crate) fn go(&mut self, ways: &Ways, pace: Pace, steps: u32) -> bool {
        let moves = if self.taps() { steps.div_ceil(TAP + BETWEEN_TAPS) } else { steps };
        for _ in 0..moves {
            if self.has_arrived(ways) || self.game.is_finished() {
                return true;
            }
            let (target, is_low) = ways.target(&self.game, self.position());
            let pace = if is_low { Pace::Duck } else { pace };
            match self.control {
                Control::Free => self.approach(target, pace),
                Control::Taps => self.tap_towards(target),
            }
        }
        self.has_arrived(ways)
    }

    /// Taps the key that leads farthest towards `target`. If a wall is in its way, taps the other
    /// key.
    fn tap_towards(&mut self, target: DVec2) {
        let before = self.position();
        let to = target - before;
        let ahead = self.game.camera(FieldOfView::default()).direction();
        let (along, aside) = (ahead.dot(to), ahead.perp().dot(to));
        let forward = if along > 0.0 { Intent::Forward } else { Intent::Back };
        let sideways = if aside > 0.0 { Intent::StrafeRight } else { Intent::StrafeLeft };
        let is_ahead = along.abs() > aside.abs();
        let (first, second) = if is_ahead { (forward, sideways) } else { (sideways, forward) };
        self.tap(first);
        if (self.position() - before).length() < 0.02 && along.abs().min(aside.abs()) > 0.05 {
            self.tap(second);
        }
    }

    fn tap(&mut self, intent: Intent) {
        for index in 0..TAP + BETWEEN_TAPS {
            if self.game.is_finished() {
                return;
            }
            self.step(if index < TAP { [intent].into_iter().collect() } else { Intents::new() });
        }
    }

    /// Turns to `cell` and opens the thing there: a lever, a flame or a secret wall.
    pub(crate) fn open(&mut self, cell: Cell) {
        for _ in 0..90 {
            let to = cell.center() - self.position();
            if to.length() <= REACH + 0.5 && self.turn_to(to).is_none() {
                break;
            }
            self.approach(cell.center(), Pace::Walk);
            if (cell.center() - self.position()).length() <= REACH {
                self.face(cell);
                break;
            }
        }
        self.face(cell);
        self.wait(2);
        self.press(Intent::Open);
        self.wait(2);
    }

    /// Turns to `cell` and does something that takes one press of a key.
    pub(crate) fn act_towards(&mut self, cell: Cell, intent: Intent) {
        self.face(cell);
        self.wait(1);
        self.press(intent);
        self.wait(1);
    }

    /// Jumps from the player's position to `cell`. Tries each time of take-off, and keeps the first
    /// jump that ends there. Returns whether there is one. `height` is the height of the thing
    /// there, if the target is not the floor.
    pub(crate) fn hop(&mut self, cell: Cell, height: Option<f64>) -> bool {
        let floor = height.unwrap_or_else(|| self.game.world().floor_at(cell));
        for (pace, run_up) in
            [Pace::Walk, Pace::Run].into_iter().flat_map(|pace| (0..40).map(move |n| (pace, n)))
        {
            let mut tried = self.clone();
            tried.face(cell);
            tried.wait(20);
            if tried.flies_to(cell, floor, pace, run_up) {
                *self = tried;
                return true;
            }
        }
        false
    }

    /// Walks straight to `cell`, over edges. Returns whether the player has arrived and stands.
    pub(crate) fn straight(&mut self, cell: Cell) -> bool {
        for _ in 0..300 {
            let is_there = (cell.center() - self.position()).length() < NEAR;
            if is_there && !self.game.is_airborne() || self.game.is_finished() {
                self.wait(12);
                return true;
            }
            if is_there {
                self.step(Intents::new());
            } else {
                self.approach(cell.center(), Pace::Walk);
            }
        }
        false
    }

    fn flies_to(&mut self, cell: Cell, floor: f64, pace: Pace, run_up: u32) -> bool {
        let forward = intents(pace);
        (0..run_up).for_each(|_| self.step(forward));
        let mut leap = forward;
        leap.insert(Intent::Jump);
        (0..6).for_each(|_| self.step(leap));
        for _ in 0..60 {
            let is_over = self.cell() == cell && (cell.center() - self.position()).length() < 0.4;
            self.step(if is_over { Intents::new() } else { forward });
            if self.game.feet() < floor - 0.7 {
                return false;
            }
            if self.game.is_finished() {
                return true;
            }
            if is_over && !self.game.is_airborne() {
                self.wait(25);
                return self.cell() == cell && (self.game.feet() - floor).abs() < 0.01;
            }
        }
        false
    }

    /// Applies an intent for one step.
    pub(crate) fn press(&mut self, intent: Intent) {
        self.step([intent].into_iter().collect());
    }

    /// Turns to a point.
    pub(crate) fn face_point(&mut self, point: DVec2) {
        for _ in 0..60 {
            let Some(look) = self.turn_to(point - self.position()) else { break };
            self.step(Intents::new().with_look(look));
        }
    }

    fn face(&mut self, cell: Cell) {
        self.face_point(cell.center());
    }

    fn has_arrived(&self, ways: &Ways) -> bool {
        let cell = self.cell();
        ways.cost(cell) == 0 && (cell.center() - self.position()).length() < NEAR
    }

    fn approach(&mut self, target: DVec2, pace: Pace) {
        let to = target - self.position();
        let look = self.turn_to(to);
        let is_ahead = self.error(to).abs() < 40.0;
        let walking = if is_ahead { intents(pace) } else { intents(pace).without_feet() };
        self.step(walking.with_look(look.unwrap_or(Look::NONE)));
    }

    /// The turn of the next step; `None` if the player already looks there.
    fn turn_to(&self, to: DVec2) -> Option<Look> {
        let error = self.error(to);
        let turn = (error.clamp(-TURN, TURN) * f64::from(Look::PER_DEGREE)).round() as i16;
        (error.abs() > 1.0).then_some(Look { turn, tilt: 0 })
    }

    /// The angle from the player's heading to a direction, in degrees.
    pub(crate) fn error(&self, to: DVec2) -> f64 {
        let ahead = self.game.camera(FieldOfView::default()).direction();
        ahead.perp_dot(to).atan2(ahead.dot(to)).to_degrees()
    }
}

fn intents(pace: Pace) -> Intents {
    let manner = match pace {
        Pace::Duck => Some(Intent::Duck),
        Pace::Walk => None,
        Pace::Run => Some(Intent::Run),
    };
    [Intent::Forward].into_iter().chain(manner).collect()
}

trait WithoutFeet {
    fn without_feet(self) -> Self;
}

impl WithoutFeet for Intents {
    fn without_feet(mut self) -> Self {
        self.remove(Intent::Forward);
        self
    }
}
