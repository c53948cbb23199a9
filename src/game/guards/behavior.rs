//! The behaviour of a guard in a step: duty, wondering, searching, tracking, chasing and attacking.
//!
//! An attack consists of a warning, the blow and a rest. In the last [`LOCKED_STEPS`] steps of the
//! warning, the guard no longer turns, so a player who leaves the line is not hit.

use glam::DVec2;

use super::context::{Context, GuardEffect, PerceivedPlayer};
use super::guard::{
    AttackPhase, GUESS_STEPS, Guard, GuardActivity, KnownPlayer, MAX_PACES, PACE, WONDERING,
};
use super::perception::NOSE;
use super::walking::WalkProgress;
use crate::game::sound::{Sound, SoundKind};
use crate::world::{Cell, Duty, GuardKind};

/// The number of steps for which a guard stops at a waypoint.
const STOP_STEPS: u16 = 80;
/// The greatest distance of searched cells from the centre of the search, in cells along each axis.
const SEARCH_RADIUS: i32 = 4;
/// The distance at which guards see fallen guards, in cells.
const SEES_FALLEN: f64 = 8.0;
/// The number of steps after which a hound gives up at the end of a trail.
const LOST_TRAIL_STEPS: u16 = 150;
/// The number of steps after which a guard who cannot reach a player gives up.
const BAFFLED_STEPS: u16 = 300;
/// The number of steps after which a guard who no longer sees a player begins to search.
const FORGET_STEPS: u16 = 600;
/// The number of steps for which a guard who has given up on an unreachable player ignores players
/// by sight and smell.
const IGNORE_STEPS: u16 = 240;
/// The minimum and maximum distance that guards who do not strike keep from the player, in cells.
const KEPT_DISTANCES: (f64, f64) = (4.0, 9.0);
/// A lantern-bearer strikes if at most this many guards are up, including themselves.
const MAX_FEW: usize = 3;
/// The number of steps before a blow in which the guard does not turn.
const LOCKED_STEPS: u16 = 12;
/// The duration of a blow in steps.
const BLOW_STEPS: u16 = 10;
/// An archer who has not seen the player for this many steps lowers the bow.
const UNSEEN_STEPS: u16 = 24;
/// The cosine of the largest angle at which a blow hits.
const BLOW_COSINE: f64 = 0.5;
/// The radius of a player, in cells.
const PLAYER_RADIUS: f64 = 0.25;

impl Guard {
    /// Advances the guard by the steps of `context`.
    pub(crate) fn step(&mut self, context: &mut Context) {
        let steps = context.stride;
        self.rest = self.rest.saturating_sub(steps);
        self.blind = self.blind.saturating_sub(steps);
        (self.wanted, self.look) = (DVec2::ZERO, None);
        if self.stagger > 0 {
            self.stagger = self.stagger.saturating_sub(steps);
        } else {
            if !matches!(self.state, GuardActivity::Asleep | GuardActivity::Down { .. }) {
                self.perceive(context);
            }
            self.think(context);
        }
        self.move_body(context);
    }

    fn think(&mut self, context: &mut Context) {
        match self.state {
            GuardActivity::Asleep => {}
            GuardActivity::OnDuty => self.do_duty(context),
            GuardActivity::Returning => self.return_to_duty(context),
            GuardActivity::Wondering { .. } => self.wonder(context),
            GuardActivity::Searching { around, next, left } => {
                self.search(context, around, next, left);
            }
            GuardActivity::Tracking { target, mark, lost } => {
                self.track(context, target, mark, lost);
            }
            GuardActivity::Chasing { fright } => self.chase(context, fright),
            GuardActivity::Attacking { phase, left } => self.attack(context, phase, left),
            GuardActivity::Down { left } => self.stay_down(left.saturating_sub(context.stride)),
        }
    }

    fn stay_down(&mut self, left: u16) {
        self.state = GuardActivity::Down { left };
        if left == 0 {
            self.get_up();
        }
    }

