//! Saved games. When the player leaves a game, the store keeps it as a script of its steps. To
//! continue the game, the program replays the script.
//!
//! There is one saved game for each combination of level, map file and difficulty, and one for each
//! descent. A level with a saved game begins with the question which game to play. The saved game
//! stays until the player leaves or wins the new one.
//!
//! A saved game includes a checksum of its state at the end of the script. If a replay ends in a
//! different state, then the level or the rules have changed since, and the player may begin again.
//! Rejected: a checksum of the map alone. It would miss a change of the rules, and would reject a
//! map in which only a comment has changed.

use super::levels::{date_of, save_of_descent};
use super::page::Menu;
use super::played::Watch;
use super::recording::RunLog;
use super::results::{builtin_named, shown_name};
use super::screen::{MenuChoice, capitalized};
use super::status::whole_seconds;
use super::{App, AppScreen, Levels};
use crate::app::store::{Descent, MAX_SAVES, NotSaved, Save, SaveId, SavedGame};
use crate::game::{Game, Intents, Outcome, Rules, STEP, Script};
use crate::map::builtin;
use crate::world::Difficulty;

impl App {
    /// Saves the current game if it has begun, is not over, and has a level name to save it under.
    ///
    /// # Errors
    /// If the store rejects it.
    pub(crate) fn save_game(&mut self) -> Result<(), NotSaved> {
        let game = self.game.grid().filter(|_| self.is_unfinished());
        let Some((game, save)) = game.zip(self.as_save()) else { return Ok(()) };
        let save = Save { checksum: game.checksum(), ..save };
        self.store.save(&SavedGame { save, script: self.run_script(game) })
    }

    /// The description under which the current game would be saved, without a checksum; `None` if
    /// there is no level name to save it under.
    fn as_save(&self) -> Option<Save> {
        let game = self.game.grid().filter(|_| self.demo.is_none())?;
        let steps = self.log.steps;
        if let Some(kind) = self.levels.descent {
            return Some(Save { steps, ..save_of_descent(kind, game.rules()) });
        }
        Some(Save {
            level: self.levels.stage.name()?.to_owned(),
            file: self.levels.stage.file().map(str::to_owned),
            rules: game.rules(),
            descent: None,
            steps,
            checksum: 0,
        })
    }

    /// Returns true if a game has begun and is not over. A descent does not end at the exit of a
    /// floor, only with the player's death.
    fn is_unfinished(&self) -> bool {
        let is_over = |game: &Game| match self.levels.descent {
            Some(_) => matches!(game.outcome(), Outcome::Dead { .. }),
            None => game.is_finished(),
        };
        let game = self.game.grid().filter(|_| self.demo.is_none() && !self.log.is_empty());
        game.is_some_and(|game| !is_over(game))
    }

