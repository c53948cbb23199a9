//! Pages: what is shown over the picture or in its place, and the way back from it.
//!
//! The pages outside of a room lead from the name to the lobby, to the card of a room, and into it.
//! The selected entry of each is what most want, so that Enter alone leads to a first walk. Escape
//! goes back, and asks before it leaves.

use super::choice::{Choice, Target};
use super::visit::Visit;
use crate::rooms::room::Mode;
use cellcaster::app::parts::Menu;

/// A page. The effect of keys depends on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Page {
    /// The name is typed.
    Name,
    Lobby,
    /// All rooms, to go into one, or to watch.
    Rooms {
        watches: bool,
    },
    /// What to play in a new room.
    Modes,
    /// In which level.
    Levels(Mode),
    /// Of which level the board is wanted.
    Boards,
    Board,
    /// What a room is, before one goes in.
    Card(Target),
    /// The room is asked for.
    Entering,
    Settings,
    Help,
    /// The question whether to end the session.
    Leaving,
    /// In the room, with keys to walk.
    Room,
    /// A line of chat is typed.
    Chat,
    Emotes,
    /// What else there is to do in the room.
    RoomMenu,
}

impl Page {
    /// Whether the page has a menu.
    pub(crate) fn has_menu(self) -> bool {
        !matches!(self, Self::Name | Self::Help | Self::Leaving | Self::Room | Self::Chat)
    }

    /// Whether a line is typed.
    pub(crate) fn is_typed_in(self) -> bool {
        matches!(self, Self::Name | Self::Chat)
    }
}

/// A page with its menu.
pub(crate) type Shelved = (Page, Menu<Choice>);

impl Visit {
    /// Shows `page`, from which there is no way back.
    pub(crate) fn show(&mut self, page: Page) {
        self.behind.clear();
        self.enter((page, self.menu_of(page)));
    }

    /// Opens `page` over the one that is shown.
    pub(crate) fn open(&mut self, page: Page) {
        self.behind.push((self.page, self.menu.clone()));
        self.enter((page, self.menu_of(page)));
    }

    /// Returns to the page from which this one was opened.
    pub(crate) fn close(&mut self) {
        let home = if self.stay.is_some() { Page::Room } else { Page::Lobby };
        let (page, _) = self.behind.pop().unwrap_or((home, Menu::new("")));
        self.enter((page, self.menu_of(page)));
    }

    /// Makes the menu anew, after something that it shows has changed. The choice stays the same if
    /// it still exists, unless it is the first one, which is the offer.
    pub(crate) fn renew_menu(&mut self) {
        let (selected, choice) = (self.menu.selected(), self.menu.choice());
        let mut menu = self.menu_of(self.page).selecting(selected);
        if let Some(choice) = choice.filter(|_| selected > 0) {
            menu.select_choice(choice);
        }
        self.menu = menu;
        self.is_stale = true;
    }

    fn enter(&mut self, (page, menu): Shelved) {
        if self.page == Page::Room && page != Page::Room {
            self.release_keys();
        }
        self.page = page;
        self.menu = menu;
        self.pending.forget();
        self.is_stale = true;
    }
}
