//! The steps of the game that pass with time, and the bell that is rung for what happens in them.
//!
//! Each step uses the keys held at its own time, even if several steps pass between two frames: a
//! tap lasts the same number of steps on a slow machine as on a fast one.
//!
//! Steps that take long are not caught up with: the game slows down, and keys are read between two
//! steps, whatever a step takes.

use std::time::Duration;

use crate::app::App;
use crate::app::controls::{self, Clock};
use crate::app::played::Played;
use crate::app::recording::Ghost;
use crate::app::screen::Screen;
use crate::game::{Alarm, Game, Intents, PlayerId};

/// The time after which no further step is begun before keys are read.
const MOST_TIME: Duration = Duration::from_millis(25);

impl App {
    /// Advances the game to `now`, or as far as it gets in a moment. The rest of the time is lost.
    pub(crate) fn advance(&mut self, now: Duration) {
        self.now = now;
        let begun = self.machine_time.map(|time| time());
        let is_late = |time: Option<fn() -> Duration>| {
            let passed = time.zip(begun).map(|(time, begun)| time().saturating_sub(begun));
            passed.is_some_and(|passed| passed > MOST_TIME)
        };
        let mut step = self.clock.step_after(0);
        let mut steps = self.clock.steps_until(now);
        let mut moves = 0;
        if self.demo.is_some() {
            for _ in 0..steps.min(Clock::MOST_STEPS) {
                self.step_demo();
                if is_late(self.machine_time) {
                    break;
                }
            }
        }
        while steps > 0 && moves < Clock::MOST_STEPS && self.screen() == Screen::Playing {
            let passed = self.pass(step, steps, &mut moves);
            step = controls::after(step, passed);
            steps -= passed;
            if is_late(self.machine_time) {
                break;
            }
        }
        self.controls.advance(now, self.key_context());
        self.settle(now);
    }

    /// Advances the level behind the title by one step.
    fn step_demo(&mut self) {
        let Some(demo) = &mut self.demo else { return };
        match demo.next().filter(|_| !self.game.is_finished()) {
            Some(intents) => self.game.step(intents),
            None => self.game = demo.rewind().unwrap_or_else(Played::nothing),
        }
    }

    /// Advances by one step that ends at `now`, or by up to `most` steps while the game rests.
    /// Returns their number.
    fn pass(&mut self, now: Duration, most: u64, moves: &mut u64) -> u64 {
        let context = self.key_context();
        self.controls.advance(now, context);
        let intents = self.wanted();
        let rests = self.is_at_rest(intents);
        let steps = if rests && !self.pointer.has_input() {
            self.controls.steady_steps(now, context, most)
        } else {
            1
        };
        if rests {
            self.game.wait(steps);
        } else {
            self.game.step(intents);
            *moves += 1;
        }
        if let Some(ghost) = &mut self.ghost {
            (0..steps).for_each(|_| ghost.step());
        }
        if let Some(game) = self.game.grid() {
            self.watch.look_at(game, PlayerId::FIRST);
        }
        self.controls.held.step();
        self.pointer.passed(steps);
        let acted = if intents.is_empty() { 0 } else { steps };
        self.goal.moved(acted);
        self.notice.iter_mut().for_each(|notice| notice.moved(acted));
        self.record(intents, steps);
        self.follow_outcome();
        steps
    }

    /// Whether steps with these intents change only clocks.
    pub(crate) fn is_at_rest(&self, intents: Intents) -> bool {
        self.game.is_at_rest(intents) && self.ghost.as_ref().is_none_or(Ghost::is_at_rest)
    }

    /// Shows the result if the level is won or the player is dead.
    fn follow_outcome(&mut self) {
        if self.game.is_finished() {
            self.result = self.record_result();
            self.show(Screen::LevelDone);
        } else if self.game.is_dead() {
            self.show(Screen::Dead);
        }
    }
}

/// The last state, to compare the next one with.
#[derive(Clone, Copy, Debug, Default)]
pub struct Watch {
    alarm: Alarm,
    health: u8,
    /// Whether something has happened since [`Watch::take_ring`].
    rings: bool,
}

impl Watch {
    /// A watch that begins with the state of the player of `game`.
    pub(crate) fn begin(game: Option<&Game>) -> Self {
        game.map_or_else(Self::default, |game| Self::of(game, PlayerId::FIRST))
    }

    /// A watch that begins with the state of `player` in `game`.
    pub fn of(game: &Game, player: PlayerId) -> Self {
        let mut watch = Self::default();
        watch.look_at(game, player);
        Self { rings: false, ..watch }
    }

    /// Looks at the state of `player` after a step.
    pub fn look_at(&mut self, game: &Game, player: PlayerId) {
        let alarm = game.alarm();
        let health = game.seen_by(player).map_or(self.health, |player| player.health().points);
        self.rings |= alarm > self.alarm || health < self.health;
        (self.alarm, self.health) = (alarm, health);
    }

    /// Whether something has happened since the last call.
    pub fn take_ring(&mut self) -> bool {
        std::mem::take(&mut self.rings)
    }
}