    /// Turns and walks as the guard wants to.
    fn move_body(&mut self, context: &mut Context) {
        let steps = context.stride;
        let is_alarmed = self.state.is_alarmed();
        let wanted = if self.stagger > 0 { self.motion.body.velocity } else { self.wanted };
        let is_walking = wanted.length_squared() > 0.01;
        let look = self.look.or(is_walking.then_some(wanted)).filter(|_| self.stagger == 0);
        if let Some(look) = look {
            let degrees = if is_alarmed { 6.0 } else { 4.0 };
            self.motion.turn(look, degrees * f64::from(steps));
        }
        let before = self.motion.position();
        let wanted = self.slowed_by_turning(wanted);
        self.motion.walk(&context.ground(self.gait()), wanted, steps);
        let paces = self.paces + before.distance(self.motion.position()) / PACE;
        if paces.floor() > self.paces.floor() && self.stagger == 0 {
            context.sound(SoundKind::Walking, self.motion.cell(), self.abilities().tread);
        }
        self.paces = paces % MAX_PACES;
    }

    /// Reduces the speed of a guard who does not face their direction of movement, so that they
    /// turn first.
    fn slowed_by_turning(&self, wanted: DVec2) -> DVec2 {
        if self.look.is_some() || self.stagger > 0 || wanted == DVec2::ZERO {
            return wanted;
        }
        let along = self.motion.facing.dot(wanted) / wanted.length();
        wanted * ((along + 0.25) / 1.0).clamp(0.0, 1.0)
    }
}

/// Duty: the behaviour of guards who have noticed nothing.
impl Guard {
    fn do_duty(&mut self, context: &mut Context) {
        if self.pause > 0 {
            self.pause = self.pause.saturating_sub(context.stride);
            self.look_aside();
            return;
        }
        match &self.duty {
            Duty::Stand | Duty::Sleep => self.stand(context),
            Duty::Patrol(stops) => {
                let stop = stops.get(self.stop).copied().unwrap_or(self.post);
                let count = stops.len().max(1);
                self.patrol(context, stop, count);
            }
            &Duty::Wander(reach) => self.wander(context, reach),
        }
    }

    fn return_to_duty(&mut self, context: &mut Context) {
        let home = match &self.duty {
            Duty::Patrol(stops) => stops.get(self.stop).copied().unwrap_or(self.post),
            Duty::Stand | Duty::Sleep | Duty::Wander(_) => self.post,
        };
        let speed = self.abilities().walk;
        match self.go_to(context, home, speed) {
            WalkProgress::OnTheWay => {}
            WalkProgress::There | WalkProgress::Impossible => {
                self.state = GuardActivity::OnDuty;
                self.pause = 60;
            }
        }
    }

    fn stand(&mut self, context: &mut Context) {
        let (post, speed) = (self.post, self.abilities().walk);
        match self.go_to(context, post, speed) {
            WalkProgress::OnTheWay => {}
            WalkProgress::Impossible => self.pause_a_while(120, 240),
            WalkProgress::There => {
                let offset = self.glance;
                self.look = Some(self.post_heading.turned(offset).direction());
                self.pause_a_while(100, 240);
            }
        }
    }

    fn patrol(&mut self, context: &mut Context, stop: Cell, count: usize) {
        let speed = self.abilities().walk;
        match self.go_to(context, stop, speed) {
            WalkProgress::OnTheWay => {}
            WalkProgress::There => {
                self.stop = (self.stop + 1) % count;
                self.pause_a_while(STOP_STEPS, STOP_STEPS);
            }
            WalkProgress::Impossible => {
                self.stop = (self.stop + 1) % count;
                self.pause_a_while(30, 60);
            }
        }
    }

    fn wander(&mut self, context: &mut Context, reach: u8) {
        let Some(errand) = self.errand else {
            self.errand = self.random_cell(context, self.post, i32::from(reach));
            if self.errand.is_none() {
                self.pause_a_while(60, 120);
            }
            return;
        };
        let speed = self.abilities().walk;
        if self.go_to(context, errand, speed) != WalkProgress::OnTheWay {
            self.errand = None;
            self.pause_a_while(90, 240);
        }
    }

