//! Screens: the pages of the game at home, their menus, and the effect of keys, the mouse and menu
//! entries on each.

use std::fmt::Write;
use std::time::Duration;

use crate::app::App;
use crate::app::controls::{Action, KeyContext};
use crate::app::page::{Effect, Menu, Page, PageKind};
use crate::app::picture::widened;
use crate::app::setting::ViewAngle;
use crate::app::status::{of_steps, whole_seconds};
use crate::app::store::{Best, Preferences, SaveId};
use crate::game::{Game, Intents};
use crate::map::builtin;
use crate::terminal::{Key, KeyEvent, MouseEvent};
use crate::tui::Press;
use crate::world::Difficulty;

/// The panel over the picture. It decides the effect of keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) enum AppScreen {
    Title,
    /// The choice of a difficulty for a new game.
    NewGame,
    /// The choice of a built-in level.
    Levels,
    /// The choice of a map file.
    Maps,
    /// The list of saved games.
    Saves,
    /// The question whether to remove a saved game.
    Remove(SaveId),
    /// The question whether to begin or to continue the daily run.
    Daily,
    /// The question whether to continue the saved game of a level that begins.
    HasSaved,
    /// The question what to do if no more games can be saved.
    NoRoom,
    /// The offer to begin again in place of a saved game that cannot continue.
    Outdated(SaveId),
    Settings,
    /// The keys of all actions.
    Keys,
    /// The question for a new key of an action.
    Binding(Action),
    /// The question whether to tell tmux that its terminal shows 24-bit colours.
    Tmux,
    #[default]
    Playing,
    Paused,
    Help,
    /// The question whether to leave the game.
    Leaving,
    LevelDone,
    /// The player is dead.
    Dead,
    End,
}

/// The effect of a menu entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MenuChoice {
    /// Opens a screen.
    Open(AppScreen),
    /// Begins the campaign.
    Begin(Difficulty),
    /// Begins the built-in level with this index.
    Level(usize),
    /// Begins the map with this index in the list of own maps.
    Map(usize),
    /// Continues a saved game.
    Continue(SaveId),
    /// Continues the saved game of the level that has just begun.
    Resume(SaveId),
    /// Plays the level that has just begun, in place of a saved game that cannot continue.
    BeginAnew(SaveId),
    /// Removes a saved game.
    Remove(SaveId),
    /// Removes the oldest saved game to make room.
    RemoveOldest,
    /// Returns to the previous screen.
    Back,
    /// Begins the daily descent.
    Daily,
    /// Begins an endless descent.
    Endless,
    /// Changes the setting in this row of the settings page.
    Change(usize),
    /// Gives all actions the keys of the next preset.
    ChangePreset,
    /// Continues the current game.
    GoOn,
    /// Continues from the last checkpoint.
    Retry,
    /// Takes the last seconds back.
    TakeBack,
    /// Begins the level again.
    Restart,
    /// Continues with the next level.
    NextLevel,
    /// Returns to the title.
    ToTitle,
    /// Tells tmux that its terminal shows 24-bit colours.
    TellTmux,
    /// Leaves the program.
    Leave,
}

impl Page for AppScreen {
    fn kind(self) -> PageKind {
        match self {
            Self::Playing | Self::Binding(_) => PageKind::Bare,
            Self::Help => PageKind::Help,
            Self::Leaving => PageKind::Leaving,
            Self::LevelDone | Self::Dead | Self::End => PageKind::Result,
            Self::Settings | Self::Keys | Self::Levels | Self::Maps => {
                PageKind::Menu { has_values: true }
            }
            _ => PageKind::Menu { has_values: false },
        }
    }
}

impl AppScreen {
    /// Returns true if the screen is a question before the first step of a level.
    fn is_before_start(self) -> bool {
        matches!(self, Self::HasSaved | Self::NoRoom | Self::Outdated(_))
    }
}

impl App {
    pub(crate) fn screen(&self) -> AppScreen {
        self.pages.page()
    }

    /// Returns true if a result is shown.
    pub(crate) fn shows_result(&self) -> bool {
        self.screen().kind() == PageKind::Result
    }

    /// Shows `screen`, with no way back.
    pub(crate) fn show(&mut self, screen: AppScreen) {
        let menu = self.menu_of(screen);
        self.pages.show(screen, menu, self.now);
        self.shown = None;
    }

    /// Opens `screen` over the current one.
    pub(crate) fn open(&mut self, screen: AppScreen) {
        let menu = self.menu_of(screen);
        self.pages.open(screen, menu, self.now);
        self.shown = None;
    }

