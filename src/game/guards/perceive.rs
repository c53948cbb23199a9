//! Seeing, smelling and touching: how guards notice players.
//!
//! Awareness is a whole number. Each look at a player adds to it, by the light on the player, the
//! distance, and how far the player is from the middle of the cone. No look adds so much that a
//! player who is noticed is followed within half a second, except at [`FACE_TO_FACE`].

use glam::DVec2;

use super::act::Target;
use super::context::Context;
use super::guard::{ALARMED, Guard, WONDERS};
use super::sight::{Point, is_in_sight};
use super::state::{Quarry, State};
use crate::game::sound::SoundKind;
use crate::world::{GuardKind, World};

/// A guard looks around in every fourth step.
pub(crate) const LOOK_EACH: u64 = 4;
/// The most that one look adds to awareness.
const MOST_GAIN: u32 = 80;
/// What awareness loses where nobody is seen.
const LOSS: u16 = 8;
/// At this distance in front of a guard, a player is noticed at once, in cells.
const FACE_TO_FACE: f64 = 1.2;
/// At this distance, a player is felt, in cells.
const TOUCH: f64 = 0.55;
/// The light, of 255, from which guards see as far as in full light.
const BRIGHT: u32 = 160;
/// How far guards see in darkness, in sixteenths of a cell.
const IN_DARKNESS: u32 = 24;
/// How far the lamp of a lantern-bearer lights players, in cells.
const LANTERN: f64 = 4.0;
/// The steps for which a guard knows where a player has gone whom they do not see any more.
pub(crate) const GUESSES: u16 = 45;

impl Guard {
    /// Notices players.
    pub(crate) fn perceive(&mut self, context: &mut Context) {
        if let Some(quarry) = &mut self.quarry {
            quarry.unseen = quarry.unseen.saturating_add(context.stride);
        }
        let looks = (context.now + context.index as u64).is_multiple_of(LOOK_EACH);
        if looks {
            self.look_around(context);
        }
        self.keep_guessing(context);
    }

    fn look_around(&mut self, context: &mut Context) {
        let mut most = 0;
        for index in 0..context.targets.len() {
            let Some(&target) = context.target(index) else { continue };
            let gain = self.gain(context, &target);
            if gain == 0 {
                continue;
            }
            let is_quarry = self.quarry.is_some_and(|quarry| quarry.target == index);
            if gain > most || is_quarry && self.state.is_alarmed() {
                self.quarry = Some(Quarry { target: index, position: target.position, unseen: 0 });
            }
            most = most.max(gain);
        }
        if most > 0 {
            let most = if self.is_wary && most < ALARMED { most + most / 2 } else { most };
            let most = if most < ALARMED { most.min(MOST_GAIN as u16) } else { most };
            self.awareness = (self.awareness + most).min(ALARMED);
            self.react(context);
        } else {
            self.awareness = self.awareness.saturating_sub(LOSS);
            self.smell(context);
        }
    }

    /// What a look at `target` adds to awareness; [`ALARMED`] where it is noticed at once.
    fn gain(&self, context: &Context, target: &Target) -> u16 {
        let way = target.position - self.mover.position();
        let distance = way.length();
        let overlaps = target.feet < self.head() && self.mover.feet < target.head;
        if distance < TOUCH && overlaps {
            return if self.abilities().sight.is_none() { ALARMED } else { WONDERS / 2 };
        }
        let Some(sight) = self.abilities().sight.filter(|_| self.blind == 0) else { return 0 };
        let along = self.mover.facing.dot(way);
        let range = if self.state.is_alarmed() { sight.range * 1.25 } else { sight.range };
        let least = if self.state.is_alarmed() { -0.2 } else { sight.least_cosine };
        if distance > range || along < least * distance {
            return 0;
        }
        let light = self.light_on(context, target, distance);
        let sixteenths = (distance * 16.0) as u32;
        let lit = (range * 16.0) as u32 * light.min(BRIGHT) / BRIGHT;
        let lit = lit.max(IN_DARKNESS);
        if sixteenths > lit {
            return 0;
        }
        let parts = self.visible_parts(context, target);
        if parts == 0 {
            return 0;
        }
        if distance <= FACE_TO_FACE && along > 0.0 {
            return ALARMED;
        }
        let near = 256 - 208 * sixteenths / lit;
        let center = if along >= 0.866 * distance { 256 } else { 144 };
        let bright = 96 + light * 160 / 255;
        let gain = MOST_GAIN * near / 256 * center / 256 * bright / 256 * parts / 3;
        gain.clamp(3, MOST_GAIN) as u16
    }