    /// The effect of leaving the program, as text for the question whether to leave.
    pub(crate) fn effect_of_leaving(&self) -> &'static str {
        if !self.is_unfinished() {
            return "leaves the program";
        }
        match self.as_save() {
            Some(save) if self.store.has_room_for(save.id()) => {
                "leaves the program\nthe game is saved"
            }
            Some(_) => "leaves the program\nno room to save the game",
            // The level has no name to save the game under.
            None => "leaves the program\nthis game cannot be saved",
        }
    }

    /// Removes the saved game of the level that the player has just won.
    pub(crate) fn remove_save_of_level(&mut self) {
        if let Some(save) = self.as_save() {
            self.store.remove_saved(save.id());
        }
    }

    /// At the start of a level, asks what to do if the level has a saved game, or if there is no
    /// room to save another one.
    pub(crate) fn ask_about_saved(&mut self) {
        let is_at_start = self.screen() == AppScreen::Playing && self.log.is_empty();
        let Some(save) = self.as_save().filter(|_| is_at_start) else { return };
        if self.store.has_saved(save.id()) {
            self.show(AppScreen::HasSaved);
        } else if !self.store.has_room_for(save.id()) {
            self.show(AppScreen::NoRoom);
        }
    }

    /// The menu that asks which game to play in a level with a saved game.
    pub(crate) fn has_saved_menu(&self) -> Menu<MenuChoice> {
        let menu = Menu::new("a saved game");
        let Some(id) = self.as_save().map(|save| save.id()) else { return menu };
        let menu = menu
            .lines(self.store.saves().find(|save| save.id() == id).map(described))
            .line("A new game replaces it when you leave or win.")
            .entry("Continue", MenuChoice::Resume(id))
            .entry("Start over", MenuChoice::GoOn);
        self.with_leaving(menu)
    }

    /// The menu that asks how to begin a level if no more games can be saved.
    pub(crate) fn no_room_menu(&self) -> Menu<MenuChoice> {
        let menu = self.with_removal(Menu::new("no room"));
        self.with_leaving(menu.entry("Play without saving", MenuChoice::GoOn))
    }

    /// Adds an entry that removes the oldest saved game.
    pub(crate) fn with_removal(&self, menu: Menu<MenuChoice>) -> Menu<MenuChoice> {
        let oldest = self.store.saves().last();
        menu.line(format!("{MAX_SAVES} games are saved, which is the maximum."))
            .entries(oldest.map(|it| ("Remove the oldest", name_of(it), MenuChoice::RemoveOldest)))
    }

    /// Removes the oldest saved game to make room for the new one.
    pub(crate) fn remove_oldest(&mut self) {
        if let Some(id) = self.store.saves().last().map(Save::id) {
            self.store.remove_saved(id);
        }
        if self.screen() == AppScreen::Daily {
            self.renew_menu();
        } else {
            self.show(AppScreen::Playing);
            self.ask_about_saved();
        }
    }

    /// Adds a "Continue" entry to the title's menu. It continues directly if there is only one
    /// game, and opens a list otherwise.
    pub(crate) fn with_continue(&self, menu: Menu<MenuChoice>) -> Menu<MenuChoice> {
        let mut ways = self.ways_on();
        let (first, second) = (ways.next(), ways.next());
        match (first, second) {
            (None, _) => menu,
            (Some((name, _, choice)), None) => menu.entry_with("Continue", name, choice),
            (Some(_), Some(_)) => {
                let count = 2 + ways.count();
                menu.entry_with(
                    "Continue",
                    format!("{count} games"),
                    MenuChoice::Open(AppScreen::Saves),
                )
            }
        }
    }

    /// The list of saved games, newest first, followed by the next level of the campaign.
    pub(crate) fn saves_menu(&self) -> Menu<MenuChoice> {
        Menu::new("continue").line("x removes a saved game").entries(self.ways_on())
    }

    /// The games that can be continued: name, time played, and choice.
    fn ways_on(&self) -> impl Iterator<Item = (String, String, MenuChoice)> {
        let saves = self.store.saves();
        let saves =
            saves.map(|save| (name_of(save), time_of(save), MenuChoice::Continue(save.id())));
        saves.chain(self.next_of_campaign())
    }

    /// The first level that is not yet won, unless it has a saved game.
    fn next_of_campaign(&self) -> Option<(String, String, MenuChoice)> {
        let index = self.first_not_won()?;
        let name = builtin::LEVELS[index].name;
        let difficulty = self.store.preferences().difficulty;
        let is_it = |save: &Save| {
            (save.level.as_str(), save.rules.difficulty) == (name, difficulty)
                && save.file.is_none()
        };
        let name = on_difficulty(&capitalized(name), difficulty);
        (!self.store.saves().any(is_it)).then_some((
            name,
            "new".to_owned(),
            MenuChoice::Level(index),
        ))
    }

    /// The menu that asks whether to remove a saved game.
    pub(crate) fn remove_menu(&self, id: SaveId) -> Menu<MenuChoice> {
        Menu::new("remove the saved game?")
            .lines(self.store.saves().find(|save| save.id() == id).map(described))
            .entry("Keep it", MenuChoice::Back)
            .entry("Remove it", MenuChoice::Remove(id))
    }

    /// Removes a saved game, and returns to the list, or to the title if the list is now empty.
    pub(crate) fn remove_saved(&mut self, id: SaveId) {
        self.store.remove_saved(id);
        self.show(AppScreen::Title);
        if self.store.saves().next().is_some() {
            self.open(AppScreen::Saves);
        }
    }

    /// Continues a saved game, if its script still leads to the state in which the player left it.
    pub(crate) fn continue_saved(&mut self, id: SaveId) {
        self.repeat_after(id, Self::begin_saved);
    }

    /// Continues the saved game of the level that has just begun.
    pub(crate) fn resume(&mut self, id: SaveId) {
        self.repeat_after(id, |_, _| Ok(()));
    }

    /// Reads a saved game, and replays it after `begin`.
    fn repeat_after(
        &mut self,
        id: SaveId,
        begin: impl FnOnce(&mut Self, &Save) -> Result<(), String>,
    ) {
        let read = || {
            let SavedGame { save, script } =
                self.store.saved(id).ok_or("The saved game can't be read.")?;
            let script = Script::parse(&script, "the saved game");
            Ok((save, script.map_err(|_| "The saved game is damaged.")?))
        };
        let read: Result<_, String> = read();
        match read.and_then(|(save, script)| begin(self, &save).map(|()| (save, script))) {
            Ok((save, script)) => self.repeat(&save, &script),
            Err(sentence) => self.say_in_menu(&sentence),
        }
    }

    /// Begins the level of a saved game, or the first floor of its descent.
    ///
    /// # Errors
    /// A sentence that says why the level no longer exists.
    fn begin_saved(&mut self, save: &Save) -> Result<(), String> {
        let levels = match save.descent {
            Some(kind) => Levels::descent(save.rules.seed, kind),
            None => self.levels_of(save)?,
        };
        self.difficulty = save.rules.difficulty;
        self.set_up(levels);
        Ok(())
    }

    /// Replays the steps of a saved game from the start of its level.
    fn repeat(&mut self, save: &Save, script: &Script) {
        script.iter().for_each(|(_, intents)| self.step_again(intents));
        if self.game.grid().map(Game::checksum) != Some(save.checksum) {
            return self.show_outdated(save);
        }
        self.log.taken_back = script.header().taken_back;
        if let Some(script) = &mut self.script {
            script.set_taken_back(self.log.taken_back);
            for stretch in self.log.stretches() {
                // As during play, the owner of the file asks for the error later.
                _ = script.record(stretch.intents, stretch.steps.into());
            }
        }
        self.watch = Watch::begin(self.game.grid());
        self.show(AppScreen::Playing);
        if save.descent.is_some() {
            // A descent can be continued only once, so a death cannot be undone.
            self.store.remove_saved(save.id());
            if self.game.is_finished() {
                self.next_level();
            }
        }
    }

    /// Replays one step of a saved game. In a descent, the step after an exit is on the next floor.
    fn step_again(&mut self, intents: Intents) {
        if self.is_descent() && self.game.is_finished() {
            self.next_level();
        }
        self.game.step(intents);
        self.log.record(intents, 1);
        self.remember();
        if let Some(ghost) = &mut self.ghost {
            ghost.step();
        }
        if self.is_descent() && self.game.is_finished() {
            self.count_floor();
        }
    }

    /// Offers to begin again because the level no longer matches the saved game.
    fn show_outdated(&mut self, save: &Save) {
        self.log = RunLog::default();
        match save.descent {
            Some(_) => _ = self.begin_saved(save),
            None => self.begin_again(),
        }
        self.show(AppScreen::Outdated(save.id()));
    }

    pub(crate) fn outdated_menu(&self, id: SaveId) -> Menu<MenuChoice> {
        let what = if self.is_descent() { "The floors of descents have" } else { "The level has" };
        let menu = Menu::new("the saved game")
            .line(format!("{what} changed since you left it."))
            .entry("Start over", MenuChoice::BeginAnew(id));
        self.with_leaving(menu)
    }

    /// Plays the level that has just begun, and removes the saved game that cannot continue.
    pub(crate) fn begin_anew(&mut self, id: SaveId) {
        self.store.remove_saved(id);
        self.show(AppScreen::Playing);
    }

    /// The level of a saved game and the levels after it: built-in levels, or one of the player's
    /// own maps.
    fn levels_of(&mut self, save: &Save) -> Result<Levels, String> {
        if let Some(file) = &save.file {
            let load =
                self.offers.as_ref().and_then(|offers| offers.load.as_ref()).ok_or(NO_MAP)?;
            return load(file).map(Levels::own);
        }
        if let Some(index) = builtin_named(&save.level) {
            return Levels::builtin(index).ok_or_else(|| NO_MAP.to_owned());
        }
        self.find_own_maps();
        let map = self.own_maps.iter().find(|map| map.key == save.level).ok_or(NO_MAP)?;
        let own = (map.load)()?;
        if own.key == save.level { Ok(Levels::own(own)) } else { Err(NO_MAP.to_owned()) }
    }
}

const NO_MAP: &str = "The map of the saved game has changed.";

/// The name of a saved game, for the player.
fn name_of(save: &Save) -> String {
    let Rules { difficulty, seed } = save.rules;
    match save.descent {
        Some(Descent::Daily) => format!("Daily run of {}", date_of(seed)),
        Some(Descent::Practice) => format!("Practice of {}", date_of(seed)),
        Some(Descent::Endless) => on_difficulty("Endless", difficulty),
        None => on_difficulty(&capitalized(shown_name(&save.level)), difficulty),
    }
}

fn on_difficulty(name: &str, difficulty: Difficulty) -> String {
    format!("{name} on {}", difficulty.name())
}

/// The time played.
fn time_of(save: &Save) -> String {
    whole_seconds(save.steps as f64 * STEP).to_string()
}

fn described(save: &Save) -> String {
    format!("{}: {} played", name_of(save), time_of(save))
}
