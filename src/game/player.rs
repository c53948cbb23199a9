//! Who plays: where they are, how they move, and what a step makes of that.

use glam::DVec2;

use super::STEP;
use super::collision::{Body, Radius, overlaps, slide};
use super::intent::{Intent, Intents};
use super::motion::{Glide, approach, approach_in_plane};
use crate::world::{Cell, Grid, Heading, Start};

/// How far from their middle the player touches a wall: doors are twice as wide as they are.
const RADIUS: Radius = Radius::new(0.25).expect("a quarter is between nothing and a half");

/// Cells per second, in any direction.
pub(super) const WALK: f64 = 3.0;
/// Cells per second, in any direction, for who runs.
pub(super) const RUN: f64 = 5.5;
/// Radians per second.
pub(super) const TURN: f64 = 2.4;
/// Radians per second, for who aims.
pub(super) const AIM: f64 = 0.6;

/// How fast the feet take hold, per second.
pub(super) const FRICTION: f64 = 12.0;
/// How fast a turn begins and ends, per second.
pub(super) const TURN_FRICTION: f64 = 20.0;

/// What is slower stands still, in cells or radians per second. An exponential never ends, but a
/// program that may sleep while nothing moves wants it to.
pub(super) const STILL: f64 = 1e-4;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Player {
    body: Body,
    heading: Heading,
    /// Radians per second, clockwise.
    turning: f64,
}

impl Player {
    /// A player who stands still at the start.
    pub(super) fn new(start: Start) -> Self {
        let body = Body { position: start.cell.center(), velocity: DVec2::ZERO };
        Self { body, heading: start.heading, turning: 0.0 }
    }

    pub(super) fn position(&self) -> DVec2 {
        self.body.position
    }

    pub(super) fn heading(&self) -> Heading {
        self.heading
    }

    /// The cell that the player's middle is in.
    pub(super) fn cell(&self) -> Cell {
        let DVec2 { x, y } = self.body.position;
        Cell { column: x as u32, row: y as u32 }
    }

    /// Whether the player would be inside `cell` if it were solid.
    pub(super) fn touches(&self, cell: Cell) -> bool {
        overlaps(self.body.position, cell, RADIUS)
    }

    /// Which way the player wants to walk, as a vector of length 1; `None` for nowhere.
    pub(super) fn wanted_direction(&self, intents: Intents) -> Option<DVec2> {
        wanted_velocity(self.heading, intents).try_normalize()
    }

    /// The player one step later: turned first, then walked.
    #[must_use]
    pub(super) fn stepped(self, grid: &Grid, intents: Intents) -> Self {
        self.turned(intents).walked(grid, intents)
    }

    fn turned(self, intents: Intents) -> Self {
        let speed = if intents.contains(Intent::Aim) { AIM } else { TURN };
        let target = speed * intents.balance(Intent::TurnRight, Intent::TurnLeft);
        let Glide { velocity, displacement } = approach(self.turning, target, TURN_FRICTION, STEP);
        let turning = if velocity.abs() < STILL { 0.0 } else { velocity };
        Self { heading: self.heading.turned(displacement), turning, ..self }
    }

    fn walked(self, grid: &Grid, intents: Intents) -> Self {
        let target = wanted_velocity(self.heading, intents);
        let Glide { velocity, displacement } =
            approach_in_plane(self.body.velocity, target, FRICTION, STEP);
        let mut body = slide(grid, Body { velocity, ..self.body }, displacement, RADIUS);
        if body.velocity.length() < STILL {
            body.velocity = DVec2::ZERO;
        }
        Self { body, ..self }
    }
}

/// The velocity that the player would have after a while on open floor.
fn wanted_velocity(heading: Heading, intents: Intents) -> DVec2 {
    let forward = intents.balance(Intent::Forward, Intent::Back);
    let right = intents.balance(Intent::StrafeRight, Intent::StrafeLeft);
    let speed = if intents.contains(Intent::Run) { RUN } else { WALK };
    let ahead_and_aside = DVec2::new(forward, right).normalize_or_zero();
    heading.direction().rotate(ahead_and_aside) * speed
}

#[cfg(test)]
mod tests {
    use super::*;

    fn speed(intents: &[Intent]) -> f64 {
        let heading = Heading::from_degrees(33.0).unwrap();
        wanted_velocity(heading, intents.iter().copied().collect()).length()
    }

    #[test]
    fn a_diagonal_is_no_faster_and_opposites_cancel() {
        use Intent::{Back, Forward, Run, StrafeLeft, StrafeRight};
        for way in [&[Forward][..], &[StrafeLeft], &[Forward, StrafeRight], &[Back, StrafeLeft]] {
            assert!((speed(way) - WALK).abs() < 1e-12, "{way:?}");
            assert!((speed(&[way, &[Run]].concat()) - RUN).abs() < 1e-12, "{way:?}");
        }
        for nowhere in [&[Run][..], &[Forward, Back], &[Forward, Back, StrafeLeft, StrafeRight]] {
            assert_eq!(speed(nowhere), 0.0, "{nowhere:?}");
        }
    }

    #[test]
    fn right_is_south_for_who_looks_east() {
        let east = Heading::from_degrees(0.0).unwrap();
        let strafe = [Intent::StrafeRight].into_iter().collect();
        assert_eq!(wanted_velocity(east, strafe), DVec2::new(0.0, WALK));
    }
}
