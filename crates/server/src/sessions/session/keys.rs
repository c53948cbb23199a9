//! The effect of each key on each page and in a room.

use std::time::Duration;

use super::SessionRequest;
use super::commands::columns_of;
use super::pages::{Choice, LevelChoice, Page};
use super::ui::Ui;
use crate::line::Line;
use crate::rooms::room::Command;
use cellcaster::app::parts::{Action, Choice as _, Effect, is_answerable, widened};
use cellcaster::game::Intent;
use cellcaster::terminal::{Event, Key, KeyEvent, MouseEvent, Phase, QuitReason};
use cellcaster::tui::Press;

impl Ui {
    /// Handles a terminal event.
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
        if self.page().is_typed_in() && event.phase != Phase::Release {
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

    /// Handles a mouse event. As at home, the mouse only steers the player.
    fn mouse(&mut self, event: MouseEvent) {
        self.is_stale |= self.idle.restart(self.now);
        if self.playback.is_some() {
            return self.mouse_in_playback(event);
        }
        let plays = self.is_playing();
        self.pointer.handle(event, plays);
        self.want();
    }

    fn press(&mut self, key: Key, press: Press) {
        let (bindings, held) = (&self.bindings, &self.controls.held);
        match self.pages.press((key, press), bindings, held, self.now) {
            Effect::Other if self.page() == Page::Room => self.press_in_room(key, press),
            Effect::Other if self.page() == Page::RoomMenu && self.leaves(key) => {
                self.press_to_answer(key, press);
            }
            Effect::Other => self.press_command(key, press),
            effect => self.carry_out(effect),
        }
    }

    /// Answers the question on the page with `key`, either now or once the key is known not to be repeating.
    fn press_to_answer(&mut self, key: Key, press: Press) {
        let effect = self.pages.press_to_answer(key, press, &self.bindings, self.now);
        self.carry_out(effect);
    }

    /// Answers the question on the page with a pending key that did not repeat.
    pub(crate) fn settle(&mut self) {
        let effect = self.pages.settle(&self.bindings, self.now);
        self.carry_out(effect);
    }

    fn carry_out(&mut self, effect: Effect) {
        match effect {
            Effect::None | Effect::Other => {}
            Effect::Redraw => self.is_stale = true,
            Effect::Change { forward } => self.change_value(forward),
            Effect::Choose => self.choose(),
            Effect::Leave(true) => self.say_goodbye(),
            Effect::Leave(false) => self.close(),
            Effect::Answer(_) if self.page() == Page::RoomMenu => self.leave_by_request(),
            // The question after a death.
            Effect::Answer(_) => self.retry(),
        }
    }

    /// Handles Ctrl-C: the first one asks for confirmation, and the second one leaves.
    fn interrupted(&mut self) {
        match self.page() {
            Page::Leaving | Page::RoomMenu => self.say_goodbye(),
            _ if self.playback.is_some() => self.end_playback(),
            _ if self.stay.is_some() => self.open(Page::RoomMenu),
            _ => self.open(Page::Leaving),
        }
    }

    fn say_goodbye(&mut self) {
        self.farewell = Some("Goodbye.".to_owned());
    }

    /// Returns true if `key` leaves. Escape does not count, because it goes back.
    fn leaves(&self, key: Key) -> bool {
        key != Key::Escape && self.bindings.action(key) == Some(Action::Leave)
    }

    fn change_value(&mut self, forward: bool) {
        match (self.page(), self.pages.menu.choice()) {
            (Page::Card(_), Some(Choice::ChangePrivacy)) => self.change_privacy(),
            (Page::Settings, Some(Choice::Change(row))) => self.change_setting(row, forward),
            (Page::Levels(mode), _) if !mode.has_guards() => {}
            (Page::Board, _) if self.board.level == LevelChoice::Daily => {
                self.board.day = self.board.day.neighbour(forward, self.host.today);
                self.ask_for_board();
                self.renew_menu();
            }
            (Page::Levels(_) | Page::Board, _) => {
                self.change_choices(|choices| {
                    let difficulty = &mut choices.common.preferences.difficulty;
                    *difficulty = difficulty.neighbour(forward);
                });
                if self.page() == Page::Board {
                    self.ask_for_board();
                    self.renew_menu();
                }
            }
            _ => {}
        }
    }

    /// Handles the keys that act the same on the help page and on every page with a menu.
    fn press_command(&mut self, key: Key, press: Press) {
        if press == Press::Repeat {
            return;
        }
        if let Some(choice) = self.lobby_choice(key) {
            return self.carry_out_choice(choice);
        }
        match self.bindings.action(key) {
            Some(Action::ToggleHelp) if self.page() == Page::Help => self.close(),
            Some(Action::ToggleHelp) => self.open(Page::Help),
            _ if matches!(key, Key::Escape | Key::Backspace) => self.go_back(),
            _ if key == Key::Char('/') && self.page() == Page::Lobby => self.open_chat(""),
            Some(Action::Leave) if self.stay.is_some() => self.open(Page::RoomMenu),
            Some(Action::Leave) => self.open(Page::Leaving),
            _ => {}
        }
    }

    fn go_back(&mut self) {
        match self.page() {
            Page::Lobby => self.open(Page::Leaving),
            Page::Entering => {}
            _ => self.close(),
        }
    }
}

/// Typing a name or a line of chat.
impl Ui {
    fn press_while_typing(&mut self, event: KeyEvent) {
        match (self.page(), event.key) {
            (Page::Name, Key::Escape) => self.open(Page::Leaving),
            (_, Key::Escape) => self.close(),
            (_, Key::Enter) if event.phase == Phase::Press => self.submit(),
            (page, _) => {
                self.is_stale |= self.entry.press(event);
                if page == Page::Chat {
                    self.entry.columns = columns_of(self.entry.text());
                }
            }
        }
    }