    /// The light on a player as this guard sees it, up to 255.
    fn light_on(&self, context: &Context, target: &Target, distance: f64) -> u32 {
        let is_lit_by_guard = self.kind == GuardKind::Lantern && distance <= LANTERN;
        if target.has_light || is_lit_by_guard {
            return 255;
        }
        let clearness = context.world.fog().map_or(1.0, |fog| fog.clearness(distance));
        (f64::from(target.visibility) * clearness) as u32
    }

    /// Of three parts of a player, how many this guard sees: the head is one, the body two.
    fn visible_parts(&self, context: &Context, target: &Target) -> u32 {
        let eye = self.eye();
        let sees = |height| {
            let point = Point { position: target.position, height };
            u32::from(is_in_sight(context.world, context.clouds, eye, point))
        };
        2 * sees(target.middle()) + sees(target.head - 0.05)
    }

    /// Whether this guard sees the middle of a player, in whatever direction and light.
    pub(crate) fn has_line_to(&self, context: &Context, target: &Target) -> bool {
        let point = Point { position: target.position, height: target.middle() };
        is_in_sight(context.world, context.clouds, self.eye(), point)
    }

    /// Whether this guard is awake and could see `point`, however dark it is there, once they look that way.
    pub(crate) fn may_see(&self, world: &World, point: Point) -> bool {
        let range = self.abilities().sight.map_or(0.0, |sight| sight.range);
        let is_awake = !self.state.is_down() && self.state != State::Asleep;
        let eye = self.eye();
        is_awake
            && eye.position.distance(point.position) <= range
            && is_in_sight(world, &[], eye, point)
    }

    pub(crate) fn eye(&self) -> Point {
        let height = self.mover.feet + self.abilities().eye;
        Point { position: self.mover.position(), height }
    }

    /// Wonders, or is alarmed.
    pub(crate) fn react(&mut self, context: &mut Context) {
        let Some(quarry) = self.quarry else { return };
        match self.state {
            State::Asleep
            | State::Down { .. }
            | State::Attacking { .. }
            | State::Chasing { .. } => {}
            _ if self.awareness >= ALARMED => self.raise_alarm(context),
            State::Wondering { hurries, wakes, looks, goes, .. } => {
                self.state =
                    State::Wondering { about: quarry.position, hurries, wakes, looks, goes };
            }
            _ if self.awareness >= WONDERS => self.begin_to_wonder(context, quarry.position, false),
            _ => {}
        }
    }

    /// A player who was in sight a moment ago is followed around the corner.
    fn keep_guessing(&mut self, context: &Context) {
        let Some(quarry) = &mut self.quarry else { return };
        if self.state.is_alarmed()
            && quarry.unseen <= GUESSES
            && self.kind != GuardKind::Listener
            && let Some(target) = context.target(quarry.target)
        {
            quarry.position = target.position;
        }
    }

    /// A hound that is not busy smells the trail of a player.
    fn smell(&mut self, context: &mut Context) {
        let is_busy = matches!(self.state, State::Tracking { .. }) || self.state.is_alarmed();
        if self.kind != GuardKind::Hound || is_busy || self.blind > 0 {
            return;
        }
        for (target, trail) in context.trails.iter().enumerate() {
            let position = self.mover.position();
            let ground = context.ground(self.gait());
            let smells = |place: DVec2| {
                place.distance(position) <= super::alert::NOSE
                    && ground.is_straight(position, place)
            };
            if let Some(mark) = trail.newest(|cell| smells(cell.center())) {
                self.state = State::Tracking { target, mark, lost: 0 };
                context.sound(SoundKind::Wonder, self.mover.cell(), 7);
                return;
            }
        }
    }
}