    /// Returns to the screen from which the current one was opened, or to the game.
    pub(crate) fn close(&mut self) {
        self.pages.close(AppScreen::Playing, self.now);
        // The menu may offer different entries now.
        self.renew_menu();
    }

    /// Rebuilds the menu after a change to something that it shows.
    pub(crate) fn renew_menu(&mut self) {
        let menu = self.menu_of(self.screen());
        self.pages.renew(menu);
        self.shown = None;
    }

    /// Shows a sentence above the menu entries.
    pub(crate) fn say_in_menu(&mut self, sentence: &str) {
        let menu = self.menu_of(self.screen()).line(sentence);
        self.pages.renew(menu);
        self.shown = None;
    }
}

impl App {
    /// The menu of `screen`; empty if the screen has none.
    pub(crate) fn menu_of(&mut self, screen: AppScreen) -> Menu<MenuChoice> {
        match screen {
            AppScreen::Title => self.title_menu(),
            AppScreen::NewGame => new_game_menu(self.store.preferences().difficulty),
            AppScreen::Levels => self.level_menu(),
            AppScreen::Maps => self.map_menu(),
            AppScreen::Saves => self.saves_menu(),
            AppScreen::Remove(id) => self.remove_menu(id),
            AppScreen::Daily => self.daily_menu(),
            AppScreen::HasSaved => self.has_saved_menu(),
            AppScreen::NoRoom => self.no_room_menu(),
            AppScreen::Outdated(id) => self.outdated_menu(id),
            AppScreen::Paused => self.pause_menu(),
            AppScreen::Settings => self.settings_menu(),
            AppScreen::Keys => self.keys_menu(),
            AppScreen::Binding(action) => self.binding_menu(action),
            AppScreen::Tmux => self.tmux_menu(),
            AppScreen::Dead => self.death_menu(),
            AppScreen::LevelDone => self.level_done_menu(),
            AppScreen::End => self.end_menu(),
            _ => Menu::default(),
        }
    }

    /// Carries out the selected entry.
    pub(crate) fn choose(&mut self) {
        let Some(choice) = self.pages.menu.choice() else { return };
        match choice {
            MenuChoice::Open(screen) => self.open(screen),
            MenuChoice::Begin(difficulty) => {
                self.difficulty = difficulty;
                self.prefer(|it| it.difficulty = difficulty);
                self.begin_builtin(0);
            }
            MenuChoice::Level(index) => {
                self.difficulty = self.store.preferences().difficulty;
                self.begin_builtin(index);
            }
            MenuChoice::Map(index) => self.begin_own_map(index),
            MenuChoice::Daily => self.begin_daily(),
            MenuChoice::Endless => self.begin_endless(),
            MenuChoice::Continue(id) => {
                if self.screen() != AppScreen::Daily {
                    // A recorded script covers only the level with which the program began.
                    self.script = None;
                }
                self.continue_saved(id);
            }
            MenuChoice::Resume(id) => self.resume(id),
            MenuChoice::BeginAnew(id) => self.begin_anew(id),
            MenuChoice::Remove(id) => self.remove_saved(id),
            MenuChoice::RemoveOldest => self.remove_oldest(),
            MenuChoice::Back => self.close(),
            MenuChoice::Change(setting) => self.change_setting(setting, true),
            MenuChoice::ChangePreset => self.change_preset(true),
            MenuChoice::Retry => self.retry(),
            MenuChoice::TakeBack => self.take_back(),
            MenuChoice::GoOn => self.show(AppScreen::Playing),
            MenuChoice::Restart => self.restart_level(),
            MenuChoice::NextLevel => self.next_level(),
            MenuChoice::ToTitle => self.return_to_title(),
            MenuChoice::TellTmux => self.order_tmux(),
            MenuChoice::Leave => self.leave(),
        }
    }

    fn title_menu(&self) -> Menu<MenuChoice> {
        let menu = self
            .with_continue(Menu::default())
            .entry("New game", MenuChoice::Open(AppScreen::NewGame))
            .entry("Levels", MenuChoice::Open(AppScreen::Levels));
        let has_maps = self.offers.as_ref().is_some_and(|offers| offers.maps.is_some());
        self.with_descents(menu)
            .entries(has_maps.then_some(("My maps", "", MenuChoice::Open(AppScreen::Maps))))
            .entry("Settings", MenuChoice::Open(AppScreen::Settings))
            .entry("Help", MenuChoice::Open(AppScreen::Help))
            .entries(self.tmux_offer())
            .entry("Leave", MenuChoice::Leave)
    }

