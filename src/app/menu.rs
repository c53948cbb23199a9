//! Menus: a panel with text and a list of entries, with one selected.
//!
//! Every panel that asks for a choice is such a menu, and the same keys work in all of them:
//! the arrows or the keys to walk select, Enter or Space chooses, a digit chooses the entry with
//! that number, Escape or Backspace goes back. On a result, only Enter and the arrows act, and the selection
//! stops at both ends. A list that is higher than the window scrolls, and
//! the text above it is cut first.

use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};
use ratatui::text::{Line, Span, Text};

use super::panels::{BORDERS, PADDING, message, wrapped};
use crate::app::bindings::{Action, Bindings};
use crate::game::Intent;
use crate::terminal::Key;
use crate::tui::canvas::Canvas;

/// A list of entries with choices of the type `C`.
#[derive(Clone, Debug)]
pub struct Menu<C> {
    title: String,
    text: Vec<String>,
    entries: Vec<Entry<C>>,
    selected: usize,
    /// The first entry shown, and the number of entries shown last.
    first: usize,
    page: usize,
}

#[derive(Clone, Debug)]
struct Entry<C> {
    label: String,
    /// Shown at the right.
    pub value: String,
    choice: C,
}

/// A movement of the selection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Selection {
    /// The entry before.
    Previous,
    /// The next entry.
    Next,
    /// The entry a page above.
    PageUp,
    /// The entry a page below.
    PageDown,
    /// The first entry.
    First,
    /// The last entry.
    Last,
}

impl Selection {
    /// The movement of the selection by `key`: the keys to walk, and keys that every terminal has.
    pub(crate) fn by(key: Key, bindings: &Bindings) -> Option<Self> {
        Some(match key {
            Key::Up => Self::Previous,
            Key::Down => Self::Next,
            Key::PageUp => Self::PageUp,
            Key::PageDown => Self::PageDown,
            Key::Home => Self::First,
            Key::End => Self::Last,
            _ => match bindings.action(key)? {
                Action::Want(Intent::Forward) => Self::Previous,
                Action::Want(Intent::Back) => Self::Next,
                _ => return None,
            },
        })
    }
}

/// Whether `key` changes a value to the next one, or to the one before; `None` if it does neither.
pub(crate) fn changes_by(key: Key, bindings: &Bindings) -> Option<bool> {
    match key {
        Key::Right => Some(true),
        Key::Left => Some(false),
        _ => match bindings.action(key)? {
            Action::Want(Intent::StrafeRight) => Some(true),
            Action::Want(Intent::StrafeLeft) => Some(false),
            _ => None,
        },
    }
}

/// The columns before a label, with a mark if the entry is selected.
const MARK: &str = "> ";
/// The least number of columns between a label and its value.
const GAP: usize = 2;

