//! The offer to tell tmux that the terminal around it shows 24-bit colours.
//!
//! - The title has it as an entry, with a number as its key, while tmux sends fewer colours than the
//!   terminal is known to show and nothing else decides about colours.
//! - The entry opens a panel with the command. Only an answer there has the loop run it.
//!
//! Rejected: a letter as its key. A player can bind every letter, and letters that walk select in menus.

use super::menu::Menu;
use super::menus::Choice;
use super::{App, Screen};
use crate::color::palette::ColorDepth;
use crate::terminal::{ColorSource, TmuxClient};

/// The state of the player's order to tell tmux.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum TmuxOrder {
    #[default]
    None,
    /// The loop has not taken it yet.
    Given,
    Running,
    Done,
    Failed,
}

impl App {
    /// The command that is offered; `None` if nothing is offered.
    pub(crate) fn tmux_remedy(&self) -> Option<String> {
        let decides = self.detection.source == Some(ColorSource::Tmux);
        let is_offered =
            decides && self.settings.depth.is_none() && self.depth == ColorDepth::Indexed256;
        self.detection.tmux.as_ref().filter(|_| is_offered).and_then(TmuxClient::remedy)
    }

    /// Adds the offer to the title.
    pub(crate) fn with_tmux_offer(&self, menu: Menu<Choice>) -> Menu<Choice> {
        match self.tmux_remedy() {
            Some(_) => menu.entry("24-bit colours in tmux", Choice::Open(Screen::Tmux)),
            None => menu,
        }
    }

    pub(crate) fn tmux_menu(&self) -> Menu<Choice> {
        let menu = Menu::new("tmux sends 256 colours");
        let Some(remedy) = self.tmux_remedy() else { return menu.entry("Back", Choice::Back) };
        let menu = match self.tmux_order {
            TmuxOrder::None => menu
                .line("Tell this server, then detach and attach again:")
                .line(format!("tmux {remedy}"))
                .line("For good, add to ~/.tmux.conf:")
                .line(remedy)
                .entry("Tell tmux", Choice::TellTmux),
            TmuxOrder::Given | TmuxOrder::Running => menu.line("Telling tmux."),
            TmuxOrder::Done => menu
                .line("Done. Detach (prefix d), attach again, and press a key.")
                .line("For good, add to ~/.tmux.conf:")
                .line(remedy),
            TmuxOrder::Failed => menu.line("tmux did not take the command; see docs/terminals.md."),
        };
        menu.entry("Back", Choice::Back)
    }

    pub(crate) fn order_tmux(&mut self) {
        self.tmux_order = TmuxOrder::Given;
        self.renew_menu();
    }

    /// Whether tmux must be told now. The loop does it once for each order.
    pub(crate) fn take_tmux_order(&mut self) -> bool {
        let is_given = self.tmux_order == TmuxOrder::Given;
        if is_given {
            self.tmux_order = TmuxOrder::Running;
        }
        is_given
    }

    /// Shows whether telling tmux has worked.
    pub(crate) fn tmux_told(&mut self, has_worked: bool) {
        self.tmux_order = if has_worked { TmuxOrder::Done } else { TmuxOrder::Failed };
        if self.screen == Screen::Tmux {
            self.renew_menu();
        }
    }

    /// Follows a change of what was `offered` before. The selected entry of the title stays selected.
    pub(crate) fn renew_tmux_offer(&mut self, offered: Option<&str>) {
        let now = self.tmux_remedy();
        if now.as_deref() == offered {
            return;
        }
        self.tmux_order = TmuxOrder::None;
        match self.screen {
            Screen::Tmux if now.is_none() => self.close(),
            Screen::Tmux => self.renew_menu(),
            Screen::Title => {
                let selected = self.menu.choice();
                self.renew_menu();
                if let Some(choice) = selected {
                    self.menu.select_choice(choice);
                }
            }
            _ => {}
        }
    }
}
