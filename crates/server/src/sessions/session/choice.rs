//! What the entries of menus do.

use super::messages::Request;
use super::page::Page;
use super::settings::Preference;
use super::visit::Visit;
use crate::rooms::room::{Command, Emote, Mode};
use crate::rooms::summary::{RoomId, RoomWish};
use cellcaster::world::Difficulty;

/// What an entry of a menu does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Choice {
    /// Opens a page.
    Open(Page),
    /// Enters the room of the card.
    Enter { watches: bool },
    /// Shows the board of the level with that index.
    Board(usize),
    /// Changes a setting.
    Change(Preference),
    /// Returns to the page before.
    Back,
    /// Shows all an emotion.
    Emote(Emote),
    /// Wishes to begin the round again.
    Again,
    /// Leaves the room.
    LeaveRoom,
    /// Does nothing: the entry is only read.
    Nothing,
}

/// A room that one may enter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    /// One that there is.
    Existing(RoomId),
    /// A new one, in the level of the catalog with that index.
    New { mode: Mode, level: usize, difficulty: Difficulty },
}

impl Visit {
    /// Does what the selected entry says.
    pub(crate) fn choose(&mut self) {
        let Some(choice) = self.menu.choice() else { return };
        match choice {
            Choice::Open(page) => self.open(page),
            Choice::Enter { watches } => self.enter_room(watches),
            Choice::Board(level) => {
                self.board.level = level;
                self.ask_for_board();
                self.open(Page::Board);
            }
            Choice::Change(preference) => self.change_preference(preference, true),
            Choice::Back => self.close(),
            Choice::Emote(emote) => {
                self.ask(Request::Command(Command::Emote(emote)));
                self.show(Page::Room);
            }
            Choice::Again => {
                self.ask(Request::Command(Command::Again));
                self.show(Page::Room);
            }
            Choice::LeaveRoom => {
                self.ask(Request::Leave);
                self.leave_room(None);
            }
            Choice::Nothing => {}
        }
    }

    fn enter_room(&mut self, watches: bool) {
        let Page::Card(target) = self.page else { return };
        let ask = match target {
            Target::Existing(room) => Some(Request::Enter { room, watches }),
            Target::New { mode, level, difficulty } => {
                let level = self.host.catalog.names().get(level).cloned();
                level.map(|level| Request::Open(RoomWish { level, mode, difficulty }))
            }
        };
        if let Some(ask) = ask {
            self.ask(ask);
            self.open(Page::Entering);
        }
    }

    /// Asks for the board of the chosen level.
    pub(crate) fn ask_for_board(&mut self) {
        self.board.rows = None;
        let difficulty = self.identity.preferences.difficulty;
        if let Some(level) = self.host.catalog.names().get(self.board.level).cloned() {
            self.ask(Request::Board { level, difficulty });
        }
    }

    /// Records that the visitor is in no room any more.
    pub(crate) fn leave_room(&mut self, sentence: Option<String>) {
        self.stay = None;
        self.note = sentence;
        self.ask(Request::Rooms);
        self.show(Page::Lobby);
    }
}
