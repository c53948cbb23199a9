//! A step: each player acts in turn, and then everything else moves: smoke, doors, mechanisms,
//! missiles and guards.
//!
//! A guard who is awake pushes away a player who touches them:
//!
//! - The push is slower than any walk and leads a little aside. A player who walks on gets past,
//!   and nobody is ever held between a guard and a wall.
//! - The push moves the player on level floor only: never over an edge or onto a step.
//! - The guard is not affected.
//!
//! Rejected: solid bodies. 20 of the 36 winning scripts pass through a guard, and a guard on duty
//! in a corridor would block it.

use glam::DVec2;

use super::guards::GuardEffect;
use super::intent::{Intent, Intents};
use super::multiplayer::{playing, playing_mut};
use super::player::{RADIUS, WALK};
use super::rules::{Input, PlayerId};
use super::tools::Missile;
use super::{Game, STEP};

/// The distance between the centres of two bodies that touch, in cells.
const TOUCH: f64 = 2.0 * RADIUS.cells();
/// The speed of the push in cells per second. A player who ducks walks at half of [`WALK`].
const SPEED: f64 = 0.45 * WALK;
/// The rotation from the direction away from the guard to the direction of the push: 30° to the
/// right.
const ASIDE: DVec2 = DVec2::new(0.866_025_403_784_439, 0.5);

impl Game {
    /// Advances the game by one step of [`STEP`] seconds with these intents. Nothing changes after
    /// the player has reached the exit. After death, only [`Intent::Retry`] has an effect.
    ///
    /// In a multiplayer game, these are the intents of the player in the first slot, and the other
    /// players have no intents.
    pub fn step(&mut self, intents: Intents) {
        if self.members.is_some() {
            let seen = self.steps;
            return self.step_all(&[Input { player: PlayerId::FIRST, intents, seen }]);
        }
        *self.work = 0;
        if self.is_finished() {
            return;
        }
        if self.is_dead() {
            return self.step_after_death(intents);
        }
        let intents = self.move_one(intents);
        self.thin_smoke();
        self.move_doors();
        self.act(intents);
        self.move_others();
        self.hear();
        self.sounds.clear();
        self.show();
        self.move_window();
        self.reach_checkpoint();
        self.steps = self.steps.saturating_add(1);
    }

    /// Moves the player, picks things up and applies hazards. Returns the intents, with
    /// [`Intent::Open`] in place of a jump in front of a door or a handle.
    pub(crate) fn move_one(&mut self, intents: Intents) -> Intents {
        let intents = self.at_a_door(intents);
        self.player.has_acted |= intents.act();
        let before = self.player.motion;
        self.move_player(intents);
        self.take_finds();
        self.meet_hazards(&before);
        self.refuse(before.cell());
        let has_ended = self.player.wait(1);
        self.revision += u64::from(has_ended);
        intents
    }

    /// Moves mechanisms, missiles and guards.
    pub(crate) fn move_others(&mut self) {
        self.move_mechanisms();
        self.move_missiles();
        self.move_guards();
    }

    pub(crate) fn step_after_death(&mut self, intents: Intents) {
        let presses = self.presses(intents);
        let retries = self.player.fresh(presses).contains(Intent::Retry);
        self.player.pressed = presses;
        if retries {
            self.retry();
        }
    }

    pub(crate) fn move_player(&mut self, intents: Intents) {
        let before = self.player.motion;
        self.find_those_in_the_way();
        let others = self.members.as_deref().map_or(&[][..], |members| &members.in_the_way);
        self.player.motion = before.stepped(&self.world, others, intents, self.pace());
        if self.is_mission {
            self.give_way();
            self.hear_steps(&before, intents);
        }
    }

    /// The intents that act once for each press, and therefore are remembered from step to step.
    /// [`Intent::Open`] is among them if the level has levers or other handles.
    pub(crate) fn presses(&self, intents: Intents) -> Intents {
        let mut presses = intents.once();
        if self.mechanisms.has_handles && intents.contains(Intent::Open) {
            presses.insert(Intent::Open);
        }
        presses
    }