    /// The built-in levels, each with its best time and best rank.
    fn level_menu(&self) -> Menu<MenuChoice> {
        let difficulty = self.store.preferences().difficulty;
        Menu::new(format!("levels, {}", difficulty.name()))
            .line("left and right pick the difficulty")
            .entries(builtin::LEVELS.iter().enumerate().map(|(index, level)| {
                let best = self.best_of(level.name, difficulty);
                (capitalized(level.name), best, MenuChoice::Level(index))
            }))
    }

    /// The best time and best rank in the level that the store calls `name`.
    fn best_of(&self, name: &str, difficulty: Difficulty) -> String {
        self.store.best(name, difficulty).map_or_else(
            || "-".to_owned(),
            |Best { tally, rank }| {
                let taken_back = match tally.taken_back {
                    0 => String::new(),
                    count => format!("{count} taken back  "),
                };
                format!("{taken_back}{} {rank:>7}", of_steps(tally.steps))
            },
        )
    }

    /// Searches for the player's own maps.
    pub(crate) fn find_own_maps(&mut self) {
        let find = self.offers.as_mut().and_then(|offers| offers.maps.as_mut());
        self.own_maps = find.map_or_else(Vec::new, |find| find());
    }

    /// The menu of own maps, after a fresh search for them.
    fn map_menu(&mut self) -> Menu<MenuChoice> {
        self.find_own_maps();
        let difficulty = self.store.preferences().difficulty;
        let menu = Menu::new(format!("my maps, {}", difficulty.name()));
        if self.own_maps.is_empty() {
            return menu.line("No map files here. docs/maps.md says how to write one.");
        }
        menu.entries(self.own_maps.iter().enumerate().map(|(index, map)| {
            let best = self.best_of(&map.key, difficulty);
            (map.name.as_str(), best, MenuChoice::Map(index))
        }))
    }

    fn pause_menu(&self) -> Menu<MenuChoice> {
        let keys = self.settings.bindings.key_names(Action::TogglePause);
        let carried = self.game.grid().into_iter().flat_map(Game::keys);
        let menu = Menu::new("paused")
            .line(format!("{keys} resumes"))
            .line(&*self.goal.text)
            .lines(self.level_lines())
            .line(whole_seconds(self.game.elapsed()).to_string())
            .lines(carried.map(|key| format!("{key} key")))
            .entry("Continue", MenuChoice::GoOn)
            .entries((!self.is_descent()).then_some(("Restart the level", "", MenuChoice::Restart)))
            .entry("Settings", MenuChoice::Open(AppScreen::Settings))
            .entry("Help", MenuChoice::Open(AppScreen::Help));
        self.with_leaving(menu)
    }

    /// Adds the entries that leave the game.
    pub(crate) fn with_leaving(&self, menu: Menu<MenuChoice>) -> Menu<MenuChoice> {
        let title = self.offers.as_ref().map(|_| ("Leave to the title", "", MenuChoice::ToTitle));
        let leave = if self.levels.is_trial { "Back to the editor" } else { "Leave" };
        menu.entries(title).entry(leave, MenuChoice::Leave)
    }
}

/// Returns true if `key` restores the usual keys of the selected action.
fn restores(key: Key) -> bool {
    matches!(key, Key::Backspace | Key::Delete)
}

fn new_game_menu(usual: Difficulty) -> Menu<MenuChoice> {
    let about = |difficulty| match difficulty {
        Difficulty::Easy => "you keep what you've found",
        Difficulty::Normal => "guards call each other",
        Difficulty::Hard => "no checkpoints",
    };
    let entry = |it: Difficulty| (capitalized(it.name()), about(it), MenuChoice::Begin(it));
    let usual = Difficulty::ALL.iter().position(|&difficulty| difficulty == usual);
    Menu::new("new game").entries(Difficulty::ALL.map(entry)).selecting(usual.unwrap_or(0))
}

/// `text` with its first letter in upper case.
pub(crate) fn capitalized(text: &str) -> String {
    let mut letters = text.chars();
    let mut capitalized: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    // Writing to a string never fails.
    _ = capitalized.write_str(letters.as_str());
    capitalized
}

