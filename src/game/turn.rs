//! The parts of a step: what a player does in their turn, and what moves by itself.

use super::Game;
use super::intent::{Intent, Intents};
use super::multiplayer::playing;

impl Game {
    /// Moves the player, with what they meet on their way. Returns the intents, of which a jump in
    /// front of a door is to open it.
    pub(crate) fn move_one(&mut self, intents: Intents) -> Intents {
        let intents = self.at_a_door(intents);
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
        let others = self.members.as_deref().map_or(&[][..], |members| members.in_the_way());
        self.player.motion = before.stepped(&self.world, others, intents, self.pace());
        if self.is_mission {
            self.give_way();
            self.hear_steps(&before, intents);
        }
    }

    /// The intents that are recorded from step to step, because each press acts once. A lever turns
    /// once for each press, too.
    pub(crate) fn presses(&self, intents: Intents) -> Intents {
        let mut presses = intents.once();
        if self.mechanisms.has_handles() && intents.contains(Intent::Open) {
            presses.insert(Intent::Open);
        }
        presses
    }

    /// Opens the door ahead, and does what the player begins to want.
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

    /// Lets the player hear the sounds of this step.
    pub(crate) fn hear(&mut self) {
        if self.is_mission {
            let (listener, position) = (self.turn(), self.player.motion.position());
            let heard = self.player.hearing.step(&self.world, listener, position, &self.sounds);
            self.revision += u64::from(heard);
        }
    }

    /// Moves the window after the player.
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
}