    /// Submits the typed line.
    fn submit(&mut self) {
        if self.page() == Page::Code {
            if let Some(code) = self.entry.line() {
                self.ask(SessionRequest::Code(code));
                self.open(Page::Entering);
            }
            return;
        }
        if self.page() == Page::Chat {
            self.close();
            if let Some(line) = self.entry.line() {
                self.submit_line(line);
            }
            return;
        }
        let name = self.entry.line();
        if self.identity.is_named && name.as_ref() == Some(&self.identity.name) {
            return self.enter_lobby();
        }
        if !std::mem::replace(&mut self.awaits_name, true) {
            let name = name.as_ref().map_or("", Line::as_str).to_owned();
            self.ask(SessionRequest::Name(name));
        }
    }
}

/// Keys in a room.
impl Ui {
    fn press_in_room(&mut self, key: Key, press: Press) {
        let action = self.bindings.action(key);
        match action {
            Some(Action::WidenView) => return self.widen_view(true),
            Some(Action::NarrowView) => return self.widen_view(false),
            _ if press == Press::Repeat => return,
            _ => {}
        }
        if self.press_in_playback(key, press) {
            return;
        }
        let Some(stay) = &mut self.stay else { return };
        let (is_member, watches) = (stay.member.is_some(), stay.is_watching);
        match key {
            Key::Enter if stay.dead_since.is_some() => return self.press_to_go_on(press),
            Key::Enter | Key::Char('/') => return self.open_chat(""),
            Key::Char('7') => return self.open_players(),
            Key::Char('1') if is_member => return self.open(Page::Emotes),
            Key::Char(';') => self.talk.toggle(),
            Key::Tab | Key::Right | Key::Down if watches => stay.watch_another(true),
            Key::Left | Key::Up if watches => stay.watch_another(false),
            Key::Tab => stay.shows_members ^= true,
            _ => return self.act_on(action),
        }
        self.is_stale = true;
    }

    fn act_on(&mut self, action: Option<Action>) {
        let Some(stay) = &mut self.stay else { return };
        let toggles = &mut self.controls.toggles;
        match action {
            Some(Action::ToggleHelp) => self.open(Page::Help),
            Some(Action::Leave | Action::TogglePause) => self.open(Page::RoomMenu),
            Some(Action::ToggleMinimap) => stay.map.is_shown ^= true,
            Some(Action::ChangeMap(change)) => stay.map.change(change),
            Some(Action::ToggleDuck) => toggles.ducks ^= true,
            Some(Action::ToggleRun) => toggles.runs ^= true,
            Some(Action::ToggleWalkOn) => toggles.keeps_walking ^= true,
            Some(Action::ToggleCrosshair) => {
                self.change_choices(|it| it.common.preferences.crosshair ^= true);
            }
            Some(Action::ToggleCompass) => {
                self.change_choices(|it| it.common.preferences.compass ^= true);
            }
            Some(Action::ToggleGhost) => {
                self.change_choices(|it| it.common.preferences.ghost ^= true);
            }
            Some(Action::ToggleMouse) => self.change_choices(|it| it.common.mouse ^= true),
            Some(Action::ToggleStats) => self.shows_stats ^= true,
            _ => return,
        }
        self.is_stale = true;
    }

    fn widen_view(&mut self, widens: bool) {
        self.field_of_view = widened(self.field_of_view, widens);
        self.is_stale = true;
    }

    /// Handles Enter after a death. It takes effect after the same delay as at home.
    fn press_to_go_on(&mut self, press: Press) {
        let Some(dead_since) = self.stay.as_ref().and_then(|stay| stay.dead_since) else { return };
        if is_answerable(&self.controls.held, dead_since, self.now) {
            self.press_to_answer(Key::Enter, press);
        }
    }

    /// Retries after a death, from the last checkpoint or from the start of the round.
    fn retry(&mut self) {
        let Some(stay) = self.stay.as_mut().filter(|stay| stay.dead_since.is_some()) else {
            return;
        };
        if stay.dies_for_good {
            return self.ask(SessionRequest::Command(Command::Again));
        }
        stay.intents.set([Intent::Retry].into_iter().collect());
        self.want();
    }
}