impl App {
    /// Handles a key press, repeat or release at time `now`.
    pub(crate) fn key(&mut self, event: KeyEvent, now: Duration) {
        self.advance(now);
        let binds = match self.screen() {
            AppScreen::Binding(action) => Some(action),
            _ => None,
        };
        let event = if binds.is_some() { event } else { self.settings.bindings.resolve(event) };
        let key_context = self.key_context();
        let press = self.controls.handle(event, now, &self.settings.bindings, key_context);
        let is_modifier = matches!(event.key, Key::Shift | Key::Control | Key::Alt);
        match (binds, press) {
            (Some(action), None) if is_modifier => self.bind(action, event.key),
            (Some(_), Some(_)) if is_modifier => {}
            (_, Some(press)) => self.press(event.key, press),
            (_, None) => {}
        }
    }

    /// Handles the loss of focus. The player may release keys while another window has the focus.
    pub(crate) fn focus_lost(&mut self, now: Duration) {
        self.advance(now);
        self.release_keys();
        self.pointer.forget();
    }

    /// Releases all keys.
    pub(crate) fn release_keys(&mut self) {
        self.controls.held.release_all();
    }

    /// Answers the question on the screen with the pending key, once the key can no longer repeat.
    pub(crate) fn settle(&mut self, now: Duration) {
        let effect = self.pages.settle(&self.settings.bindings, now);
        self.carry_out(effect);
    }

    /// Returns true while the game runs and is not paused.
    fn plays(&self) -> bool {
        self.screen() == AppScreen::Playing
    }

    pub(crate) fn key_context(&self) -> KeyContext {
        let plays = self.playback.is_none() || self.flies_freely();
        KeyContext {
            plays: plays && self.plays(),
            is_airborne: self.playback.is_none() && self.game.grid().is_some_and(Game::is_airborne),
            flies: self.game.grid().is_none(),
        }
    }

    fn press(&mut self, key: Key, press: Press) {
        let (bindings, held) = (&self.settings.bindings, &self.controls.held);
        match self.pages.press((key, press), bindings, held, self.now) {
            Effect::Other => match self.pages.menu.choice() {
                Some(MenuChoice::Continue(id)) if self.removes(key) => {
                    self.open(AppScreen::Remove(id));
                }
                Some(MenuChoice::Open(AppScreen::Binding(action))) if restores(key) => {
                    self.restore_keys(action);
                }
                _ => self.press_command(key, press),
            },
            effect => self.carry_out(effect),
        }
    }

    fn carry_out(&mut self, effect: Effect) {
        match effect {
            Effect::Answer(key) => {
                if let AppScreen::Binding(action) = self.screen() {
                    self.bind(action, key);
                } else if self.plays()
                    && self.settings.bindings.action(key) == Some(Action::TakeBack)
                {
                    self.take_back();
                }
            }
            Effect::None | Effect::Other => {}
            Effect::Redraw => self.shown = None,
            Effect::Change { forward } => self.change_value(forward),
            Effect::Choose => self.choose(),
            Effect::Leave(true) => self.leave(),
            Effect::Leave(false) => self.close(),
        }
    }

    /// Handles the keys of the game, and the keys that have the same effect on every screen.
    fn press_command(&mut self, key: Key, press: Press) {
        if self.screen() == AppScreen::Playing && self.press_in_playback(key, press) {
            return;
        }
        if let AppScreen::Binding(_) = self.screen() {
            return self.press_to_bind(key, press);
        }
        if self.levels.is_trial && key == Key::Escape && self.plays() && press != Press::Repeat {
            return self.leave();
        }
        match self.settings.bindings.action(key) {
            Some(Action::WidenView) => self.widen_view(true),
            Some(Action::NarrowView) => self.widen_view(false),
            Some(Action::TakeBack) if self.plays() => {
                let bindings = &self.settings.bindings;
                let effect = self.pages.press_to_answer(key, press, bindings, self.now);
                self.carry_out(effect);
            }
            Some(action) if press != Press::Repeat => self.command(key, action),
            _ if press != Press::Repeat && key == Key::Backspace => self.go_back(),
            _ => {}
        }
    }

    /// Uses `key` as the answer to the question for a new key. Escape cancels.
    fn press_to_bind(&mut self, key: Key, press: Press) {
        if key != Key::Escape {
            let bindings = &self.settings.bindings;
            let effect = self.pages.press_to_answer(key, press, bindings, self.now);
            self.carry_out(effect);
        } else if press != Press::Repeat {
            self.close();
        }
    }

    fn change_value(&mut self, forward: bool) {
        match (self.screen(), self.pages.menu.choice()) {
            (AppScreen::Levels | AppScreen::Maps, _) => self.change_difficulty(forward),
            (_, Some(MenuChoice::Change(setting))) => self.change_setting(setting, forward),
            (_, Some(MenuChoice::ChangePreset)) => self.change_preset(forward),
            _ => {}
        }
    }

