//! Screens: what is shown over the picture, and the way back from it.
//!
//! Screens that are opened from another one return to it: the settings to the title or to the
//! pause, wherever they were opened. The way back is a stack of screens with their menus, so that
//! the selection is the same on return.

use super::App;
use super::menu::Menu;
use super::menus::Choice;
use crate::app::store::SaveId;

/// The panel on the picture. The effect of keys depends on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Screen {
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
    /// The question what to do where no other game can be saved.
    NoRoom,
    /// The offer to begin a saved game anew that cannot go on.
    Outdated(SaveId),
    Settings,
    /// The question whether to tell tmux that its terminal shows 24-bit colours.
    Tmux,
    Playing,
    Paused,
    Help,
    /// The question whether to leave.
    Leaving,
    LevelDone,
    /// The player is dead.
    Dead,
    End,
}

impl Screen {
    /// Whether the screen shows a result: nothing that it offers is chosen by a key that was meant
    /// for the game.
    pub(crate) fn is_result(self) -> bool {
        matches!(self, Self::LevelDone | Self::Dead | Self::End)
    }

    /// Whether the screen is a question before the first step of a level.
    pub(crate) fn is_before_start(self) -> bool {
        matches!(self, Self::HasSaved | Self::NoRoom | Self::Outdated(_))
    }

    /// Whether the screen has a menu.
    pub(crate) fn has_menu(self) -> bool {
        !matches!(self, Self::Playing | Self::Help | Self::Leaving)
    }
}

/// A screen with its menu.
pub(crate) type Shelved = (Screen, Menu<Choice>);

impl App {
    /// Shows `screen`, from which there is no way back.
    pub(crate) fn show(&mut self, screen: Screen) {
        self.behind.clear();
        let menu = self.menu_of(screen);
        self.enter((screen, menu));
    }

    /// Opens `screen` over the one that is shown.
    pub(crate) fn open(&mut self, screen: Screen) {
        let menu = self.menu_of(screen);
        let before = (self.screen, self.menu.clone());
        self.behind.push(before);
        self.enter((screen, menu));
    }

    /// Returns to the screen from which this one was opened, or to the game.
    pub(crate) fn close(&mut self) {
        let (screen, menu) = self.behind.pop().unwrap_or_else(|| (Screen::Playing, Menu::new("")));
        self.enter((screen, menu));
        if screen == Screen::Title {
            // What it offers may have changed.
            self.renew_menu();
        }
    }

    /// Makes the menu anew, after something that it shows has changed.
    pub(crate) fn renew_menu(&mut self) {
        let selected = self.menu.selected();
        self.menu = self.menu_of(self.screen).selecting(selected);
        self.shown = None;
    }

    fn enter(&mut self, (screen, menu): Shelved) {
        self.screen = screen;
        self.menu = menu;
        self.shown_since = self.now;
        self.pending.forget();
        self.shown = None;
    }
}
