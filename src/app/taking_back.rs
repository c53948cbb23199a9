//! Taking back the last seconds of a run.
//!
//! A key, and an entry of the panel after a death, go back ten seconds: as often as the player likes
//! on easy, three times in a run on normal, and never on hard. The run loses that time, so its
//! script still leads to its result. The run counts how often time was taken back: its script, its
//! saved game and its result say so, and a result without it replaces results with it.
//!
//! Nothing is taken back in a descent, which ends with a death and whose results are compared
//! between players, and in a generated level, in which nothing hurts.

use crate::app::App;
use crate::app::controls::Action;
use crate::app::history::History;
use crate::app::played::{Goal, Played, Watch};
use crate::app::screen::{AppScreen, MenuChoice};
use crate::game::{Alarm, STEPS_PER_SECOND};
use crate::terminal::Key;
use crate::world::Difficulty;

/// The number of steps that are taken back at once: ten seconds.
const STEPS: u64 = 10 * STEPS_PER_SECOND as u64;
/// How often time can be taken back in a run on normal difficulty.
const MAX_ON_NORMAL: u32 = 3;

impl App {
    /// Begins the history of the level that has just begun.
    pub(crate) fn begin_history(&mut self) {
        let game = self.game.grid().filter(|game| game.corner().is_none());
        self.history = game.map(|game| History::new(game.clone(), self.log.steps));
    }

    /// Adds the state after the last recorded step to the history.
    pub(crate) fn remember(&mut self) {
        if let Some((history, game)) = self.history.as_mut().zip(self.game.grid()) {
            history.record(self.log.steps, game);
        }
    }

    /// How often the player may still take time back; `None` for any number of times.
    fn takes_left(&self) -> Option<u32> {
        if self.history.is_none() || self.is_descent() {
            return Some(0);
        }
        match self.difficulty {
            Difficulty::Easy => None,
            Difficulty::Normal => Some(MAX_ON_NORMAL.saturating_sub(self.log.taken_back)),
            Difficulty::Hard => Some(0),
        }
    }

    /// Returns true if the player can take time back now.
    fn can_take_back(&self) -> bool {
        self.takes_left() != Some(0) && !self.log.is_empty()
    }

    /// The key that takes time back, if the player can use it and is in danger.
    pub(crate) fn useful_take_back_key(&self) -> Option<Key> {
        let is_chased = self.game.grid().is_some_and(|game| game.alarm() == Alarm::Raised);
        let mut keys = self.settings.bindings.keys(Action::TakeBack);
        keys.next().filter(|_| is_chased && self.can_take_back())
    }

    /// Goes back ten seconds, or to the start of the level, and tells how often that is still
    /// possible. If it is impossible, tells why.
    pub(crate) fn take_back(&mut self) {
        let history = self.history.as_ref().filter(|_| self.can_take_back());
        let Some(history) = history else { return self.tell_why_not() };
        let now = self.log.steps;
        let taken = STEPS.min(now);
        let then = now - taken;
        let game = history.at(then, |first| self.log.since(first));
        self.log.take_back(taken as u32);
        if let Some(script) = &mut self.script {
            // As during play, the owner of the file asks for the error later.
            _ = script.take_back(taken as u32);
        }
        self.history.iter_mut().for_each(|history| history.forget_after(then));
        self.ghost.iter_mut().for_each(|ghost| ghost.go_back_to(then));
        self.watch = Watch::begin(Some(&game));
        self.game = Played::Grid(Box::new(game));
        self.show(AppScreen::Playing);
        self.notice = Some(match self.takes_left() {
            None => Goal::new("Ten seconds taken back", "Taken back"),
            Some(left) => {
                let (text, short) = ("Ten seconds taken back", "Taken back");
                Goal::new(&format!("{text}, {left} left"), &format!("{short}, {left} left"))
            }
        });
        self.follow_outcome();
    }

    fn tell_why_not(&mut self) {
        let (text, short) = if self.history.is_none() || self.is_descent() {
            ("Time cannot be taken back here", "Not here")
        } else if self.difficulty == Difficulty::Hard {
            ("Time cannot be taken back on hard", "Not on hard")
        } else if self.log.is_empty() {
            ("There is nothing to take back yet", "Nothing yet")
        } else {
            ("Time was taken back three times, which is the maximum", "Taken back 3 times already")
        };
        self.notice = Some(Goal::new(text, short));
        self.shown = None;
    }

    /// The entry of the panel after a death, if time can be taken back.
    pub(crate) fn take_back_entry(&self) -> Option<(&'static str, String, MenuChoice)> {
        let left = self.takes_left().map_or_else(String::new, |left| format!("{left} left"));
        self.can_take_back().then_some(("Take back 10 s", left, MenuChoice::TakeBack))
    }
}
