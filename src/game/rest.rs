//! Rest: steps in which only clocks change.
//!
//! A program that shows a game can sleep while the game rests and then advance the clocks all at
//! once. Both ways produce the same game, bit for bit.
//!
//! A multiplayer game rests while nobody plays in it. Rejected: resting also while all of its
//! players stand still. One of them nearly always moves.

use super::Game;
use super::intent::Intents;

impl Game {
    /// Advances the clocks by `steps` steps in which nothing moves. If the game [is at
    /// rest](Game::is_at_rest), this has the same effect as `steps` calls of [`Game::step`].
    pub fn wait(&mut self, steps: u64) {
        if self.members.is_some() {
            // Without players, every further step has the same result as the first.
            if steps > 0 {
                self.step_all(&[]);
            }
            return;
        }
        if !self.is_finished() && !self.is_dead() {
            self.steps = self.steps.saturating_add(steps);
            self.player.wait(steps);
            if self.is_mission {
                self.player.hearing.wait(steps);
                self.guards.wait(steps);
            }
        }
    }

    /// Returns true if steps with these intents would change only the clock, however many there
    /// are. The player stands still or pushes against a wall, all doors are closed, nobody else
    /// moves, and no message is shown.
    pub fn is_at_rest(&self, intents: Intents) -> bool {
        if self.members.is_some() {
            return self.is_deserted();
        }
        if self.is_dead() {
            return self.presses(intents) == self.player.pressed;
        }
        self.is_finished() || !self.would_change(intents)
    }

    /// Returns true if a step with these intents would change anything but clocks. Messages, doors
    /// that wait, spikes, water and guards on the floor count as changes, because they have clocks
    /// of their own.
    fn would_change(&self, intents: Intents) -> bool {
        let intents = self.at_a_door(intents);
        let motion = self.player.motion;
        motion.stepped(&self.world, &[], intents, self.pace()) != motion
            || self.presses(intents) != self.player.pressed
            || self.player.is_shown_anything()
            || self.door_wanted(intents).is_some_and(|(cell, door)| self.would_answer(cell, door))
            || self.find().is_some()
            || self.is_at_a_new_checkpoint()
            || self.is_in_water()
            || self.player.in_water > 0
            || !self.doors.are_at_rest()
            || !self.guards.are_at_rest()
            || self.spikes.count() > 0
            || !self.missiles.is_empty()
            || !self.smoke.is_empty()
            || self.mechanisms_move()
    }
}
