//! Blows and shots: a warning, the blow, and a rest.
//!
//! In the last [`LOCKED`] steps of a warning, the guard does not turn any more: a player who leaves
//! the line is not hit.

use glam::DVec2;

use super::act::{Act, Target};
use super::context::Context;
use super::guard::Guard;
use super::state::{Phase, State};
use crate::game::sound::SoundKind;
use crate::world::GuardKind;

/// The steps before a blow in which the guard does not turn.
const LOCKED: u16 = 12;
/// The duration of a blow in steps.
const STRIKE: u16 = 10;
/// An archer who does not see the player for so many steps puts the bow down.
const UNSEEN: u16 = 24;
/// The cosine of the largest angle at which a blow hits.
const WIDTH: f64 = 0.5;
/// The radius of a player, in cells.
const PLAYER: f64 = 0.25;

impl Guard {
    pub(crate) fn attack(&mut self, context: &mut Context, phase: Phase, left: u16) {
        let target = self.quarry.and_then(|quarry| context.target(quarry.target).copied());
        let Some(target) = target else { return self.give_up(context) };
        let left = left.saturating_sub(context.stride);
        self.state = State::Attacking { phase, left };
        match phase {
            Phase::Windup => self.wind_up(context, &target, left),
            Phase::Strike { has_hit } => self.strike(context, &target, has_hit, left),
            Phase::Recovery => {
                if left == 0 {
                    self.state = State::Chasing { fright: 0 };
                }
            }
        }
    }

    fn wind_up(&mut self, context: &mut Context, target: &Target, left: u16) {
        let is_archer = self.kind == GuardKind::Archer;
        let is_lost = self.quarry.is_some_and(|quarry| quarry.unseen > UNSEEN);
        if is_archer && is_lost && left > LOCKED {
            self.state = State::Chasing { fright: 0 };
            return;
        }
        // The blind strike where they have heard the player.
        let place = match self.quarry {
            Some(quarry) if self.kind == GuardKind::Listener => quarry.position,
            _ => target.position,
        };
        let way = place - self.mover.position();
        self.look = Some(self.mover.facing);
        if left > LOCKED && way != DVec2::ZERO {
            self.look = Some(way);
        }
        if self.abilities().windup_speed > 0.0 && way.length() > self.abilities().reach * 0.8 {
            self.walk_to(context, place, self.abilities().windup_speed);
        }
        if left > 0 {
            return;
        }
        self.state = State::Attacking { phase: Phase::Strike { has_hit: false }, left: STRIKE };
        if is_archer {
            self.shoot(context, target);
        } else {
            context.sound(SoundKind::Swing, self.mover.cell(), 6);
        }
    }

    fn strike(&mut self, context: &mut Context, target: &Target, has_hit: bool, left: u16) {
        let is_archer = self.kind == GuardKind::Archer;
        let has_hit = has_hit || !is_archer && self.hits(context, target);
        self.look = Some(self.mover.facing);
        if !has_hit && self.abilities().lunge > 0.0 {
            let ahead = self.mover.position() + self.mover.facing;
            if context.ground(self.gait()).is_straight(self.mover.position(), ahead) {
                self.wanted = self.mover.facing * self.abilities().lunge;
                self.mover.body.velocity = self.wanted;
            }
        }
        self.state = State::Attacking { phase: Phase::Strike { has_hit }, left };
        if left == 0 {
            let left = self.abilities().recovery;
            // An archer keeps their distance between two shots.
            self.rest = if is_archer { 2 * left } else { left };
            self.state = State::Attacking { phase: Phase::Recovery, left };
        }
    }

    /// Hits the player, if they are within reach.
    fn hits(&self, context: &mut Context, target: &Target) -> bool {
        let way = target.position - self.mover.position();
        let distance = way.length();
        let is_level = target.feet < self.head() + 0.3 && self.mover.feet < target.head + 0.3;
        let is_hit = distance <= self.abilities().reach + PLAYER
            && self.mover.facing.dot(way) >= WIDTH * distance
            && is_level
            && self.has_line_to(context, target);
        if let Some(quarry) = self.quarry.filter(|_| is_hit) {
            let (by, from) = (context.index, self.mover.position());
            let points = self.abilities().points;
            context.acts.push(Act::Hurt { target: quarry.target, by, from, points });
        }
        is_hit
    }

    fn shoot(&self, context: &mut Context, target: &Target) {
        let from = self.mover.position();
        let height = self.mover.feet + self.abilities().eye;
        let distance = from.distance(target.position);
        let slope = (target.middle() - height) / distance.max(0.5);
        let (by, points) = (context.index, self.abilities().points);
        let direction = self.mover.facing;
        context.acts.push(Act::Bolt { by, from, height, direction, slope, points });
        context.sound(SoundKind::Shot, self.mover.cell(), 8);
    }
}
