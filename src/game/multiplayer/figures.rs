//! The figures of players, what guards perceive of them, and who is in whose way.

use glam::DVec2;

use super::members::{Member, Members};
use crate::game::Game;
use crate::game::guards::Target;
use crate::game::player::Motion;
use crate::world::sprite::builtin::PlayerColor;
use crate::world::sprite::builtin::PlayerFrame;
use crate::world::{Figure, SpriteId, World};

/// The distance in which a figure changes its foot, in cells.
const STRIDE: f64 = 0.45;

/// What guards perceive where nobody is.
const NOBODY: Target = Target {
    position: DVec2::ZERO,
    feet: 0.0,
    head: 0.0,
    visibility: 0,
    has_light: false,
    is_alive: false,
};

impl Game {
    /// Finds out what guards perceive of the players of a game for several, by slot.
    pub(crate) fn find_targets(&mut self) {
        let Some(members) = &mut self.members else { return };
        let mut targets = std::mem::take(&mut members.targets);
        targets.clear();
        targets.resize(members.slots.len(), NOBODY);
        for (index, player) in self.playing() {
            targets[index] = self.target_at(player);
        }
        if let Some(members) = &mut self.members {
            members.targets = targets;
        }
    }

    /// Finds out who is in the way of the player in turn.
    pub(crate) fn find_those_in_the_way(&mut self) {
        let Some(members) = &mut self.members else { return };
        if !members.rules.collides {
            return;
        }
        let turn = members.turn;
        let mut in_the_way = std::mem::take(&mut members.in_the_way);
        in_the_way.clear();
        let others = self.playing().filter(|&(index, _)| Some(index) != turn);
        in_the_way.extend(others.map(|(_, player)| player.motion.position()));
        if let Some(members) = &mut self.members {
            members.in_the_way = in_the_way;
        }
    }
}

impl Game {
    /// The frame of a figure of the player of a game for one, who has walked so many cells.
    pub fn frame_of_figure(&self, walked: f64) -> u8 {
        let frame = match self.player.killed_by {
            Some(_) => PlayerFrame::Down,
            None => walking_frame(&self.player.motion, walked),
        };
        frame.index()
    }

    /// The sprite of the players of that colour; `None` in a game for one.
    pub fn sprite_of_players(&self, color: PlayerColor) -> Option<SpriteId> {
        self.members.as_ref()?.sprites[color as usize]
    }
}

impl Members {
    /// The positions of those who are in the way of the player in turn.
    pub(crate) fn in_the_way(&self) -> &[DVec2] {
        &self.in_the_way
    }

    /// Makes the figures of the players. Returns whether they have changed.
    pub(crate) fn pose(&mut self, world: &World) -> bool {
        let mut figures = std::mem::take(&mut self.figures);
        let mut count = 0;
        let mut has_changed = false;
        let shown = self.each().filter(|(_, member)| !member.has_won);
        for (_, member) in shown {
            let Some(sprite) = self.sprites[member.color as usize] else { continue };
            let figure = member.figure(world, sprite);
            if let Some(before) = figures.get_mut(count) {
                has_changed |= *before != figure;
                *before = figure;
            } else {
                has_changed = true;
                figures.push(figure);
            }
            count += 1;
        }
        has_changed |= count < figures.len();
        figures.truncate(count);
        self.figures = figures;
        has_changed
    }

    /// The figures of the players.
    pub(crate) fn figures(&self) -> &[Figure] {
        &self.figures
    }
}

impl Member {
    fn figure(&self, world: &World, sprite: SpriteId) -> Figure {
        let motion = &self.player.motion;
        // What has moved since their death does not carry the dead.
        let base = if self.is_playing { motion.feet() } else { world.floor_at(motion.cell()) };
        let (position, heading) = (motion.position(), motion.heading());
        Figure { sprite, position, base, heading, frame: self.frame().index(), opacity: u8::MAX }
    }

    fn frame(&self) -> PlayerFrame {
        let motion = &self.player.motion;
        match self.swing {
            _ if self.is_down() => PlayerFrame::Down,
            0 => walking_frame(motion, self.walked),
            _ => PlayerFrame::Strike,
        }
    }
}

/// The frame of somebody who stands or walks, and has walked so many cells.
fn walking_frame(motion: &Motion, walked: f64) -> PlayerFrame {
    match (walked / STRIDE) as u64 % 4 {
        _ if motion.is_ducking() => PlayerFrame::Duck,
        _ if motion.is_still() => PlayerFrame::Stand,
        0 => PlayerFrame::WalkLeft,
        2 => PlayerFrame::WalkRight,
        _ => PlayerFrame::Stand,
    }
}
