//! How time becomes steps of the game.
//!
//! Each step finds the keys that are held at its own time, however many of them pass between two frames: a
//! tap lasts as many steps on a slow machine as on a fast one.

use std::time::Duration;

use super::clock::{self, Clock};
use super::{App, Screen};

impl App {
    /// Lets the game go on until `now`.
    pub(super) fn advance(&mut self, now: Duration) {
        self.now = now;
        let mut step = self.clock.step_after(0);
        let mut steps = self.clock.steps_until(now);
        let mut moves = 0;
        while steps > 0 && moves < Clock::MOST_STEPS && self.screen == Screen::Playing {
            let passed = self.pass(step, steps, &mut moves);
            step = clock::after(step, passed);
            steps -= passed;
        }
        self.controls.advance(now, self.stance());
        self.settle(now);
    }

    /// Lets one step pass that ends at `now`, or some of up to `most` in which nothing happens; how many.
    fn pass(&mut self, now: Duration, most: u64, moves: &mut u64) -> u64 {
        let stance = self.stance();
        self.controls.advance(now, stance);
        let intents = self.wanted();
        let quiet = self.game.quiet_steps(intents);
        let steady = self.controls.steady_steps(now, stance, most);
        let steps = if self.pointer.has_news() { 1 } else { steady.min(quiet.max(1)) };
        if quiet > 0 {
            self.game.wait(steps);
        } else {
            self.game.step(intents);
            *moves += 1;
        }
        self.controls.held.step();
        self.pointer.passed(steps);
        self.goal.moved(if quiet > 0 { 0 } else { steps });
        self.record(intents, steps);
        if self.game.is_finished() {
            self.show(Screen::LevelDone);
        }
        steps
    }
}
