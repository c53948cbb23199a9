//! Saved games: a game that is left is kept as the script so far, and goes on after replaying it.
//!
//! The checksum of the game at the end of the script is kept beside it. Where a replay ends in another
//! state, the level or the rules have changed since, and the player is offered to begin anew. A
//! checksum of the map alone was refused: it would not notice a change of the rules, and would refuse
//! a map of which only a comment has changed.

use super::results::builtin_named;
use super::run_log::RunLog;
use super::{App, Levels, Screen};
use crate::game::{Intents, LevelName, Outcome, Script};
use crate::store::{SavedGame, Slot};

impl App {
    /// Saves a game that has begun and is not over, if its level has a name to find it by.
    pub(super) fn save_game(&mut self) {
        if let Some(saved) = self.game_to_save() {
            self.store.save(&saved);
        }
    }

    /// The game to save. A descent is not over at the exit of a floor, but with the player's death.
    fn game_to_save(&self) -> Option<SavedGame> {
        let game = self.game.grid().filter(|_| self.demo.is_none() && !self.log.is_empty())?;
        let descent = self.descent();
        let is_over = match descent {
            Some(_) => matches!(game.outcome(), Outcome::Dead { .. }),
            None => game.is_finished(),
        };
        let level = match descent {
            Some(_) => LevelName::of_floor(1).as_str().to_owned(),
            None => self.stage.name()?.to_owned(),
        };
        (!is_over).then(|| SavedGame {
            level,
            rules: game.rules(),
            script: self.run_script(game),
            checksum: Some(game.checksum()),
            descent,
        })
    }

    /// Goes on with the saved game, if its script still leads to the state in which it was left.
    pub(super) fn continue_saved(&mut self, slot: Slot) {
        let Some(saved) = self.store.saved(slot) else { return };
        let Ok(script) = Script::parse(&saved.script, "the saved game") else { return };
        if !self.begin_saved(&saved) {
            self.menu = self.title_menu().line("The map of the saved game is not as it was.");
            self.shown = None;
            return;
        }
        script.iter().for_each(|(_, intents)| self.step_again(intents));
        let checksum = self.game.grid().map(crate::game::Game::checksum);
        if saved.checksum.is_some() && saved.checksum != checksum {
            self.log = RunLog::default();
            self.show_title();
            return self.open(Screen::Outdated(slot));
        }
        if slot == Slot::Descent {
            self.store.clear_saved(slot);
            if self.game.is_finished() {
                self.next_level();
            }
        }
    }

    /// Begins the level of the saved game, and forgets the rest of it.
    pub(super) fn begin_saved_anew(&mut self, slot: Slot) {
        let Some(saved) = self.store.saved(slot) else { return };
        if self.begin_saved(&saved) {
            self.store.clear_saved(slot);
        }
    }

    /// Begins the level of a saved game, or the first floor of its descent; whether there is one.
    fn begin_saved(&mut self, saved: &SavedGame) -> bool {
        let levels = match saved.descent {
            Some(kind) => Self::descent_of(kind, saved.rules.seed),
            None => self.levels_named(&saved.level),
        };
        let Some(levels) = levels else { return false };
        self.difficulty = saved.rules.difficulty;
        self.begin(levels);
        true
    }

    /// Repeats a step of a saved game. In a descent, the step after an exit is on the next floor.
    fn step_again(&mut self, intents: Intents) {
        if self.is_descent() && self.game.is_finished() {
            self.next_level();
        }
        self.game.step(intents);
        self.log.record(intents, 1);
        if let Some(ghost) = &mut self.ghost {
            ghost.step();
        }
        if self.is_descent() && self.game.is_finished() {
            self.count_floor();
        }
    }

    /// The levels from the one on that the store calls `name`: built-in ones, or a map of the player's own.
    fn levels_named(&mut self, name: &str) -> Option<Levels> {
        if let Some(index) = builtin_named(name) {
            return Levels::builtin(index);
        }
        self.find_own_maps();
        let map = self.own_maps.iter().find(|map| map.key == name)?;
        (map.load)().ok().filter(|own| own.key == name).map(Levels::own)
    }
}