    /// Returns true if `key` removes the selected saved game.
    fn removes(&self, key: Key) -> bool {
        self.screen() == AppScreen::Saves && matches!(key, Key::Char('x') | Key::Delete)
    }

    fn command(&mut self, key: Key, action: Action) {
        match (self.screen(), action) {
            (screen, Action::Leave) if key == Key::Escape && screen != AppScreen::Playing => {
                self.go_back();
            }
            (_, Action::Leave) => self.ask_to_leave(),
            (AppScreen::Help, Action::ToggleHelp) | (AppScreen::Paused, Action::TogglePause) => {
                self.close();
            }
            (_, Action::ToggleHelp) => self.open(AppScreen::Help),
            (AppScreen::Playing, Action::TogglePause) => self.open(AppScreen::Paused),
            (_, Action::TakeBack) if key == Key::Backspace => self.go_back(),
            _ if self.demo.is_some() => {}
            (_, Action::ToggleMinimap) => toggle(&mut self.map.is_shown, &mut self.shown),
            (_, Action::ToggleDuck) => toggle(&mut self.controls.toggles.ducks, &mut self.shown),
            (_, Action::ToggleRun) => toggle(&mut self.controls.toggles.runs, &mut self.shown),
            (_, Action::ToggleCrosshair) => self.prefer(|it| it.crosshair ^= true),
            (_, Action::ToggleCompass) => self.prefer(|it| it.compass ^= true),
            (_, Action::ToggleGhost) => self.toggle_ghost(),
            (_, Action::ToggleStats) => toggle(&mut self.settings.shows_stats, &mut self.shown),
            (AppScreen::Playing, Action::ToggleWalkOn) => {
                toggle(&mut self.controls.toggles.keeps_walking, &mut self.shown);
            }
            (_, Action::ToggleMouse) => {
                self.pointer.toggle();
                self.shown = None;
            }
            (_, Action::ChangeMap(change)) => {
                self.map.change(change);
                self.shown = None;
            }
            _ => {}
        }
    }

    /// Changes a preference and stores it.
    pub(crate) fn prefer(&mut self, change: impl Fn(&mut Preferences)) {
        let mut preferences = self.store.preferences();
        change(&mut preferences);
        self.store.set_preferences(preferences);
        self.controls.toggles.runs_by_default = preferences.runs;
        self.shown = None;
    }

    /// Returns to the previous screen. If there is none, leaves to the title or leaves the program.
    fn go_back(&mut self) {
        match self.screen() {
            AppScreen::Playing => {}
            AppScreen::Title => self.leave(),
            screen if !screen.is_before_start() => self.close(),
            _ if self.offers.is_some() => self.return_to_title(),
            _ => self.leave(),
        }
    }

    /// Asks whether to leave. If there is no game to lose, leaves without asking.
    fn ask_to_leave(&mut self) {
        let has_game = self.demo.is_none() && self.playback.is_none();
        if !has_game || self.levels.is_trial || self.screen().is_before_start() {
            self.leave();
        } else {
            self.open(AppScreen::Leaving);
        }
    }

    /// Leaves the program.
    pub(crate) fn leave(&mut self) {
        _ = self.leave_game();
        self.has_left = true;
    }

    /// Handles a mouse event at time `now`.
    pub(crate) fn mouse(&mut self, event: MouseEvent, now: Duration) {
        self.advance(now);
        self.mouse_in_playback(event);
        self.pointer.handle(event, self.key_context().plays);
    }

    /// The player's intents for the next step, from keys and mouse.
    pub(crate) fn wanted(&self) -> Intents {
        let keys = self.intents();
        keys.iter()
            .chain(self.pointer.clicked().iter())
            .collect::<Intents>()
            .with_look(self.pointer.look())
    }

    /// The player's intents from the held keys.
    pub(crate) fn intents(&self) -> Intents {
        self.controls.intents(&self.settings.bindings, self.key_context())
    }

    fn widen_view(&mut self, widens: bool) {
        let view = widened(self.settings.field_of_view, widens);
        self.settings.field_of_view = view;
        self.prefer(|it| it.field_of_view = Some(ViewAngle::nearest(view)));
    }
}

/// Toggles a switch that the screen shows.
fn toggle<T>(switch: &mut bool, shown: &mut Option<T>) {
    *switch = !*switch;
    *shown = None;
}
