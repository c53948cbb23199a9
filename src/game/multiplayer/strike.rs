//! Blows between players, judged by the positions in the step that the attacker saw.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::game::Game;
use crate::game::health::Flash;
use crate::game::player::{Motion, RADIUS};
use crate::game::rules::{MAX_LAG, PlayerId, StrikeEffect};
use crate::game::sight::{Point, is_in_sight};
use crate::world::{Heading, World};

/// The number of remembered positions: the present position, and one for each of the last
/// [`MAX_LAG`] steps.
const STEPS: usize = MAX_LAG as usize + 1;
/// The gap between two bodies at which players still touch, in cells.
const TOUCH: f64 = 0.25;

/// The positions of a player in the last steps.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Track([Option<PastPosition>; STEPS]);

/// The position of a player in one step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct PastPosition {
    pub(crate) position: DVec2,
    /// The unit vector of the heading.
    pub(crate) facing: DVec2,
    feet: f64,
    head: f64,
}

impl Track {
    /// Records the position of a player at the end of the step `now`; `None` if they do not play.
    /// Returns the distance that they moved in that step, in cells.
    pub(crate) fn record(&mut self, now: u64, motion: Option<&Motion>) -> f64 {
        let stand = motion.map(PastPosition::new);
        let before = now.checked_sub(1).and_then(|before| self.at(before).copied());
        self.0[now as usize % STEPS] = stand;
        let way = stand.zip(before).map(|(now, before)| now.position.distance(before.position));
        way.unwrap_or_default()
    }

    /// The position of the player in the step `seen`.
    fn at(&self, seen: u64) -> Option<&PastPosition> {
        self.0[seen as usize % STEPS].as_ref()
    }
}

impl PastPosition {
    fn new(motion: &Motion) -> Self {
        let facing = motion.heading().direction();
        let (feet, head) = (motion.feet(), motion.head());
        Self { position: motion.position(), facing, feet, head }
    }

    /// Returns true if an arm reaches from here to `other`: the centres are at most `reach` apart,
    /// the bodies overlap in height, and nothing is between them.
    pub(crate) fn reaches(&self, world: &World, other: &Self, reach: f64) -> bool {
        let distance = self.position.distance(other.position);
        let overlaps = self.feet < other.head && other.feet < self.head;
        overlaps && distance <= reach && is_in_sight(world, &[], self.middle(), other.middle())
    }

    fn middle(&self) -> Point {
        Point { position: self.position, height: f64::midpoint(self.feet, self.head) }
    }
}

impl Game {
    /// Whether two players touched each other in the step `seen`, which is clamped to at most
    /// [`MAX_LAG`] steps ago. The dead, and players who have reached the exit, touch nobody.
    pub fn touches(&self, one: PlayerId, other: PlayerId, seen: u64) -> bool {
        let stands = [one, other].map(|player| self.stood(player.index(), seen));
        let [Some(one_stood), Some(other_stood)] = stands else { return false };
        one != other && one_stood.reaches(&self.world, other_stood, 2.0 * RADIUS.cells() + TOUCH)
    }

    /// The position of a player in the step `seen`.
    pub(crate) fn stood(&self, index: usize, seen: u64) -> Option<&PastPosition> {
        let seen = self.clamp_seen(seen);
        self.members.as_ref()?.member(index)?.track.at(seen)
    }

    /// The step that a player saw, clamped to the steps that count.
    pub(crate) fn clamp_seen(&self, seen: u64) -> u64 {
        seen.clamp(self.steps.saturating_sub(MAX_LAG), self.steps)
    }
}

/// The change of velocity of a player who is struck, in cells per second.
const PUSH: f64 = 6.0;
/// The number of steps until a stunned player stands up, and until they can be struck again.
const STUNNED: u16 = 120;
const SPARED: u16 = 240;
/// The number of steps for which a figure strikes.
const SWING: u16 = 12;

impl Game {
    /// The nearest player that a blow by the current player hits, in the step that they saw: within
    /// `reach`, and within the angle of cosine `least_cosine` of their direction of view.
    pub(crate) fn player_struck(&self, reach: f64, least_cosine: f64) -> Option<usize> {
        let members = self.members.as_deref()?;
        let turn = members.turn?;
        let seen = members.member(turn)?.seen;
        let own = self.stood(turn, seen)?;
        if members.rules.strikes == StrikeEffect::Nobody {
            return None;
        }
        let is_open_to_it =
            |index: usize| members.member(index).is_some_and(|it| it.is_playing && it.spared == 0);
        let others =
            (0..members.slots.len()).filter(|&index| index != turn && is_open_to_it(index));
        let near = others.filter_map(|index| {
            let other = self.stood(index, seen)?;
            let is_ahead = is_ahead(own, other, least_cosine);
            let is_near = is_ahead && own.reaches(&self.world, other, reach);
            is_near.then(|| (index, own.position.distance(other.position)))
        });
        Some(near.min_by(|one, other| one.1.total_cmp(&other.1))?.0)
    }

    /// Applies a blow along `direction` to the player `index`.
    pub(crate) fn strike_player(&mut self, index: usize, direction: DVec2) {
        let degrees = libm::atan2(-direction.y, -direction.x).to_degrees();
        let Some(members) = self.members.as_deref_mut() else { return };
        let (strikes, turn) = (members.rules.strikes, members.turn);
        let Some(member) = members.member_mut(index) else { return };
        member.player.motion = member.player.motion.pushed(direction * PUSH);
        member.player.flash = Some(Flash::struck(Heading::from_degrees(degrees)));
        if strikes == StrikeEffect::Stun {
            (member.stunned, member.spared) = (STUNNED, SPARED);
        }
        members.blows.extend(turn.map(|turn| (turn, index)));
        self.revision += 1;
    }

    /// Shows the figure of the current player as striking.
    pub(crate) fn swing(&mut self) {
        if let Some(member) = self.member_in_turn() {
            member.swing = SWING;
        }
    }

    /// Whether players can strike each other, even in levels without guards.
    pub(crate) fn has_blows(&self) -> bool {
        self.multiplayer_rules().is_some_and(|rules| rules.strikes != StrikeEffect::Nobody)
    }
}

fn is_ahead(own: &PastPosition, other: &PastPosition, least_cosine: f64) -> bool {
    let way = other.position - own.position;
    own.facing.dot(way) >= least_cosine * way.length()
}
