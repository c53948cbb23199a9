//! Blows among players.

use glam::DVec2;

use super::Strikes;
use super::seen::Stand;
use crate::game::Game;
use crate::game::health::Flash;
use crate::world::Heading;

/// The change of velocity of a player who is struck, in cells per second.
const PUSH: f64 = 6.0;
/// The steps for which a player lies who is stunned, and until they can be struck again.
const STUNNED: u16 = 120;
const SPARED: u16 = 240;
/// The steps for which a figure strikes.
const SWING: u16 = 12;

impl Game {
    /// The nearest player whom a blow of the player in turn reaches: within `reach` and within the
    /// angle of the cosine `least_cosine` off their view, in the step that they saw.
    pub(crate) fn player_struck(&self, reach: f64, least_cosine: f64) -> Option<usize> {
        let members = self.members.as_deref()?;
        let turn = members.turn?;
        let seen = members.member(turn)?.seen;
        let own = self.stood(turn, seen)?;
        if members.rules.strikes == Strikes::Nobody {
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

    /// Does to the player `index` what a blow along `direction` does.
    pub(crate) fn strike_player(&mut self, index: usize, direction: DVec2) {
        let degrees = libm::atan2(-direction.y, -direction.x).to_degrees();
        let Some(members) = self.members.as_deref_mut() else { return };
        let (strikes, turn) = (members.rules.strikes, members.turn);
        let Some(member) = members.member_mut(index) else { return };
        member.player.motion = member.player.motion.pushed(direction * PUSH);
        member.player.flash = Some(Flash::struck(Heading::from_degrees(degrees)));
        if strikes == Strikes::Stun {
            (member.stunned, member.spared) = (STUNNED, SPARED);
        }
        members.blows.extend(turn.map(|turn| (turn, index)));
        self.revision += 1;
    }

    /// Lets the figure of the player in turn strike.
    pub(crate) fn swing(&mut self) {
        if let Some(member) = self.member_in_turn() {
            member.swing = SWING;
        }
    }

    /// Whether players can strike in levels without guards, too: each other.
    pub(crate) fn has_blows(&self) -> bool {
        self.multiplayer_rules().is_some_and(|rules| rules.strikes != Strikes::Nobody)
    }
}

fn is_ahead(own: &Stand, other: &Stand, least_cosine: f64) -> bool {
    let way = other.position - own.position;
    own.facing.dot(way) >= least_cosine * way.length()
}
