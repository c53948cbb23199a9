//! Pages over the picture: the page shown, the way back from it, and the effect of keys on it.
//!
//! The same keys work on all pages of a kind, at home and on a server. [`Pages`] handles them, and
//! returns the [`Effect`] that its owner carries out. A page that is opened from another one returns to
//! it: the settings to the title or to the pause, wherever they were opened. The way back is a stack of
//! pages with their menus, so that the selection is the same on return.
//!
//! - Irreversible actions require a certain press, and a repetition never answers. A byte that may be the
//!   first repetition of a key counts if no other byte follows within the interval of repetitions.
//! - A page that shows a result appears while the player presses keys of the game: only Enter and the
//!   arrows act there, once the keys that were held have been released.

use std::time::Duration;

use crate::app::bindings::{Action, Bindings};
use crate::app::help::HelpScroll;
use crate::app::menu::{Menu, Selection, changes_by};
use crate::terminal::Key;
use crate::tui::{HeldKeys, Press};

/// A page, which has the keys of its kind.
pub trait Page: Copy + PartialEq {
    /// The kind of the page.
    fn kind(self) -> Kind;
}

/// A kind of pages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The picture, or a page whose owner handles its keys.
    Bare,
    /// A menu. If it has values, keys to the left and the right change them.
    Menu {
        /// Whether the entries have values.
        has_values: bool,
    },
    /// A menu that shows a result.
    Result,
    /// The help, which scrolls.
    Help,
    /// The question whether to leave.
    Leaving,
}

/// The effect of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Nothing.
    None,
    /// The page has changed.
    Redraw,
    /// Takes the next value of the selected entry, or the one before.
    Change {
        /// Whether to take the next one.
        forward: bool,
    },
    /// Chooses the selected entry.
    Choose,
    /// Answers the question whether to leave.
    Leave(bool),
    /// Answers a question of the owner.
    Answer(Key),
    /// The owner decides.
    Other,
}

/// The page that is shown, its menu, and the pages to return to.
#[derive(Clone, Debug)]
pub struct Pages<P, C> {
    page: P,
    /// The menu of the page; empty if it has none.
    pub menu: Menu<C>,
    /// The pages to return to, the next one last.
    behind: Vec<(P, Menu<C>)>,
    /// The help, if it is shown.
    pub help: HelpScroll,
    /// A key that answers the question on the page if it does not repeat until a certain time.
    pending: Option<(Key, Duration)>,
    shown_since: Duration,
}

impl<P: Page, C: Copy + PartialEq> Pages<P, C> {
    /// A page without a menu.
    pub fn new(page: P) -> Self {
        Self {
            page,
            menu: Menu::new(""),
            behind: Vec::new(),
            help: HelpScroll::default(),
            pending: None,
            shown_since: Duration::ZERO,
        }
    }

    /// The page that is shown.
    pub fn page(&self) -> P {
        self.page
    }

    /// Shows `page`, from which there is no way back.
    pub fn show(&mut self, page: P, menu: Menu<C>, now: Duration) {
        self.behind.clear();
        self.enter(page, menu, now);
    }

    /// Opens `page` over the present one.
    pub fn open(&mut self, page: P, menu: Menu<C>, now: Duration) {
        self.behind.push((self.page, self.menu.clone()));
        self.enter(page, menu, now);
    }

    /// Returns to the page from which this one was opened, or to `home`.
    pub fn close(&mut self, home: P, now: Duration) {
        let (page, menu) = self.behind.pop().unwrap_or_else(|| (home, Menu::new("")));
        self.enter(page, menu, now);
    }

    fn enter(&mut self, page: P, menu: Menu<C>, now: Duration) {
        (self.page, self.menu) = (page, menu);
        self.shown_since = now;
        self.pending = None;
    }

    /// Replaces the menu, after something that it shows has changed. The selected choice stays selected if it
    /// still exists. The first entry stays selected whatever it offers now.
    pub fn renew(&mut self, menu: Menu<C>) {
        let (selected, choice) = (self.menu.selected(), self.menu.choice());
        self.menu = menu.selecting(selected);
        if let Some(choice) = choice.filter(|_| selected > 0) {
            self.menu.select_choice(choice);
        }
    }

