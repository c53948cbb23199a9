//! Chasing: guards who know where a player is.

use glam::DVec2;

use super::context::Context;
use super::guard::{ALARMED, Guard, WONDERS};
use super::perceive::GUESSES;
use super::route::Progress;
use super::state::{Phase, Quarry, State};
use crate::game::sound::{Sound, SoundKind};
use crate::world::{Cell, Difficulty, GuardKind};

/// The steps for which a guard stands and shouts before they run.
const FRIGHT: u16 = 24;
/// The same for a lantern-bearer, who rings a bell.
const RINGING: u16 = 60;
/// The steps after which guards give up who cannot reach a player.
const BAFFLED: u16 = 300;
/// The steps after which guards search who do not see a player any more.
const FORGOTTEN: u16 = 600;
/// The steps for which they overlook a player whom they could not reach.
const OVERLOOKS: u16 = 240;
/// The distances that guards keep who do not strike, in cells.
const KEEPS: (f64, f64) = (4.0, 9.0);
/// A lantern-bearer strikes if fewer than so many others are up.
const FEW: usize = 3;

impl Guard {
    /// Calls the others, and begins to chase.
    pub(crate) fn raise_alarm(&mut self, context: &mut Context) {
        let (kind, reach) = match self.kind {
            GuardKind::Lantern => (SoundKind::Bell, Sound::FARTHEST),
            GuardKind::Hound => (SoundKind::Bark, 10),
            _ => (SoundKind::Shout, 12),
        };
        context.sound(kind, self.mover.cell(), reach);
        self.awareness = ALARMED;
        self.baffled = 0;
        self.is_wary |= context.rules.difficulty == Difficulty::Hard;
        let is_ringing = self.kind == GuardKind::Lantern;
        self.state = State::Chasing { fright: if is_ringing { RINGING } else { FRIGHT } };
    }

    pub(crate) fn chase(&mut self, context: &mut Context, fright: u16) {
        let quarry = self.quarry.filter(|quarry| context.target(quarry.target).is_some());
        let Some(quarry) = quarry else { return self.give_up(context) };
        let way = quarry.position - self.mover.position();
        if fright > 0 {
            self.look = Some(way).filter(|way| *way != DVec2::ZERO);
            self.state = State::Chasing { fright: fright.saturating_sub(context.stride) };
        } else if self.can_strike(context, quarry, way) {
            self.begin_to_strike(context);
        } else if quarry.unseen > FORGOTTEN {
            self.lose(context, quarry);
        } else if self.keeps_away(context) && quarry.unseen <= GUESSES {
            self.keep_distance(context, quarry, way);
        } else {
            self.close_in(context, quarry);
        }
    }

    /// Walks to where the player is, or was.
    fn close_in(&mut self, context: &mut Context, quarry: Quarry) {
        let Some(cell) = Cell::containing(quarry.position) else { return self.give_up(context) };
        let speed = self.abilities().chase;
        let progress = self.go(context, cell, quarry.position, speed);
        let is_seen = quarry.unseen <= GUESSES;
        match progress {
            Progress::OnTheWay => {
                self.baffled = self.baffled.saturating_sub(context.stride);
            }
            Progress::There if is_seen => {
                self.look = Some(quarry.position - self.mover.position());
            }
            Progress::There => self.lose(context, quarry),
            Progress::Impossible if !is_seen => self.lose(context, quarry),
            Progress::Impossible => {
                self.baffled += context.stride;
                let way = quarry.position - self.mover.position();
                self.look = Some(way).filter(|way| *way != DVec2::ZERO);
                if way.length() > 1.0 {
                    self.walk_to(context, quarry.position, speed);
                }
            }
        }
        if self.baffled > BAFFLED {
            self.blind = OVERLOOKS;
            self.lose(context, quarry);
        }
    }

    /// Looks for a player who is not there any more.
    fn lose(&mut self, context: &mut Context, quarry: Quarry) {
        self.awareness = WONDERS;
        self.baffled = 0;
        let trail = context.trails.get(quarry.target).filter(|_| self.kind == GuardKind::Hound);
        let position = self.mover.position();
        let is_near = |place: DVec2| place.distance(position) <= super::alert::NOSE;
        let mark = trail.and_then(|trail| trail.newest(|cell| is_near(cell.center())));
        if let Some(mark) = mark.filter(|_| self.blind == 0) {
            self.state = State::Tracking { target: quarry.target, mark, lost: 0 };
        } else if let Some(cell) = Cell::containing(quarry.position) {
            let left = self.random.whole(600, 900) as u16;
            self.begin_to_search(cell, left);
        }
    }

    /// Whether the guard stays at some distance from the player.
    fn keeps_away(&self, context: &Context) -> bool {
        match self.kind {
            GuardKind::Archer => true,
            GuardKind::Lantern => !self.strikes_at_all(context),
            _ => false,
        }
    }

    fn strikes_at_all(&self, context: &Context) -> bool {
        self.kind != GuardKind::Lantern || context.count_up() <= FEW
    }

    fn keep_distance(&mut self, context: &mut Context, quarry: Quarry, way: DVec2) {
        let distance = way.length();
        let speed = self.abilities().chase;
        let (near, far) = KEEPS;
        if distance > far || quarry.unseen > 8 {
            self.close_in(context, quarry);
        } else {
            if distance < near && distance > 0.0 {
                self.walk_back(context, -way / distance, speed);
            }
            self.look = Some(way).filter(|way| *way != DVec2::ZERO);
        }
        if self.kind == GuardKind::Lantern && context.now.is_multiple_of(600) {
            context.sound(SoundKind::Bell, self.mover.cell(), Sound::FARTHEST);
        }
    }

    /// Walks along `direction`, or aside where something is in the way.
    fn walk_back(&mut self, context: &mut Context, direction: DVec2, speed: f64) {
        const SLANT: DVec2 = DVec2::new(0.5, 0.866);
        let position = self.mover.position();
        let ground = context.ground(self.gait());
        let slants = [DVec2::X, SLANT, DVec2::new(SLANT.x, -SLANT.y), DVec2::Y, -DVec2::Y];
        let ways = slants.map(|slant| direction.rotate(slant));
        let free = ways.into_iter().find(|&way| ground.is_straight(position, position + way));
        if let Some(way) = free {
            self.walk_to(context, position + way, speed);
        }
    }

    /// Whether the player is near enough, ahead and in sight.
    fn can_strike(&self, context: &Context, quarry: Quarry, way: DVec2) -> bool {
        let Some(target) = context.target(quarry.target) else { return false };
        let reach = self.abilities().reach;
        let reach = if self.kind == GuardKind::Hound { 1.9 } else { reach * 0.95 };
        let is_near = way.length_squared() <= reach * reach;
        let is_known = quarry.unseen <= 8;
        let is_ahead = self.mover.facing.dot(way) >= 0.7 * way.length();
        let is_level = target.feet < self.head() + 0.3 && self.mover.feet < target.head + 0.3;
        self.rest == 0
            && is_near
            && is_known
            && is_ahead
            && (is_level || self.kind == GuardKind::Archer)
            && self.strikes_at_all(context)
            && (self.kind == GuardKind::Listener || self.has_line_to(context, target))
    }

    fn begin_to_strike(&mut self, context: &mut Context) {
        let kind = if self.kind == GuardKind::Archer { SoundKind::Draw } else { SoundKind::Windup };
        context.sound(kind, self.mover.cell(), 10);
        let left = self.abilities().windup;
        self.state = State::Attacking { phase: Phase::Windup, left };
    }
}
