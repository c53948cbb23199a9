//! The events of the driver, and the effect of each on the page.

use super::messages::{Request, SessionEvent};
use super::page::Page;
use super::stay::Stay;
use super::visit::{Draining, Visit};
use crate::sessions::line::Line;

impl Visit {
    /// Records an event of the driver.
    pub(crate) fn notify(&mut self, event: SessionEvent) {
        self.is_stale = true;
        match event {
            SessionEvent::Named(answer) => self.named(answer),
            SessionEvent::Rooms(rooms) => {
                self.rooms = rooms;
                if self.stay.is_none() {
                    self.renew_menu();
                }
            }
            SessionEvent::Entered { member, .. } => {
                self.note = None;
                self.stay = Some(Stay::new(member, self.identity.configuration.minimap));
                self.clock.skip_to(self.now);
                self.show(Page::Room);
            }
            SessionEvent::Refused(sentence) | SessionEvent::Left(sentence) => {
                self.leave_room(Some(sentence));
            }
            SessionEvent::Board { level, difficulty, rows } => {
                let asked = self.host.catalog.names().get(self.board.level);
                let is_asked = self.identity.preferences.difficulty == difficulty;
                if asked == Some(&level) && is_asked {
                    self.board.rows = Some(rows);
                    self.renew_menu();
                }
            }
            SessionEvent::Ghosts { level, difficulty, ghosts } => {
                if let Some(stay) = &mut self.stay {
                    stay.ghosts.receive(level, difficulty, ghosts);
                }
            }
            SessionEvent::Result(sentence) => self.hear(sentence),
            SessionEvent::Said(line) => self.hear(format!("{}: {line}", self.host.name)),
            SessionEvent::Draining { ends_at, can_return } => {
                self.draining = Some(Draining { ends_at, can_return });
                self.renew_menu();
            }
            SessionEvent::Ended(sentence) => self.farewell = Some(sentence),
        }
    }

    fn named(&mut self, answer: Result<Line, String>) {
        self.awaits_name = false;
        match answer {
            Ok(name) => {
                self.identity.name = name;
                self.identity.is_named = true;
                self.enter_lobby();
            }
            Err(sentence) => self.note = Some(sentence),
        }
    }

    /// Shows the lobby for the first time.
    pub(crate) fn enter_lobby(&mut self) {
        self.note = None;
        self.ask(Request::Rooms);
        self.show(Page::Lobby);
    }

    fn hear(&mut self, sentence: String) {
        if let Some(stay) = &mut self.stay {
            stay.talk.hear_host(sentence, self.now);
        } else {
            self.note = Some(sentence);
            self.renew_menu();
        }
    }
}
