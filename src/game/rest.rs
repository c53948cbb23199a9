//! Rest: steps in which nothing changes but clocks.
//!
//! A program that shows a game sleeps while it rests, and then advances the clocks at once. The
//! two ways give the same game, bit for bit.
//!
//! A game for several players rests while nobody plays in it. Rejected: a game that also rests while all of its
//! players stand still, because one of them nearly always moves.

use super::Game;
use super::intent::Intents;

impl Game {
    /// Advances the clocks by `steps` steps in which nothing moves. Has the effect of as many calls
    /// of [`Game::step`] if the game [is at rest](Game::is_at_rest).
    pub fn wait(&mut self, steps: u64) {
        if self.members.is_some() {
            // Every further step without players is equal to the first.
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

    /// Whether any number of steps with these intents would change nothing but the clock: the
    /// player stands still or pushes against a wall, all doors are closed, nobody else moves, and
    /// there is no message.
    pub fn is_at_rest(&self, intents: Intents) -> bool {
        if self.members.is_some() {
            return self.is_deserted();
        }
        if self.is_dead() {
            return self.presses(intents) == self.player.pressed;
        }
        self.is_finished() || !self.would_change(intents)
    }

    /// Whether a step with these intents would change anything but clocks. Messages, doors that wait, spikes, water and
    /// guards on the floor count as changes, because they have clocks of their own.
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
