//! Screens: the pages of the game at home.

use crate::app::App;
use crate::app::page::{Kind, Page};
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

impl Page for Screen {
    fn kind(self) -> Kind {
        match self {
            Self::Playing => Kind::Bare,
            Self::Help => Kind::Help,
            Self::Leaving => Kind::Leaving,
            Self::LevelDone | Self::Dead | Self::End => Kind::Result,
            Self::Settings | Self::Levels | Self::Maps => Kind::Menu { has_values: true },
            _ => Kind::Menu { has_values: false },
        }
    }
}

impl Screen {
    /// Whether the screen is a question before the first step of a level.
    pub(crate) fn is_before_start(self) -> bool {
        matches!(self, Self::HasSaved | Self::NoRoom | Self::Outdated(_))
    }
}

impl App {
    pub(crate) fn screen(&self) -> Screen {
        self.pages.page()
    }

    /// Whether a result is shown.
    pub(crate) fn shows_result(&self) -> bool {
        self.screen().kind() == Kind::Result
    }

    /// Shows `screen`, from which there is no way back.
    pub(crate) fn show(&mut self, screen: Screen) {
        let menu = self.menu_of(screen);
        self.pages.show(screen, menu, self.now);
        self.shown = None;
    }

    /// Opens `screen` over the one that is shown.
    pub(crate) fn open(&mut self, screen: Screen) {
        let menu = self.menu_of(screen);
        self.pages.open(screen, menu, self.now);
        self.shown = None;
    }

    /// Returns to the screen from which this one was opened, or to the game.
    pub(crate) fn close(&mut self) {
        self.pages.close(Screen::Playing, self.now);
        self.shown = None;
        if self.screen() == Screen::Title {
            // What it offers may have changed.
            self.renew_menu();
        }
    }

    /// Makes the menu again, after something that it shows has changed.
    pub(crate) fn renew_menu(&mut self) {
        let menu = self.menu_of(self.screen());
        self.pages.renew(menu);
        self.shown = None;
    }

    /// Shows a sentence above the entries of the menu.
    pub(crate) fn say_in_menu(&mut self, sentence: &str) {
        let menu = self.menu_of(self.screen()).line(sentence);
        self.pages.renew(menu);
        self.shown = None;
    }
}
