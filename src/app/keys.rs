//! Keys and the mouse: their effect on each screen, and the player's intents.

use std::time::Duration;

use super::controls::KeyContext;
use super::page::Effect;
use super::screen::Choice;
use super::{App, Screen};
use crate::app::bindings::Action;
use crate::app::picture::widened;
use crate::app::store::Preferences;
use crate::game::Intents;
use crate::terminal::{Key, KeyEvent, MouseEvent};
use crate::tui::Press;

impl App {
    /// Handles a press, a repetition or a release at time `now`.
    pub(crate) fn key(&mut self, event: KeyEvent, now: Duration) {
        self.advance(now);
        let event = self.settings.bindings.resolve(event);
        let key_context = self.key_context();
        let press = self.controls.handle(event, now, &self.settings.bindings, key_context);
        if let Some(press) = press {
            self.press(event.key, press);
        }
    }

    /// Handles the loss of the focus: keys may be released in another window.
    pub(crate) fn focus_lost(&mut self, now: Duration) {
        self.advance(now);
        self.release_keys();
        self.pointer.forget();
    }

    /// Releases all keys.
    pub(crate) fn release_keys(&mut self) {
        self.controls.held.release_all();
    }

    /// Answers the question on the screen by a pending key that did not repeat.
    pub(crate) fn settle(&mut self, now: Duration) {
        let effect = self.pages.settle(&self.settings.bindings, now);
        self.carry_out(effect);
    }

    pub(crate) fn key_context(&self) -> KeyContext {
        KeyContext {
            plays: self.screen() == Screen::Playing,
            is_airborne: self.game.is_airborne(),
            flies: self.game.flies(),
        }
    }

    fn press(&mut self, key: Key, press: Press) {
        let (bindings, held) = (&self.settings.bindings, &self.controls.held);
        match self.pages.press((key, press), bindings, held, self.now) {
            Effect::Other => match self.pages.menu.choice() {
                Some(Choice::Continue(id)) if self.removes(key) => self.open(Screen::Remove(id)),
                _ => self.press_command(key, press),
            },
            effect => self.carry_out(effect),
        }
    }

    fn carry_out(&mut self, effect: Effect) {
        match effect {
            Effect::None | Effect::Answer(_) | Effect::Other => {}
            Effect::Redraw => self.shown = None,
            Effect::Change { forward } => self.change_value(forward),
            Effect::Choose => self.choose(),
            Effect::Leave(true) => self.leave(),
            Effect::Leave(false) => self.close(),
        }
    }

    /// Handles the keys of the game, and the keys with one effect on every screen.
    fn press_command(&mut self, key: Key, press: Press) {
        match self.settings.bindings.action(key) {
            Some(Action::WidenView) => self.widen_view(true),
            Some(Action::NarrowView) => self.widen_view(false),
            Some(action) if press != Press::Repeat => self.command(key, action),
            _ if press != Press::Repeat && key == Key::Backspace => self.go_back(),
            _ => {}
        }
    }

    fn change_value(&mut self, forward: bool) {
        match (self.screen(), self.pages.menu.choice()) {
            (Screen::Levels | Screen::Maps, _) => self.change_difficulty(forward),
            (_, Some(Choice::Change(setting))) => self.change_setting(setting, forward),
            _ => {}
        }
    }

    /// Whether `key` removes the selected saved game.
    fn removes(&self, key: Key) -> bool {
        self.screen() == Screen::Saves && matches!(key, Key::Char('x') | Key::Delete)
    }

    fn command(&mut self, key: Key, action: Action) {
        match (self.screen(), action) {
            (screen, Action::Leave) if key == Key::Escape && screen != Screen::Playing => {
                self.go_back();
            }
            (_, Action::Leave) => self.ask_to_leave(),
            (Screen::Help, Action::ToggleHelp) | (Screen::Paused, Action::TogglePause) => {
                self.close();
            }
            (_, Action::ToggleHelp) => self.open(Screen::Help),
            (Screen::Playing, Action::TogglePause) => self.open(Screen::Paused),
            _ if self.demo.is_some() => {}
            (_, Action::ToggleMinimap) => toggle(&mut self.map.is_shown, &mut self.shown),
            (_, Action::ToggleDuck) => toggle(&mut self.controls.toggles.ducks, &mut self.shown),
            (_, Action::ToggleRun) => toggle(&mut self.controls.toggles.runs, &mut self.shown),
            (_, Action::ToggleCrosshair) => self.prefer(|it| it.crosshair ^= true),
            (_, Action::ToggleCompass) => self.prefer(|it| it.compass ^= true),
            (_, Action::ToggleGhost) => self.toggle_ghost(),
            (_, Action::ToggleStats) => toggle(&mut self.settings.shows_stats, &mut self.shown),
            (Screen::Playing, Action::ToggleWalkOn) => {
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

    /// Keeps a choice of the player.
    pub(crate) fn prefer(&mut self, change: impl Fn(&mut Preferences)) {
        let mut preferences = self.store.preferences();
        change(&mut preferences);
        self.store.set_preferences(preferences);
        self.shown = None;
    }

    /// Returns to the screen before, or asks whether to leave where there is none.
    fn go_back(&mut self) {
        match self.screen() {
            Screen::Playing => {}
            Screen::Title => self.leave(),
            screen if screen.is_before_start() => self.give_up_beginning(),
            _ => self.close(),
        }
    }

    /// Returns to the title from a question before a level, or leaves where there is no title.
    fn give_up_beginning(&mut self) {
        match self.offers {
            Some(_) => self.return_to_title(),
            None => self.leave(),
        }
    }

    /// Asks whether to leave. Where there is no game to lose, it is not asked.
    fn ask_to_leave(&mut self) {
        if self.demo.is_some() || self.screen().is_before_start() {
            self.leave();
        } else {
            self.open(Screen::Leaving);
        }
    }

    /// Leaves the program.
    pub(crate) fn leave(&mut self) {
        _ = self.leave_game();
        self.has_left = true;
    }

    /// Handles an event of the mouse at time `now`.
    pub(crate) fn mouse(&mut self, event: MouseEvent, now: Duration) {
        self.advance(now);
        self.pointer.handle(event, self.screen() == Screen::Playing);
    }

    /// The player's intents for the next step, by keys and mouse.
    pub(crate) fn wanted(&self) -> Intents {
        let keys = self.intents();
        keys.iter()
            .chain(self.pointer.clicked().iter())
            .collect::<Intents>()
            .with_look(self.pointer.look())
    }

    /// The player's intents by the held keys.
    pub(crate) fn intents(&self) -> Intents {
        self.controls.intents(&self.settings.bindings, self.key_context())
    }

    fn widen_view(&mut self, widens: bool) {
        self.settings.field_of_view = widened(self.settings.field_of_view, widens);
    }
}

/// Toggles a switch that is visible on the screen.
fn toggle<T>(switch: &mut bool, shown: &mut Option<T>) {
    *switch = !*switch;
    *shown = None;
}