    /// A random walkable cell within `reach` of `around`, or `None` if a few tries find no such
    /// cell.
    fn random_cell(&mut self, context: &Context, around: Cell, reach: i32) -> Option<Cell> {
        let gait = self.gait();
        (0..6).find_map(|_| {
            let mut offset = || self.random.whole(-reach, reach) as i32;
            let column = around.column.checked_add_signed(offset())?;
            let row = around.row.checked_add_signed(offset())?;
            let cell = Cell { column, row };
            let is_good = cell != around && context.terrain.is_walkable(context.world, gait, cell);
            is_good.then_some(cell)
        })
    }

    /// Looks to the side of the current glance. At the post, the glance is relative to the post's
    /// heading, elsewhere to the guard's own heading.
    fn look_aside(&mut self) {
        let is_at_post =
            matches!(self.duty, Duty::Stand | Duty::Sleep) && self.motion.cell() == self.post;
        if is_at_post {
            self.look = Some(self.post_heading.turned(self.glance).direction());
        } else if self.glance != 0.0 && self.pause > 30 {
            // The turn consumes the glance.
            let part = self.glance.clamp(-0.03, 0.03);
            self.look = Some(self.motion.heading.turned(part).direction());
            self.glance -= part;
        }
    }
}

/// Wondering, searching and tracking: the behaviour of guards who have noticed something.
impl Guard {
    pub(crate) fn wonder(&mut self, context: &mut Context) {
        let GuardActivity::Wondering { about, looks, goes, hurries, wakes } = self.state else {
            return;
        };
        let way = about - self.motion.position();
        if looks > 0 {
            self.look = Some(way).filter(|way| *way != DVec2::ZERO);
            let looks = looks.saturating_sub(context.stride);
            let goes = goes || self.awareness >= WONDERING;
            self.state = GuardActivity::Wondering { about, looks, goes, hurries, wakes };
            if looks == 0 && !goes {
                self.give_up(context);
            }
            return;
        }
        let Some(cell) = Cell::containing(about) else { return self.give_up(context) };
        let abilities = self.abilities();
        let speed = if hurries { abilities.chase } else { abilities.walk * 1.15 };
        match self.go(context, cell, about, speed) {
            WalkProgress::OnTheWay => {}
            WalkProgress::There | WalkProgress::Impossible => {
                context.woken.extend(wakes);
                let left = if hurries || wakes.is_some() { 780 } else { 420 };
                self.begin_to_search(cell, left);
            }
        }
        if wakes.is_some() && way.length() < 0.9 {
            context.woken.extend(wakes);
            self.begin_to_search(cell, 780);
        }
    }

    pub(crate) fn search(
        &mut self,
        context: &mut Context,
        around: Cell,
        next: Option<Cell>,
        left: u16,
    ) {
        let left = left.saturating_sub(context.stride);
        self.state = GuardActivity::Searching { around, next, left };
        if left == 0 {
            self.give_up(context);
        } else if self.pause > 0 {
            self.pause = self.pause.saturating_sub(context.stride);
            let turn = if self.glance < 0.0 { -0.035 } else { 0.035 };
            self.look = Some(self.motion.heading.turned(turn).direction());
        } else if let Some(cell) = next {
            let speed = self.abilities().walk * 1.3;
            let progress = self.go_to(context, cell, speed);
            if progress != WalkProgress::OnTheWay {
                self.state = GuardActivity::Searching { around, next: None, left };
                let pause = if progress == WalkProgress::There { 60 } else { 5 };
                self.pause_a_while(pause, pause + 20);
            }
        } else {
            let next = self.random_cell(context, around, SEARCH_RADIUS);
            self.state = GuardActivity::Searching { around, next, left };
        }
    }

    /// Follows the marks of a trail one after another.
    pub(crate) fn track(&mut self, context: &mut Context, target: usize, mark: u64, lost: u16) {
        // When a player with the highest index leaves, their trail is removed.
        let Some(trail) = context.trails.get(target) else { return self.give_up(context) };
        let mark = mark.max(trail.first);
        let Some(cell) = trail.cell(mark) else { return self.stop_tracking(lost, context.stride) };
        let newer = trail.cell(mark + 1).is_some();
        let speed = self.abilities().walk * 1.4;
        let is_near = self.motion.position().distance_squared(cell.center()) < 0.5;
        if is_near && newer {
            self.state = GuardActivity::Tracking { target, mark: mark + 1, lost: 0 };
            return;
        }
        match self.go_to(context, cell, speed) {
            WalkProgress::OnTheWay => {
                self.state = GuardActivity::Tracking { target, mark, lost: 0 }
            }
            WalkProgress::There if newer => {
                self.state = GuardActivity::Tracking { target, mark: mark + 1, lost: 0 };
            }
            WalkProgress::There | WalkProgress::Impossible => {
                self.state = GuardActivity::Tracking { target, mark, lost };
                self.stop_tracking(lost, context.stride);
            }
        }
    }

