//! What the driver brings, and its effect on each page.

use super::news::{News, Request};
use super::page::Page;
use super::stay::Stay;
use super::visit::Visit;
use crate::server::line::Line;

impl Visit {
    /// Records what the driver brings.
    pub(super) fn tell(&mut self, news: News) {
        self.is_stale = true;
        match news {
            News::Named(answer) => self.named(answer),
            News::Rooms(rooms) => {
                self.rooms = rooms;
                if self.stay.is_none() {
                    self.renew_menu();
                }
            }
            News::Entered { member, .. } => {
                self.note = None;
                self.stay = Some(Stay::new(member, self.identity.configuration.minimap));
                self.clock.skip_to(self.now);
                self.show(Page::Room);
            }
            News::Refused(sentence) | News::Left(sentence) => self.leave_room(Some(sentence)),
            News::Board { level, difficulty, rows } => {
                let asked = self.host.catalog.names().get(self.board.level);
                let is_asked = self.identity.preferences.difficulty == difficulty;
                if asked == Some(&level) && is_asked {
                    self.board.rows = Some(rows);
                    self.renew_menu();
                }
            }
            News::Ghosts { level, difficulty, ghosts } => {
                if let Some(stay) = &mut self.stay {
                    stay.ghosts.receive(level, difficulty, ghosts);
                }
            }
            News::Result(sentence) => self.hear(sentence),
            News::Said(line) => self.hear(format!("{}: {line}", self.host.name)),
            News::Draining { seconds, can_return } => {
                let then =
                    if can_return { " Connect again, and you are where you were." } else { "" };
                self.draining = Some(format!("The server ends in {seconds} seconds.{then}"));
                self.renew_menu();
            }
            News::Ended(sentence) => self.farewell = Some(sentence),
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
    pub(super) fn enter_lobby(&mut self) {
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