    /// Handles a press of `key` while the keys in `held` are down.
    pub fn press(
        &mut self,
        (key, press): (Key, Press),
        bindings: &Bindings,
        held: &HeldKeys<Key>,
        now: Duration,
    ) -> Effect {
        self.pending = None;
        match self.page.kind() {
            Kind::Help if self.help.scroll(key) => Effect::Redraw,
            Kind::Leaving => self.press_to_answer(key, press, bindings, now),
            Kind::Result
                if press == Press::Repeat || !is_answerable(held, self.shown_since, now) =>
            {
                Effect::None
            }
            Kind::Result => match key {
                Key::Up | Key::Down => {
                    self.menu.select_neighbour(key == Key::Down);
                    Effect::Redraw
                }
                Key::Enter => self.press_to_answer(key, press, bindings, now),
                _ => Effect::None,
            },
            Kind::Menu { has_values } => {
                if let Some(selection) = Selection::by(key, bindings) {
                    self.menu.select(selection);
                    Effect::Redraw
                } else if let Some(forward) = changes_by(key, bindings).filter(|_| has_values) {
                    Effect::Change { forward }
                } else if self.chooses(key) {
                    self.press_to_answer(key, press, bindings, now)
                } else {
                    Effect::Other
                }
            }
            Kind::Help | Kind::Bare => Effect::Other,
        }
    }

    /// Whether `key` chooses an entry of the menu.
    fn chooses(&self, key: Key) -> bool {
        match key {
            Key::Enter | Key::Char(' ') => true,
            Key::Char(digit) => self.menu.has_number(digit),
            _ => false,
        }
    }

    /// Answers the question on the page by `key`, now or once it is certain that it does not repeat.
    pub fn press_to_answer(
        &mut self,
        key: Key,
        press: Press,
        bindings: &Bindings,
        now: Duration,
    ) -> Effect {
        match press {
            Press::Fresh => return self.answer(key, bindings),
            Press::Unclear => self.pending = Some((key, now + REPETITION)),
            Press::Repeat => {}
        }
        Effect::None
    }

    /// The effect of a pending key that did not repeat until `now`.
    pub fn settle(&mut self, bindings: &Bindings, now: Duration) -> Effect {
        let settled = self.pending.take_if(|(_, until)| *until <= now);
        settled.map_or(Effect::None, |(key, _)| self.answer(key, bindings))
    }

    fn answer(&mut self, key: Key, bindings: &Bindings) -> Effect {
        match self.page.kind() {
            Kind::Leaving => {
                let leaves = bindings.action(key) == Some(Action::Leave) && key != Key::Escape;
                Effect::Leave(leaves || key == Key::Enter)
            }
            Kind::Menu { .. } | Kind::Result if self.chooses(key) => {
                if let Key::Char(digit) = key {
                    self.menu.select_number(digit);
                }
                Effect::Choose
            }
            _ => Effect::Answer(key),
        }
    }

    /// The time until which a key is pending.
    pub fn pending_until(&self) -> Option<Duration> {
        self.pending.map(|(_, until)| until)
    }
}

/// The least time for which a result is shown, and the time after which held keys no longer matter.
const LEAST_SHOWN: Duration = Duration::from_millis(500);
const LONGEST_WAIT: Duration = Duration::from_secs(1);

/// Whether a result that is shown since `shown_since` can be answered at `now`: half a second later, once the
/// keys that were held for the game have been released, or a second later.
pub fn is_answerable(held: &HeldKeys<Key>, shown_since: Duration, now: Duration) -> bool {
    let shown_for = now.saturating_sub(shown_since);
    let is_released = shown_for >= LEAST_SHOWN && !held.is_any_down_since(shown_since);
    is_released || shown_for >= LONGEST_WAIT
}

/// The longest interval between repetitions.
const REPETITION: Duration = Duration::from_millis(150);
