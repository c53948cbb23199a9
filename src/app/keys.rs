//! What keys do.
//!
//! What can't be taken back wants a press that is certain: a repetition never answers a question, nor does
//! anything in the first half second of a panel that shows a result. A byte that may be the first
//! repetition of a key counts once no other has followed it for as long as repetitions are apart.

use std::time::Duration;

use super::controls::Stance;
use super::{App, Screen};
use crate::app::bindings::Action;
use crate::game::Intents;
use crate::terminal::{Key, KeyEvent};
use crate::tui::Press;
use crate::world::FieldOfView;

/// By how much a key widens or narrows the view, and how far, in degrees.
const VIEW_STEP: f64 = 6.0;
const NARROWEST_VIEW: f64 = 30.0;
const WIDEST_VIEW: f64 = 120.0;

/// How long a result shows before a key takes it away.
const LEAST_SHOWN: Duration = Duration::from_millis(500);
/// Repetitions are no further apart.
const REPETITION: Duration = Duration::from_millis(150);

/// A key that may answer the question on the screen, unless it repeats before the time is up.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pending {
    key: Key,
    pub(super) until: Duration,
}

impl App {
    /// A key was pressed, repeated or released at that time.
    pub(super) fn key(&mut self, event: KeyEvent, now: Duration) {
        self.advance(now);
        let event = self.settings.bindings.resolve(event);
        let stance = self.stance();
        let press = self.controls.note(event, now, &self.settings.bindings, stance);
        if let Some(press) = press {
            self.press(event.key, press);
        }
    }

    /// What is typed goes to another window: keys may be let go of there.
    pub(super) fn focus_lost(&mut self, now: Duration) {
        self.advance(now);
        self.release_keys();
        self.pointer.forget();
    }

    /// Lets go of all keys, as when another window gets them.
    pub(super) fn release_keys(&mut self) {
        self.controls.held.release_all();
    }

    /// Answers the question on the screen by the key that turned out not to repeat.
    pub(super) fn settle(&mut self, now: Duration) {
        if let Some(Pending { key, .. }) = self.pending.take_if(|pending| pending.until <= now) {
            self.answer(key);
        }
    }

    pub(super) fn stance(&self) -> Stance {
        Stance {
            plays: self.screen == Screen::Playing,
            is_airborne: self.game.is_airborne(),
            flies: self.game.flies(),
        }
    }

    fn press(&mut self, key: Key, press: Press) {
        self.pending = None;
        if matches!(self.screen, Screen::LevelDone | Screen::End | Screen::Leaving) {
            return self.press_at_question(key, press);
        }
        if self.screen == Screen::Help && self.scroll_help(key) {
            return;
        }
        let action = self.settings.bindings.action(key);
        match action {
            Some(Action::WidenView) => self.widen_view(VIEW_STEP),
            Some(Action::NarrowView) => self.widen_view(-VIEW_STEP),
            Some(action) if press != Press::Repeat => self.command(key, action),
            _ => {}
        }
    }

    fn command(&mut self, key: Key, action: Action) {
        match (self.screen, action) {
            (Screen::Help | Screen::Paused, Action::Leave) if key == Key::Escape => {
                self.show(Screen::Playing);
            }
            (_, Action::Leave) => self.ask_to_leave(),
            (Screen::Playing, Action::ToggleHelp) => self.show(Screen::Help),
            (Screen::Playing, Action::TogglePause) => self.show(Screen::Paused),
            (Screen::Help, Action::ToggleHelp) | (Screen::Paused, Action::TogglePause) => {
                self.show(Screen::Playing);
            }
            (_, Action::ToggleMinimap) => toggle(&mut self.map.is_shown, &mut self.shown),
            (_, Action::ToggleDuck) => toggle(&mut self.controls.gait.ducks, &mut self.shown),
            (_, Action::ToggleRun) => toggle(&mut self.controls.gait.runs, &mut self.shown),
            (_, Action::ToggleStats) => toggle(&mut self.shows_stats, &mut self.shown),
            (Screen::Playing, Action::ToggleWalkOn) => {
                toggle(&mut self.controls.gait.walks_on, &mut self.shown);
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

    fn ask_to_leave(&mut self) {
        let returns_to = match self.screen {
            Screen::LevelDone => Screen::LevelDone,
            _ => Screen::Playing,
        };
        self.returns_to = returns_to;
        self.show(Screen::Leaving);
    }

    fn press_at_question(&mut self, key: Key, press: Press) {
        let is_result = self.screen != Screen::Leaving;
        if is_result && self.now < self.shown_since + LEAST_SHOWN {
            return;
        }
        match press {
            Press::Fresh => self.answer(key),
            Press::Unclear => self.pending = Some(Pending { key, until: self.now + REPETITION }),
            Press::Repeat => {}
        }
    }

    fn answer(&mut self, key: Key) {
        let confirms = matches!(key, Key::Enter | Key::Char(' '));
        let leaves = self.settings.bindings.action(key) == Some(Action::Leave);
        match self.screen {
            Screen::LevelDone if confirms => self.next_level(),
            Screen::LevelDone if leaves => self.ask_to_leave(),
            Screen::End if confirms || leaves => self.has_left = true,
            Screen::Leaving if key == Key::Enter || leaves && key != Key::Escape => {
                self.has_left = true;
            }
            Screen::Leaving => self.show(self.returns_to),
            _ => {}
        }
    }

    /// What the player wants, by the keys that are held.
    pub(super) fn intents(&self) -> Intents {
        self.controls.intents(&self.settings.bindings, self.stance())
    }

    fn widen_view(&mut self, degrees: f64) {
        let view = (self.field_of_view.degrees() + degrees).clamp(NARROWEST_VIEW, WIDEST_VIEW);
        if let Some(view) = FieldOfView::from_degrees(view) {
            self.field_of_view = view;
        }
    }
}

/// Switches something that shows on the screen.
fn toggle<T>(switch: &mut bool, shown: &mut Option<T>) {
    *switch = !*switch;
    *shown = None;
}