    /// Opens the door ahead, and carries out the intents that begin in this step.
    pub(crate) fn act(&mut self, intents: Intents) {
        self.open_doors(intents);
        let presses = self.presses(intents);
        let fresh = self.player.fresh(presses);
        self.player.pressed = presses;
        if fresh.is_empty() {
            return;
        }
        self.use_tools(fresh);
        if fresh.contains(Intent::Open)
            && let Some(handle) = self.handle_ahead()
        {
            self.use_handle(handle);
        }
    }

    pub(crate) fn thin_smoke(&mut self) {
        if !self.smoke.is_empty() {
            self.smoke.step();
        }
    }

    pub(crate) fn move_doors(&mut self) {
        *self.work += (self.doors.count() * (1 + self.guards.count())) as u64;
        let Self { player, members, guards, doors, world, .. } = self;
        let is_touched =
            |cell| playing(player, members.as_deref()).any(|(_, it)| it.motion.touches(cell));
        let is_occupied = |cell| is_touched(cell) || guards.touches(cell);
        let has_moved = doors.step(world, is_occupied);
        self.revision += u64::from(has_moved);
    }

    /// Makes the player hear the sounds of this step.
    pub(crate) fn hear(&mut self) {
        if self.is_mission {
            let (listener, position) = (self.turn(), self.player.motion.position());
            let heard = self.player.hearing.step(&self.world, listener, position, &self.sounds);
            self.revision += u64::from(heard);
        }
    }

    /// Makes the window follow the player.
    pub(crate) fn move_window(&mut self) {
        let Some(window) = &mut self.window else { return };
        if let Some(shift) = window.follow(&mut self.world, self.player.motion.cell()) {
            self.player.motion = self.player.motion.shifted(shift);
            self.doors.shift(&mut self.world, shift);
            self.missiles.shift(shift);
            self.smoke.shift(shift);
            if self.is_mission {
                self.guards.shift(&self.world, shift);
                self.player.hearing.forget();
                self.player.warnings.clear();
            }
            self.show();
        }
    }

    pub(crate) fn move_guards(&mut self) {
        if self.guards.is_empty() {
            return;
        }
        let alarm = self.guards.alarm();
        self.find_targets();
        let home = [self.target()];
        let Self { world, guards, sounds, smoke, members, .. } = self;
        let targets = members.as_deref().map_or(&home[..], |members| &members.targets);
        let count = guards.step(world, targets, sounds, &smoke.clouds).len();
        for index in 0..count {
            if let Some(effect) = self.guards.effect(index) {
                self.apply(effect);
            }
        }
        self.revision += u64::from(self.guards.alarm() != alarm);
    }

    fn count_alarm(&mut self) {
        let Self { player, members, .. } = self;
        for (_, player) in playing_mut(player, members.as_deref_mut()) {
            player.counts.alarms += 1;
        }
    }

    /// Applies the effect of a guard to the rest of the game.
    fn apply(&mut self, effect: GuardEffect) {
        match effect {
            GuardEffect::Hurt { target, by, from, points } => {
                self.in_turn(target, |game| game.hurt_by_guard(by, from, points));
            }
            GuardEffect::Open(cell) => self.doors.open(cell),
            GuardEffect::Sound(sound) => self.sounds.push(sound),
            GuardEffect::Bolt { by, from, height, direction, slope, points } => {
                let bolt = Missile::bolt((from, height), direction, slope, (by, points));
                self.missiles.launch(bolt);
            }
            GuardEffect::Raised => self.count_alarm(),
        }
    }

    /// Pushes the player away from the guards that they touch.
    pub(crate) fn give_way(&mut self) {
        let motion = self.player.motion;
        let bodies = self.guards.touching(motion.position(), TOUCH, motion.feet(), motion.head());
        let push: DVec2 = bodies.map(|body| push_from(body, motion.position())).sum();
        if push != DVec2::ZERO {
            let displacement = push.clamp_length_max(1.0) * (SPEED * STEP);
            self.player.motion = motion.moved_aside(&self.world, displacement);
        }
    }
}

/// The direction in which a guard at `body` pushes a player, as a unit vector.
fn push_from(body: DVec2, player: DVec2) -> DVec2 {
    (player - body).try_normalize().unwrap_or(DVec2::X).rotate(ASIDE)
}
