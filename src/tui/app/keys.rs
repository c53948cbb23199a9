//! What keys do.

use std::time::Duration;

use super::{App, Screen};
use crate::game::{Intent, Intents};
use crate::terminal::{Key, KeyEvent, Phase};
use crate::tui::bindings::Action;
use crate::world::FieldOfView;

/// By how much a key widens or narrows the view, and how far, in degrees.
const VIEW_STEP: f64 = 6.0;
const NARROWEST_VIEW: f64 = 30.0;
const WIDEST_VIEW: f64 = 120.0;

impl App {
    /// A key was pressed, repeated or released at that time.
    pub(super) fn key(&mut self, event: KeyEvent, now: Duration) {
        self.advance(now);
        let event = self.settings.bindings.resolve(event);
        let action = self.settings.bindings.action(event.key);
        if let Some(Action::Want(_)) = action {
            let bindings = &self.settings.bindings;
            let opposes = |other| {
                action.zip(bindings.action(other)).is_some_and(|(one, other)| one.opposes(other))
            };
            self.held.note(event, now, opposes);
        }
        if event.phase != Phase::Release {
            self.press(event.key, action);
        }
    }

    /// What is typed goes to another window: keys may be let go of there.
    pub(super) fn focus_lost(&mut self, now: Duration) {
        self.advance(now);
        self.held.clear();
        self.pointer.forget();
    }

    fn press(&mut self, key: Key, action: Option<Action>) {
        match (self.screen, action) {
            (Screen::Help, _) if self.scroll_help(key) => {}
            (Screen::LevelDone, _) if is_confirmation(key) => self.next_level(),
            (Screen::End, _) if is_confirmation(key) => self.has_left = true,
            (Screen::Help, Some(Action::Leave)) if key == Key::Escape => self.show(Screen::Playing),
            (_, Some(Action::Leave)) => self.has_left = true,
            (Screen::Playing, Some(Action::ToggleHelp)) => self.show(Screen::Help),
            (Screen::Playing, Some(Action::TogglePause)) => self.show(Screen::Paused),
            (Screen::Help, Some(Action::ToggleHelp))
            | (Screen::Paused, Some(Action::TogglePause)) => self.show(Screen::Playing),
            (_, Some(Action::ToggleMinimap)) => {
                self.map.is_shown = !self.map.is_shown;
                self.shown = None;
            }
            (_, Some(Action::ChangeMap(change))) => {
                self.map.change(change);
                self.shown = None;
            }
            (
                Screen::Playing,
                Some(Action::Want(tap @ (Intent::Open | Intent::Jump | Intent::LookAhead))),
            ) => self.pressed.insert(tap),
            (_, Some(Action::ToggleDuck)) => {
                self.gait.ducks = !self.gait.ducks;
                self.shown = None;
            }
            (_, Some(Action::ToggleRun)) => {
                self.gait.runs = !self.gait.runs;
                self.shown = None;
            }
            (_, Some(Action::ToggleMouse)) => {
                self.pointer.toggle();
                self.shown = None;
            }
            (_, Some(Action::ToggleStats)) => {
                self.shows_stats = !self.shows_stats;
                self.shown = None;
            }
            (_, Some(Action::WidenView)) => self.widen_view(VIEW_STEP),
            (_, Some(Action::NarrowView)) => self.widen_view(-VIEW_STEP),
            _ => {}
        }
    }

    /// What the player wants, by the keys that are held.
    pub(super) fn intents(&self) -> Intents {
        let wanted = self.held.iter().filter_map(|key| match self.settings.bindings.action(key) {
            Some(Action::Want(intent)) => Some(intent),
            _ => None,
        });
        let aims = self.held.iter().any(|key| self.turns(key) && !self.held.is_certain(key));
        let others = [
            self.gait.runs.then_some(Intent::Run),
            self.gait.ducks.then_some(Intent::Duck),
            aims.then_some(Intent::Aim),
        ];
        wanted.chain(self.pressed.iter()).chain(others.into_iter().flatten()).collect()
    }

    /// Whether `key` turns the player, or their gaze. What may be a tap turns slowly: it is to aim with, and on
    /// most terminals nobody says when it ends.
    fn turns(&self, key: Key) -> bool {
        let turns = [Intent::TurnLeft, Intent::TurnRight, Intent::LookUp, Intent::LookDown];
        let turns = turns.map(|turn| Some(Action::Want(turn)));
        turns.contains(&self.settings.bindings.action(key))
    }

    fn widen_view(&mut self, degrees: f64) {
        let view = (self.field_of_view.degrees() + degrees).clamp(NARROWEST_VIEW, WIDEST_VIEW);
        if let Some(view) = FieldOfView::from_degrees(view) {
            self.field_of_view = view;
        }
    }
}

fn is_confirmation(key: Key) -> bool {
    matches!(key, Key::Enter | Key::Char(' '))
}
