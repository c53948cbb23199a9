//! Events: the effect of each key on each page.
//!
//! As in a game at home, a [`PendingKey`](cellcaster::app::parts::PendingKey) decides which presses answer a
//! question.

use std::time::Duration;

use super::Request;
use super::choice::Choice;
use super::page::Page;
use super::visit::Visit;
use crate::rooms::room::Command;
use crate::sessions::line::Line;
use cellcaster::app::parts::{Action, Selection, changes_by};
use cellcaster::terminal::{Event, Key, KeyEvent, MouseEvent, Phase, QuitReason};
use cellcaster::tui::Press;

impl Visit {
    /// Handles an event of the terminal.
    pub(crate) fn event(&mut self, event: Event, now: Duration) {
        self.advance(now);
        match event {
            Event::Key(event) => self.key(event),
            Event::Mouse(event) => self.mouse(event),
            Event::FocusLost => {
                self.release_keys();
                self.pointer.forget();
            }
            Event::KeyReleases(reported) => {
                self.controls.held.set_reports_releases(reported);
                self.detection.reports_releases = Some(reported);
                self.is_stale = true;
            }
            Event::Resized | Event::ColorDepth(_) | Event::Identified => self.is_stale = true,
            Event::Quit(QuitReason::Interrupted) => {
                self.idle.restart(now);
                self.interrupted();
            }
            Event::Quit(_)
            | Event::FocusGained
            | Event::Ready
            | Event::Suspend
            | Event::TmuxTold(_) => {}
        }
    }

    fn key(&mut self, event: KeyEvent) {
        if event.phase != Phase::Release {
            self.is_stale |= self.idle.restart(self.now);
        }
        if self.page.is_typed_in() && event.phase != Phase::Release {
            return self.press_while_typing(event);
        }
        let event = self.bindings.resolve(event);
        let context = self.key_context();
        let press = self.controls.handle(event, self.now, &self.bindings, context);
        if let Some(press) = press {
            self.press(event.key, press);
        }
        self.want();
    }

    /// Handles an event of the mouse, which turns the player and does nothing else, as at home.
    fn mouse(&mut self, event: MouseEvent) {
        self.is_stale |= self.idle.restart(self.now);
        let plays = self.is_playing();
        self.pointer.handle(event, plays);
        self.want();
    }

    fn press(&mut self, key: Key, press: Press) {
        self.pending.forget();
        match self.page {
            Page::Help if self.help.scroll(key) => self.is_stale = true,
            Page::Leaving => self.press_to_answer(key, press),
            Page::Room => self.press_in_room(key, press),
            page if page.has_menu() => self.press_in_menu(key, press),
            _ => self.press_command(key, press),
        }
    }

    /// Answers the question by a pending key that did not repeat.
    pub(crate) fn settle(&mut self) {
        if let Some(key) = self.pending.settle(self.now) {
            self.answer(key);
        }
    }

    /// Handles Ctrl-C. In a room and elsewhere, the first one asks and the second one leaves.
    fn interrupted(&mut self) {
        match self.page {
            Page::Leaving | Page::RoomMenu => self.say_goodbye(),
            _ if self.stay.is_some() => self.open(Page::RoomMenu),
            _ => self.open(Page::Leaving),
        }
    }

    fn say_goodbye(&mut self) {
        self.farewell = Some("Goodbye.".to_owned());
    }

    fn press_while_typing(&mut self, event: KeyEvent) {
        match (self.page, event.key) {
            (Page::Name, Key::Escape) => self.open(Page::Leaving),
            (_, Key::Escape) => self.show(Page::Room),
            (_, Key::Enter) if event.phase == Phase::Press => self.submit(),
            _ => self.is_stale |= self.entry.press(event),
        }
    }

    /// Takes the line that was typed.
    fn submit(&mut self) {
        if self.page == Page::Chat {
            if let Some(line) = self.entry.line() {
                self.ask(Request::Command(Command::Say(line)));
            }
            return self.show(Page::Room);
        }
        let name = self.entry.line();
        if self.identity.is_named && name.as_ref() == Some(&self.identity.name) {
            return self.enter_lobby();
        }
        if !std::mem::replace(&mut self.awaits_name, true) {
            let name = name.as_ref().map_or("", Line::as_str).to_owned();
            self.ask(Request::Name(name));
        }
    }

    fn press_in_menu(&mut self, key: Key, press: Press) {
        if let Some(selection) = Selection::by(key, &self.bindings) {
            self.menu.select(selection);
            self.is_stale = true;
        } else if let Some(forward) = changes_by(key, &self.bindings) {
            self.change_value(forward);
        } else if self.chooses(key) {
            self.press_to_answer(key, press);
        } else {
            self.press_command(key, press);
        }
    }

    fn chooses(&self, key: Key) -> bool {
        let leaves = self.page == Page::RoomMenu && self.leaves(key);
        match key {
            Key::Enter | Key::Char(' ') => true,
            Key::Char(digit) => leaves || self.menu.has_number(digit),
            _ => false,
        }
    }

    /// Whether `key` leaves, other than Escape, which goes back.
    fn leaves(&self, key: Key) -> bool {
        key != Key::Escape && self.bindings.action(key) == Some(Action::Leave)
    }

    fn change_value(&mut self, forward: bool) {
        use super::settings::Preference;
        match (self.page, self.menu.choice()) {
            (Page::Settings, Some(Choice::Change(preference))) => {
                self.change_preference(preference, forward);
            }
            (Page::Levels(mode), _) if !mode.has_guards() => {}
            (Page::Levels(_) | Page::Board, _) => {
                let selected = self.menu.selected();
                self.change_preference(Preference::Difficulty, forward);
                self.menu = self.menu_of(self.page).selecting(selected);
                if self.page == Page::Board {
                    self.ask_for_board();
                    self.renew_menu();
                }
            }
            _ => {}
        }
    }

    pub(crate) fn press_to_answer(&mut self, key: Key, press: Press) {
        if let Some(key) = self.pending.press(key, press, self.now) {
            self.answer(key);
        }
    }

    fn answer(&mut self, key: Key) {
        match (self.page, key) {
            (Page::Leaving, _) if key == Key::Enter || self.leaves(key) => self.say_goodbye(),
            (Page::Leaving, _) => self.close(),
            (Page::Room, _) => self.retry(),
            (Page::RoomMenu, _) if self.leaves(key) => {
                self.menu.select_choice(Choice::LeaveRoom);
                self.choose();
            }
            _ => {
                if let Key::Char(digit) = key {
                    self.menu.select_number(digit);
                }
                self.choose();
            }
        }
    }

    /// Handles the keys that do the same on every page with a menu, and on the help.
    fn press_command(&mut self, key: Key, press: Press) {
        if press == Press::Repeat {
            return;
        }
        match self.bindings.action(key) {
            Some(Action::ToggleHelp) if self.page == Page::Help => self.close(),
            Some(Action::ToggleHelp) => self.open(Page::Help),
            _ if matches!(key, Key::Escape | Key::Backspace) => self.go_back(),
            Some(Action::Leave) if self.stay.is_some() => self.open(Page::RoomMenu),
            Some(Action::Leave) => self.open(Page::Leaving),
            _ => {}
        }
    }

    fn go_back(&mut self) {
        match self.page {
            Page::Lobby => self.open(Page::Leaving),
            Page::Entering => {}
            _ => self.close(),
        }
    }
}