    /// Sniffs around at the end of a trail, and searches after a while.
    fn stop_tracking(&mut self, lost: u16, stride: u16) {
        let GuardActivity::Tracking { target, mark, .. } = self.state else { return };
        let lost = lost.saturating_add(stride);
        self.state = GuardActivity::Tracking { target, mark, lost };
        let side = if (lost / 20).is_multiple_of(2) { 0.05 } else { -0.05 };
        self.look = Some(self.motion.heading.turned(side).direction());
        if lost > LOST_TRAIL_STEPS {
            self.blind = 120;
            self.begin_to_search(self.motion.cell(), 360);
        }
    }

    /// Goes to a fallen guard if this guard sees one.
    pub(crate) fn look_for_fallen(&mut self, context: &mut Context) {
        let is_busy = match self.state {
            GuardActivity::OnDuty | GuardActivity::Returning | GuardActivity::Searching { .. } => {
                false
            }
            GuardActivity::Wondering { wakes, hurries, .. } => wakes.is_some() || hurries,
            _ => true,
        };
        let Some(sight) = self.abilities().sight.filter(|_| !is_busy) else { return };
        let position = self.motion.position();
        let fallen = context.others.iter().position(|other| {
            let way = other.position - position;
            let distance = way.length();
            other.is_down
                && distance < SEES_FALLEN
                && self.motion.facing.dot(way) >= sight.least_cosine * distance
                && self.sees(context, other.position, other.feet + 0.2)
        });
        if let Some(index) = fallen {
            let about = context.others[index].position;
            context.sound(SoundKind::Wonder, self.motion.cell(), 7);
            self.awareness = self.awareness.max(WONDERING);
            self.state = GuardActivity::Wondering {
                about,
                looks: 20,
                goes: true,
                hurries: false,
                wakes: Some(index),
            };
        }
    }
}

/// Chasing: the behaviour of guards who know where a player is.
impl Guard {
    pub(crate) fn chase(&mut self, context: &mut Context, fright: u16) {
        let quarry = self.quarry.filter(|quarry| context.target(quarry.target).is_some());
        let Some(quarry) = quarry else { return self.give_up(context) };
        let way = quarry.position - self.motion.position();
        if fright > 0 {
            self.look = Some(way).filter(|way| *way != DVec2::ZERO);
            self.state = GuardActivity::Chasing { fright: fright.saturating_sub(context.stride) };
        } else if self.can_strike(context, quarry, way) {
            self.begin_to_strike(context);
        } else if quarry.unseen > FORGET_STEPS {
            self.lose_track(context, quarry);
        } else if self.keeps_away(context) && quarry.unseen <= GUESS_STEPS {
            self.keep_distance(context, quarry, way);
        } else {
            self.close_in(context, quarry);
        }
    }

    /// Walks to the position where the player is or was.
    fn close_in(&mut self, context: &mut Context, quarry: KnownPlayer) {
        let Some(cell) = Cell::containing(quarry.position) else { return self.give_up(context) };
        let speed = self.abilities().chase;
        let progress = self.go(context, cell, quarry.position, speed);
        let is_seen = quarry.unseen <= GUESS_STEPS;
        match progress {
            WalkProgress::OnTheWay => {
                self.baffled = self.baffled.saturating_sub(context.stride);
            }
            WalkProgress::There if is_seen => {
                self.look = Some(quarry.position - self.motion.position());
            }
            WalkProgress::There => self.lose_track(context, quarry),
            WalkProgress::Impossible if !is_seen => self.lose_track(context, quarry),
            WalkProgress::Impossible => {
                self.baffled += context.stride;
                let way = quarry.position - self.motion.position();
                self.look = Some(way).filter(|way| *way != DVec2::ZERO);
                if way.length() > 1.0 {
                    self.walk_to(context, quarry.position, speed);
                }
            }
        }
        if self.baffled > BAFFLED_STEPS {
            self.blind = IGNORE_STEPS;
            self.lose_track(context, quarry);
        }
    }

