//! From level to level: beginning, going on, beginning again, dying, and returning to the title.

use std::mem;

use super::demo::Demo;
use super::ghost::Ghost;
use super::levels::Stage;
use super::played::Played;
use super::reload::Reload;
use super::run_log::RunLog;
use super::watch::Watch;
use super::{App, Goal, Levels, Screen};
use crate::app::store::Reached;
use crate::game::{Intent, Intents};

impl App {
    /// Begins the first of `levels`; asks first if a game in it is saved.
    pub(crate) fn begin(&mut self, levels: Levels) {
        // A recorded script is about what the program began with.
        self.script = None;
        self.set_up(levels);
        self.ask_about_saved();
    }

    /// Begins the first of `levels`.
    pub(crate) fn set_up(&mut self, levels: Levels) {
        let Levels { first, rest, number, changes, course } = levels;
        let Some(game) = first.begin(self.difficulty) else { return };
        self.later_levels = rest;
        self.level = number;
        self.reload = changes.map(Reload::from);
        self.earlier = 0.0;
        self.course = course;
        self.reached = Reached::default();
        self.demo = None;
        self.log = RunLog::default();
        self.begin_level(first, game);
        self.tell_whether_it_counts();
    }

    /// Begins the next level. After the last one comes the end.
    pub(crate) fn next_level(&mut self) {
        let Some(stage) = self.later_levels.next() else { return self.show(Screen::End) };
        let Some(game) = stage.begin(self.difficulty) else { return self.show(Screen::End) };
        self.earlier += self.game.elapsed();
        self.level = self.level.next();
        if !self.is_descent() {
            self.log = RunLog::default();
        }
        self.begin_level(stage, game);
        self.ask_about_saved();
    }

    /// Begins the level again. A script that is recorded ends here: in a script, a level begins
    /// once.
    pub(crate) fn restart_level(&mut self) {
        self.script = None;
        self.begin_again();
    }

    /// Returns to the start of the level.
    pub(crate) fn begin_again(&mut self) {
        let Some(game) = self.stage.begin(self.difficulty) else { return };
        self.log = RunLog::default();
        let stage = mem::replace(&mut self.stage, Stage::nothing());
        self.begin_level(stage, game);
    }

    /// Goes on from the last checkpoint after a death.
    pub(crate) fn retry(&mut self) {
        let retry: Intents = [Intent::Retry].into_iter().collect();
        self.game.step(retry);
        self.record(retry, 1);
        self.watch = Watch::begin(self.game.grid());
        self.release_keys();
        self.show(Screen::Playing);
    }

    /// Leaves the game for the title.
    pub(crate) fn return_to_title(&mut self) {
        let not_saved = self.leave_game();
        self.show_title();
        if let Some(sentence) = not_saved {
            self.say_in_menu(&sentence);
        }
    }

    /// Shows the title, over a level that plays itself.
    pub(crate) fn show_title(&mut self) {
        self.script = None;
        self.reload = None;
        self.ghost = None;
        match Demo::begin() {
            Some((demo, game)) => (self.demo, self.game) = (Some(demo), game),
            None => self.game = Played::nothing(),
        }
        self.release_keys();
        self.show(Screen::Title);
    }

    fn begin_level(&mut self, stage: Stage, game: Played) {
        self.ghost = match (self.best_run(&stage), game.grid()) {
            (Some(cursor), Some(game)) => Some(Ghost::new(game.clone(), cursor)),
            _ => None,
        };
        self.watch = Watch::begin(game.grid());
        self.stage = stage;
        self.game = game;
        self.result = None;
        self.notice = None;
        self.goal = Goal::of(&self.game, self.settings.minimap);
        self.map.begin_level();
        self.release_keys();
        self.show(Screen::Playing);
    }
}