impl<C: Copy> Menu<C> {
    /// A menu without entries.
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            text: Vec::new(),
            entries: Vec::new(),
            selected: 0,
            first: 0,
            page: 0,
        }
    }

    /// Adds a line of text above the entries.
    pub fn line(mut self, text: impl Into<String>) -> Self {
        self.text.push(text.into());
        self
    }

    /// Adds an entry.
    pub fn entry(self, label: impl Into<String>, choice: C) -> Self {
        self.entry_with(label, "", choice)
    }

    /// Adds an entry with a value at its right.
    pub fn entry_with(
        mut self,
        label: impl Into<String>,
        value: impl Into<String>,
        choice: C,
    ) -> Self {
        self.entries.push(Entry { label: label.into(), value: value.into(), choice });
        self
    }

    /// Selects the entry with that index, or the last one.
    pub fn selecting(mut self, index: usize) -> Self {
        self.selected = index.min(self.entries.len().saturating_sub(1));
        self
    }

    /// The index of the selected entry.
    pub fn selected(&self) -> usize {
        self.selected
    }

    /// The choice of the selected entry; `None` if the menu is empty.
    pub fn choice(&self) -> Option<C> {
        self.entries.get(self.selected).map(|entry| entry.choice)
    }

    /// The label of the selected entry.
    #[cfg(test)]
    pub(crate) fn label(&self) -> Option<String> {
        self.entries.get(self.selected).map(|entry| entry.label.clone())
    }

    /// Whether there is an entry with the number `digit`, counted from 1.
    pub fn has_number(&self, digit: char) -> bool {
        self.index_of(digit).is_some()
    }

    /// Selects the entry with the number `digit`, counted from 1, if there is one.
    pub fn select_number(&mut self, digit: char) {
        self.selected = self.index_of(digit).unwrap_or(self.selected);
    }

    /// Selects the next entry, or the one before, if there is one.
    pub(crate) fn select_neighbour(&mut self, forward: bool) {
        let last = self.entries.len().saturating_sub(1);
        let selected = self.selected;
        self.selected = if forward { (selected + 1).min(last) } else { selected.saturating_sub(1) };
    }

    /// Selects the entry with that choice, if there is one. Returns whether there is.
    pub fn select_choice(&mut self, choice: C) -> bool
    where
        C: PartialEq,
    {
        let index = self.entries.iter().position(|entry| entry.choice == choice);
        self.selected = index.unwrap_or(self.selected);
        index.is_some()
    }

    fn index_of(&self, digit: char) -> Option<usize> {
        let index = digit.to_digit(10)?.checked_sub(1)? as usize;
        (index < self.entries.len()).then_some(index)
    }

    /// Moves the selection. From the last entry, the next one is the first.
    pub(crate) fn select(&mut self, selection: Selection) {
        let (count, page) = (self.entries.len().max(1), self.page.max(1));
        let last = count - 1;
        self.selected = match selection {
            Selection::Previous => (self.selected + last) % count,
            Selection::Next => (self.selected + 1) % count,
            Selection::PageUp => self.selected.saturating_sub(page),
            Selection::PageDown => (self.selected + page).min(last),
            Selection::First => 0,
            Selection::Last => last,
        };
    }

    /// Draws the menu in the middle of `room`.
    pub fn draw(&mut self, canvas: &mut impl Canvas, room: Rect) {
        let most_rows = usize::from(room.height.saturating_sub(BORDERS)).max(1);
        let most_columns = usize::from(room.width.saturating_sub(BORDERS + PADDING)).max(1);
        self.page = self.entries.len().min(most_rows);
        self.scroll();
        let text: Vec<String> =
            self.text.iter().flat_map(|line| wrapped(line, most_columns)).collect();
        let room_for_text = most_rows - self.page;
        let text = &text[..text.len().min(room_for_text)];
        let is_separated = !text.is_empty() && text.len() < room_for_text && self.page > 0;
        let shown = &self.entries[self.first..][..self.page];
        let text_width = text.iter().map(|line| line.chars().count()).max().unwrap_or(0);
        let width = shown.iter().map(Entry::width).max().unwrap_or(0).max(text_width);
        let title = self.shown_title();
        let width = width.max(title.chars().count()).min(most_columns);
        let above = text.iter().map(|line| Line::raw(line.as_str()).centered());
        let entries = (self.first..).zip(shown).map(|(index, entry)| {
            let line = Line::raw(entry.line(index == self.selected, width));
            if index == self.selected { line.style(SELECTED) } else { line }
        });
        let lines: Vec<Line> =
            above.chain(is_separated.then(Line::default)).chain(entries).collect();
        message(canvas, room, &title, Text::from(lines));
    }

    /// The title, and where the list is scrolled, the number of the selected entry.
    fn shown_title(&self) -> String {
        if self.page < self.entries.len() {
            let place = format!("{} {}/{}", self.title, self.selected + 1, self.entries.len());
            place.trim_start().to_owned()
        } else {
            self.title.clone()
        }
    }

    /// Scrolls until the selected entry is shown.
    fn scroll(&mut self) {
        let last = self.entries.len() - self.page;
        let least = (self.selected + 1).saturating_sub(self.page);
        self.first = self.first.clamp(least, self.selected.max(least)).min(last);
    }
}

/// The style of the selected entry.
const SELECTED: Style = Style::new().add_modifier(Modifier::REVERSED);

impl<C> Entry<C> {
    fn width(&self) -> usize {
        let value = Span::raw(&self.value).width();
        MARK.len() + Span::raw(&self.label).width() + if value > 0 { GAP + value } else { 0 }
    }

    /// The entry in `width` columns. The label is cut where the value needs its room.
    fn line(&self, is_selected: bool, width: usize) -> String {
        let mark = if is_selected { MARK } else { "  " };
        let value_width = self.value.chars().count();
        let room = width.saturating_sub(MARK.len() + value_width);
        let label: String = self.label.chars().take(room).collect();
        format!("{mark}{label:<room$}{}", self.value)
    }
}

#[cfg(test)]
mod tests;