    /// Searches for a player who is no longer there.
    fn lose_track(&mut self, context: &mut Context, quarry: KnownPlayer) {
        self.awareness = WONDERING;
        self.baffled = 0;
        let trail = context.trails.get(quarry.target).filter(|_| self.kind == GuardKind::Hound);
        let position = self.motion.position();
        let is_near = |place: DVec2| place.distance(position) <= NOSE;
        let mark = trail.and_then(|trail| trail.newest(|cell| is_near(cell.center())));
        if let Some(mark) = mark.filter(|_| self.blind == 0) {
            self.state = GuardActivity::Tracking { target: quarry.target, mark, lost: 0 };
        } else if let Some(cell) = Cell::containing(quarry.position) {
            let left = self.random.whole(600, 900) as u16;
            self.begin_to_search(cell, left);
        }
    }

    /// Whether the guard keeps a distance from the player.
    fn keeps_away(&self, context: &Context) -> bool {
        match self.kind {
            GuardKind::Archer => true,
            GuardKind::Lantern => !self.strikes_at_all(context),
            _ => false,
        }
    }

    fn strikes_at_all(&self, context: &Context) -> bool {
        self.kind != GuardKind::Lantern || context.count_up() <= MAX_FEW
    }

    fn keep_distance(&mut self, context: &mut Context, quarry: KnownPlayer, way: DVec2) {
        let distance = way.length();
        let speed = self.abilities().chase;
        let (near, far) = KEPT_DISTANCES;
        if distance > far || quarry.unseen > 8 {
            self.close_in(context, quarry);
        } else {
            if distance < near && distance > 0.0 {
                self.walk_back(context, -way / distance, speed);
            }
            self.look = Some(way).filter(|way| *way != DVec2::ZERO);
        }
        if self.kind == GuardKind::Lantern && context.now.is_multiple_of(600) {
            context.sound(SoundKind::Bell, self.motion.cell(), Sound::FARTHEST);
        }
    }

    /// Walks along `direction`, or aside if something is in the way.
    fn walk_back(&mut self, context: &mut Context, direction: DVec2, speed: f64) {
        const SLANT: DVec2 = DVec2::new(0.5, 0.866);
        let position = self.motion.position();
        let ground = context.ground(self.gait());
        let slants = [DVec2::X, SLANT, DVec2::new(SLANT.x, -SLANT.y), DVec2::Y, -DVec2::Y];
        let ways = slants.map(|slant| direction.rotate(slant));
        let free = ways.into_iter().find(|&way| ground.is_straight(position, position + way));
        if let Some(way) = free {
            self.walk_to(context, position + way, speed);
        }
    }

    /// Whether the player is near enough, ahead and in sight.
    fn can_strike(&self, context: &Context, quarry: KnownPlayer, way: DVec2) -> bool {
        let Some(target) = context.target(quarry.target) else { return false };
        let reach = self.abilities().reach;
        let reach = if self.kind == GuardKind::Hound { 1.9 } else { reach * 0.95 };
        let is_near = way.length_squared() <= reach * reach;
        let is_known = quarry.unseen <= 8;
        let is_ahead = self.motion.facing.dot(way) >= 0.7 * way.length();
        let is_level = target.feet < self.head() + 0.3 && self.motion.feet < target.head + 0.3;
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
        context.sound(kind, self.motion.cell(), 10);
        let left = self.abilities().windup;
        self.state = GuardActivity::Attacking { phase: AttackPhase::Windup, left };
    }
}

/// Attacking: blows and shots.
impl Guard {
    fn attack(&mut self, context: &mut Context, phase: AttackPhase, left: u16) {
        let target = self.quarry.and_then(|quarry| context.target(quarry.target).copied());
        let Some(target) = target else { return self.give_up(context) };
        let left = left.saturating_sub(context.stride);
        self.state = GuardActivity::Attacking { phase, left };
        match phase {
            AttackPhase::Windup => self.wind_up(context, &target, left),
            AttackPhase::Strike { has_hit } => self.strike(context, &target, has_hit, left),
            AttackPhase::Recovery => {
                if left == 0 {
                    self.state = GuardActivity::Chasing { fright: 0 };
                }
            }
        }
    }

    fn wind_up(&mut self, context: &mut Context, target: &PerceivedPlayer, left: u16) {
        let is_archer = self.kind == GuardKind::Archer;
        let is_lost = self.quarry.is_some_and(|quarry| quarry.unseen > UNSEEN_STEPS);
        if is_archer && is_lost && left > LOCKED_STEPS {
            self.state = GuardActivity::Chasing { fright: 0 };
            return;
        }
        // A blind guard strikes at the position where they heard the player.
        let place = match self.quarry {
            Some(quarry) if self.kind == GuardKind::Listener => quarry.position,
            _ => target.position,
        };
        let way = place - self.motion.position();
        self.look = Some(self.motion.facing);
        if left > LOCKED_STEPS && way != DVec2::ZERO {
            self.look = Some(way);
        }
        if self.abilities().windup_speed > 0.0 && way.length() > self.abilities().reach * 0.8 {
            self.walk_to(context, place, self.abilities().windup_speed);
        }
        if left > 0 {
            return;
        }
        self.state = GuardActivity::Attacking {
            phase: AttackPhase::Strike { has_hit: false },
            left: BLOW_STEPS,
        };
        if is_archer {
            self.shoot(context, target);
        } else {
            context.sound(SoundKind::Swing, self.motion.cell(), 6);
        }
    }

    fn strike(
        &mut self,
        context: &mut Context,
        target: &PerceivedPlayer,
        has_hit: bool,
        left: u16,
    ) {
        let is_archer = self.kind == GuardKind::Archer;
        let has_hit = has_hit || !is_archer && self.hits(context, target);
        self.look = Some(self.motion.facing);
        if !has_hit && self.abilities().lunge > 0.0 {
            let ahead = self.motion.position() + self.motion.facing;
            if context.ground(self.gait()).is_straight(self.motion.position(), ahead) {
                self.wanted = self.motion.facing * self.abilities().lunge;
                self.motion.body.velocity = self.wanted;
            }
        }
        self.state = GuardActivity::Attacking { phase: AttackPhase::Strike { has_hit }, left };
        if left == 0 {
            let left = self.abilities().recovery;
            // An archer keeps their distance between two shots.
            self.rest = if is_archer { 2 * left } else { left };
            self.state = GuardActivity::Attacking { phase: AttackPhase::Recovery, left };
        }
    }

    /// Hits the player if they are within reach. Returns whether the blow hit.
    fn hits(&self, context: &mut Context, target: &PerceivedPlayer) -> bool {
        let way = target.position - self.motion.position();
        let distance = way.length();
        let is_level = target.feet < self.head() + 0.3 && self.motion.feet < target.head + 0.3;
        let is_hit = distance <= self.abilities().reach + PLAYER_RADIUS
            && self.motion.facing.dot(way) >= BLOW_COSINE * distance
            && is_level
            && self.has_line_to(context, target);
        if let Some(quarry) = self.quarry.filter(|_| is_hit) {
            let (by, from) = (context.index, self.motion.position());
            let points = self.abilities().points;
            context.effects.push(GuardEffect::Hurt { target: quarry.target, by, from, points });
        }
        is_hit
    }

    fn shoot(&self, context: &mut Context, target: &PerceivedPlayer) {
        let from = self.motion.position();
        let height = self.motion.feet + self.abilities().eye;
        let distance = from.distance(target.position);
        let slope = (target.middle() - height) / distance.max(0.5);
        let (by, points) = (context.index, self.abilities().points);
        let direction = self.motion.facing;
        context.effects.push(GuardEffect::Bolt { by, from, height, direction, slope, points });
        context.sound(SoundKind::Shot, self.motion.cell(), 8);
    }
}
