//! Pages over the picture: the current page, the way back from it, the effect of keys on it, and
//! its drawing.
//!
//! The same keys work on all pages of a kind, at home and on a server. [`Pages`] handles the keys
//! and returns an [`Effect`], which its owner carries out. A page returns to the page from which it
//! was opened. For example, the settings return to the title or to the pause page. The way back is
//! a stack of pages with their menus, so the selection is still there on return.
//!
//! - An irreversible action requires an unambiguous key press, and a key repeat never counts as an
//!   answer. A byte that may be the first repeat of a key counts only if no other byte follows
//!   within the repeat interval.
//! - A result page appears while the player presses game keys. Only Enter and the arrows act on it,
//!   and only after the keys that were held have been released.
//!
//! A menu is a panel with text and a list of entries. One entry is selected. Every panel that asks
//! for a choice is a menu, and the same keys work in all of them: the arrows or the walking
//! keys select, Enter or Space chooses, a digit chooses the entry with that number, Escape or
//! Backspace goes back. On a result page, only Enter and the arrows act, and the selection stops at
//! both ends. A list that is higher than the window scrolls, and the text above it is cut first,
//! unless it tells what the last key did.
//!
//! The help is a panel with the keys of all actions. Its first line says how to close it. If the
//! help is higher than the window, it scrolls with keys that every terminal has: the arrows, the
//! page keys, and the space bar.

use std::time::Duration;

use ratatui::layout::{Constraint, Flex, Layout, Rect, Size};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line, Span, Text};
use ratatui::widgets::{Block, Padding, Paragraph, Wrap};

use crate::app::controls::{Action, Bindings, MapChange};
use crate::game::Intent;
use crate::terminal::Key;
use crate::tui::canvas::Canvas;
use crate::tui::{HeldKeys, Minimap, Press};

/// A page. Its kind decides which keys work on it.
pub trait Page: Copy + PartialEq {
    /// The kind of the page.
    fn kind(self) -> PageKind;
}

/// A kind of page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PageKind {
    /// The picture, or a page whose owner handles the keys.
    Bare,
    /// A menu. If its entries have values, the left and right keys change them.
    Menu {
        /// `true` if the entries have values.
        has_values: bool,
    },
    /// A menu that shows a result.
    Result,
    /// The help, which scrolls.
    Help,
    /// The question whether to leave the game.
    Leaving,
}

/// The effect of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Nothing.
    None,
    /// The page has changed.
    Redraw,
    /// Take the next or the previous value of the selected entry.
    Change {
        /// `true` for the next value.
        forward: bool,
    },
    /// Choose the selected entry.
    Choose,
    /// Answer the question whether to leave.
    Leave(bool),
    /// Answer a question that the owner asked.
    Answer(Key),
    /// The owner decides.
    Other,
}

/// The current page, its menu, and the pages to return to.
#[derive(Clone, Debug)]
pub struct Pages<P, C> {
    page: P,
    /// The menu of the page; empty if the page has none.
    pub menu: Menu<C>,
    /// The pages to return to; the last one is the next to return to.
    behind: Vec<(P, Menu<C>)>,
    /// The scroll position of the help, if it is shown.
    pub help: HelpScroll,
    /// A key that answers the question on the page unless it repeats before this time.
    pending: Option<(Key, Duration)>,
    shown_since: Duration,
}

impl<P: Page + Default, C: Copy + PartialEq> Default for Pages<P, C> {
    fn default() -> Self {
        Self::new(P::default())
    }
}

impl<P: Page, C: Copy + PartialEq> Pages<P, C> {
    /// A page without a menu.
    pub fn new(page: P) -> Self {
        Self {
            page,
            menu: Menu::default(),
            behind: Vec::new(),
            help: HelpScroll::default(),
            pending: None,
            shown_since: Duration::ZERO,
        }
    }

    /// The current page.
    pub fn page(&self) -> P {
        self.page
    }

    /// Shows `page`, with no way back.
    pub fn show(&mut self, page: P, menu: Menu<C>, now: Duration) {
        self.behind.clear();
        self.enter(page, menu, now);
    }

    /// Opens `page` over the current one.
    pub fn open(&mut self, page: P, menu: Menu<C>, now: Duration) {
        self.behind.push((self.page, self.menu.clone()));
        self.enter(page, menu, now);
    }

    /// Returns to the page from which the current one was opened, or to `home` if there is none.
    pub fn close(&mut self, home: P, now: Duration) {
        let (page, menu) = self.behind.pop().unwrap_or_else(|| (home, Menu::default()));
        self.enter(page, menu, now);
    }

    fn enter(&mut self, page: P, menu: Menu<C>, now: Duration) {
        (self.page, self.menu) = (page, menu);
        self.shown_since = now;
        self.pending = None;
    }

    /// Replaces the menu after a change to something that it shows. The selected choice stays
    /// selected if it still exists. If the first entry is selected, the first entry stays selected,
    /// whatever its choice is now.
    pub fn renew(&mut self, menu: Menu<C>) {
        let (selected, choice) = (self.menu.selected, self.menu.choice());
        let index = menu.entries.iter().position(|entry| Some(entry.choice) == choice);
        self.menu = menu.selecting(index.filter(|_| selected > 0).unwrap_or(selected));
    }

    /// Handles a press of `key` while the keys in `held` are down. Returns the effect.
    pub fn press(
        &mut self,
        (key, press): (Key, Press),
        bindings: &Bindings,
        held: &HeldKeys<Key>,
        now: Duration,
    ) -> Effect {
        self.pending = None;
        match self.page.kind() {
            PageKind::Help if self.help.scroll(key) => Effect::Redraw,
            PageKind::Leaving => self.press_to_answer(key, press, bindings, now),
            PageKind::Result
                if press == Press::Repeat || !is_answerable(held, self.shown_since, now) =>
            {
                Effect::None
            }
            PageKind::Result => match key {
                Key::Up | Key::Down => {
                    self.menu.select_neighbour(key == Key::Down);
                    Effect::Redraw
                }
                Key::Enter => self.press_to_answer(key, press, bindings, now),
                _ => Effect::None,
            },
            PageKind::Menu { has_values } => {
                if let Some(selected) = self.menu.selected_by(key, bindings) {
                    self.menu.selected = selected;
                    Effect::Redraw
                } else if let Some(forward) = changes_by(key, bindings).filter(|_| has_values) {
                    Effect::Change { forward }
                } else if self.menu.chosen_by(key).is_some() {
                    self.press_to_answer(key, press, bindings, now)
                } else {
                    Effect::Other
                }
            }
            PageKind::Help | PageKind::Bare => Effect::Other,
        }
    }

    /// Uses `key` to answer the question on the page. If the press may be a repeat, the answer
    /// waits until that is ruled out.
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

    /// The effect of the pending key, if it has not repeated by `now`.
    pub fn settle(&mut self, bindings: &Bindings, now: Duration) -> Effect {
        let settled = self.pending.take_if(|(_, until)| *until <= now);
        settled.map_or(Effect::None, |(key, _)| self.answer(key, bindings))
    }

    fn answer(&mut self, key: Key, bindings: &Bindings) -> Effect {
        match self.page.kind() {
            PageKind::Leaving => {
                let leaves = bindings.action(key) == Some(Action::Leave) && key != Key::Escape;
                Effect::Leave(leaves || key == Key::Enter)
            }
            PageKind::Menu { .. } | PageKind::Result => match self.menu.chosen_by(key) {
                Some(chosen) => {
                    self.menu.selected = chosen;
                    Effect::Choose
                }
                None => Effect::Answer(key),
            },
            PageKind::Help | PageKind::Bare => Effect::Answer(key),
        }
    }

    /// The time until which a key is pending, if one is.
    pub fn pending_until(&self) -> Option<Duration> {
        self.pending.map(|(_, until)| until)
    }
}

/// The shortest time for which a result is shown, and the time after which held keys no longer
/// matter.
const MIN_SHOWN: Duration = Duration::from_millis(500);
const MAX_WAIT: Duration = Duration::from_secs(1);

/// Returns true if a result that has been on screen since `shown_since` can be answered at `now`:
/// after half a second if the keys held for the game have been released, and after one second in
/// any case.
pub fn is_answerable(held: &HeldKeys<Key>, shown_since: Duration, now: Duration) -> bool {
    let shown_for = now.saturating_sub(shown_since);
    let is_released = shown_for >= MIN_SHOWN && !held.is_any_down_since(shown_since);
    is_released || shown_for >= MAX_WAIT
}

/// The longest interval between two repeats of a key.
const REPETITION: Duration = Duration::from_millis(150);

/// A list of entries with choices of type `C`.
#[derive(Clone, Debug)]
pub struct Menu<C> {
    title: String,
    text: Vec<String>,
    /// `true` if the text stays above a list that is higher than the window.
    keeps_text: bool,
    entries: Vec<MenuEntry<C>>,
    selected: usize,
    /// The first visible entry, and the number of entries visible in the last drawing.
    first: usize,
    page: usize,
}

#[derive(Clone, Debug)]
struct MenuEntry<C> {
    label: String,
    /// The text at the right.
    value: String,
    choice: C,
}

/// Whether `key` changes a value to the next one (`true`) or the previous one (`false`); `None` if
/// it does neither.
fn changes_by(key: Key, bindings: &Bindings) -> Option<bool> {
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

/// The columns before a label. They contain a mark if the entry is selected.
const MARK: &str = "> ";
/// The minimum number of columns between a label and its value.
const GAP: usize = 2;

impl<C> Default for Menu<C> {
    fn default() -> Self {
        let (title, text, entries) = (String::new(), Vec::new(), Vec::new());
        Self { title, text, keeps_text: false, entries, selected: 0, first: 0, page: 0 }
    }
}

impl<C: Copy> Menu<C> {
    /// A menu without entries.
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), ..Self::default() }
    }

    /// Adds a line of text above the entries.
    pub fn line(mut self, text: impl Into<String>) -> Self {
        self.text.push(text.into());
        self
    }

    /// Adds lines of text above the entries.
    pub fn lines(self, lines: impl IntoIterator<Item = impl Into<String>>) -> Self {
        lines.into_iter().fold(self, Self::line)
    }

    /// Keeps the text above a list that is higher than the window, in up to half of its height.
    #[must_use]
    pub(crate) fn keeping_text(self) -> Self {
        Self { keeps_text: true, ..self }
    }

    /// Adds an entry.
    pub fn entry(self, label: impl Into<String>, choice: C) -> Self {
        self.entry_with(label, "", choice)
    }

    /// Adds an entry with a value at the right.
    pub fn entry_with(
        mut self,
        label: impl Into<String>,
        value: impl Into<String>,
        choice: C,
    ) -> Self {
        self.entries.push(MenuEntry { label: label.into(), value: value.into(), choice });
        self
    }

    /// Adds entries from tuples of label, value and choice.
    pub fn entries<L: Into<String>, V: Into<String>>(
        self,
        entries: impl IntoIterator<Item = (L, V, C)>,
    ) -> Self {
        entries
            .into_iter()
            .fold(self, |menu, (label, value, choice)| menu.entry_with(label, value, choice))
    }

    /// Selects the entry with index `index`, or the last one if there are fewer.
    pub fn selecting(mut self, index: usize) -> Self {
        self.selected = index.min(self.entries.len().saturating_sub(1));
        self
    }

    /// Takes the lines of text, so that the menu shows only its entries.
    pub fn take_text(&mut self) -> Vec<String> {
        std::mem::take(&mut self.text)
    }

    /// The title and the lines of text, without blank ones.
    pub(crate) fn heading(&self) -> impl Iterator<Item = &str> {
        let lines = [&self.title].into_iter().chain(&self.text).map(|line| line.trim());
        lines.filter(|line| !line.is_empty())
    }

    /// The entries, each with its label and its value.
    pub(crate) fn lines_of_entries(&self) -> impl Iterator<Item = String> {
        self.entries.iter().map(|MenuEntry { label, value, .. }| match value.as_str() {
            "" => label.clone(),
            value => format!("{label}, {value}"),
        })
    }

    /// Selects the entry with index `index`.
    pub(crate) fn select(&mut self, index: usize) {
        self.selected = index.min(self.entries.len().saturating_sub(1));
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

    /// Selects the next or the previous entry, if there is one.
    fn select_neighbour(&mut self, forward: bool) {
        let last = self.entries.len().saturating_sub(1);
        let selected = self.selected;
        self.selected = if forward { (selected + 1).min(last) } else { selected.saturating_sub(1) };
    }

    /// The index of the entry that `key` chooses: the selected entry, or for a digit the entry with
    /// that number, counted from 1.
    fn chosen_by(&self, key: Key) -> Option<usize> {
        match key {
            Key::Enter | Key::Char(' ') => Some(self.selected),
            Key::Char(digit) => {
                let index = digit.to_digit(10)?.checked_sub(1)? as usize;
                (index < self.entries.len()).then_some(index)
            }
            _ => None,
        }
    }

    /// The index of the entry that `key` selects, if `key` is a walking key or a list key that
    /// every terminal has. The first entry follows the last one.
    fn selected_by(&self, key: Key, bindings: &Bindings) -> Option<usize> {
        let (count, page) = (self.entries.len().max(1), self.page.max(1));
        let (previous, next) = ((self.selected + count - 1) % count, (self.selected + 1) % count);
        Some(match key {
            Key::Up => previous,
            Key::Down => next,
            Key::PageUp => self.selected.saturating_sub(page),
            Key::PageDown => (self.selected + page).min(count - 1),
            Key::Home => 0,
            Key::End => count - 1,
            _ => match bindings.action(key)? {
                Action::Want(Intent::Forward) => previous,
                Action::Want(Intent::Back) => next,
                _ => return None,
            },
        })
    }

    /// Draws the menu in the middle of `room`.
    pub fn draw(&mut self, canvas: &mut impl Canvas, room: Rect) {
        let (title, text) = self.shown(room.as_size(), 0);
        message(canvas, room, &title, text);
    }

    /// Draws the menu in the upper left corner of `room`, at least `least` columns wide.
    pub fn draw_in_corner(&mut self, canvas: &mut impl Canvas, room: Rect, least: u16) {
        let (title, text) = self.shown(room.as_size(), least);
        let [width, height] = panel_size(&title, &text);
        let (width, height) = (width.max(least).min(room.width), height.min(room.height));
        panel(canvas, Rect { width, height, ..room }, &title, text);
    }

    /// The title and the text of a panel that is at least `least` columns wide and fits into `room`.
    fn shown(&mut self, room: Size, least: u16) -> (String, Text<'static>) {
        let most_rows = usize::from(room.height.saturating_sub(BORDERS)).max(1);
        let most_columns = usize::from(room.width.saturating_sub(BORDERS + PADDING)).max(1);
        let mut text: Vec<String> =
            self.text.iter().flat_map(|line| wrapped(line, most_columns)).collect();
        let kept = if self.keeps_text { text.len().min(most_rows / 2) } else { 0 };
        self.page = self.entries.len().min(most_rows - kept);
        self.scroll();
        let least_columns = usize::from(least.saturating_sub(BORDERS + PADDING));
        let room_for_text = most_rows - self.page;
        text.truncate(room_for_text);
        let is_separated = !text.is_empty() && text.len() < room_for_text && self.page > 0;
        let shown = &self.entries[self.first..][..self.page];
        let text_width = text.iter().map(|line| line.chars().count()).max().unwrap_or(0);
        let width = shown.iter().map(MenuEntry::width).max().unwrap_or(0).max(text_width);
        let title = self.shown_title();
        let width = width.max(title.chars().count()).max(least_columns).min(most_columns);
        let above = text.into_iter().map(|line| Line::raw(line).centered());
        let entries = (self.first..).zip(shown).map(|(index, entry)| {
            let line = Line::raw(entry.line(index == self.selected, width));
            if index == self.selected { line.style(SELECTED) } else { line }
        });
        let lines: Vec<Line> =
            above.chain(is_separated.then(Line::default)).chain(entries).collect();
        (title, Text::from(lines))
    }

    /// The title, with the number of the selected entry if the list is scrolled.
    fn shown_title(&self) -> String {
        if self.page < self.entries.len() {
            let place = format!("{} {}/{}", self.title, self.selected + 1, self.entries.len());
            place.trim_start().to_owned()
        } else {
            self.title.clone()
        }
    }

    /// Scrolls until the selected entry is visible.
    fn scroll(&mut self) {
        let last = self.entries.len() - self.page;
        let least = (self.selected + 1).saturating_sub(self.page);
        self.first = self.first.clamp(least, self.selected.max(least)).min(last);
    }
}

/// The style of the selected entry.
const SELECTED: Style = Style::new().add_modifier(Modifier::REVERSED);

impl<C> MenuEntry<C> {
    fn width(&self) -> usize {
        let value = Span::raw(&self.value).width();
        MARK.len() + Span::raw(&self.label).width() + if value > 0 { GAP + value } else { 0 }
    }

    /// The text of the entry in `width` columns. The label is cut if the value needs the space.
    fn line(&self, is_selected: bool, width: usize) -> String {
        let mark = if is_selected { MARK } else { "  " };
        let value_width = self.value.chars().count();
        let room = width.saturating_sub(MARK.len() + value_width);
        let gap = usize::from(value_width > 0);
        let label: String = self.label.chars().take(room.saturating_sub(gap)).collect();
        format!("{mark}{label:<room$}{}", self.value)
    }
}

/// The scroll position of the help.
#[derive(Clone, Copy, Debug, Default)]
pub struct HelpScroll {
    /// The index of the first visible line below the fixed first line.
    first: usize,
    /// The number of lines visible in the last drawing, and the total number of lines.
    page: usize,
    lines: usize,
}

/// The number of blank columns between two text columns.
const COLUMN_GAP: usize = 3;

impl HelpScroll {
    /// Scrolls if `key` is a scrolling key. Returns whether it is.
    pub fn scroll(&mut self, key: Key) -> bool {
        let page = self.page.max(1);
        let wanted = match key {
            Key::Up => self.first.saturating_sub(1),
            Key::Down => self.first + 1,
            Key::PageUp => self.first.saturating_sub(page),
            Key::PageDown | Key::Char(' ') => self.first + page,
            Key::Home => 0,
            _ => return false,
        };
        self.first = wanted.min(self.last());
        true
    }

    /// The largest scroll position.
    fn last(&self) -> usize {
        self.lines.saturating_sub(self.page)
    }

    /// Draws the help: sentences about `further` keys, then the keys of the bindings, then `notes`
    /// about the terminal.
    pub fn draw(
        &mut self,
        canvas: &mut impl Canvas,
        picture: Rect,
        (further, bindings): (&[String], &Bindings),
        notes: impl Iterator<Item = String>,
    ) {
        let room = usize::from(picture.height.saturating_sub(BORDERS)).max(1);
        let most_columns = usize::from(picture.width.saturating_sub(BORDERS + PADDING)).max(1);
        let leave = how_to_leave(bindings, most_columns);
        let further: Vec<String> =
            further.iter().flat_map(|keys| wrapped(keys, most_columns)).collect();
        let notes: Vec<String> = notes.flat_map(|note| wrapped(&note, most_columns)).collect();
        let room_for_keys = room.saturating_sub(1 + further.len() + notes.len());
        let keys = keys_in_columns(bindings, room_for_keys, most_columns);
        let body: Vec<String> = further.into_iter().chain(keys).chain(notes).collect();
        self.lines = body.len();
        let fits = body.len() < room;
        // The line that says how to scroll takes up one line.
        self.page = if fits { body.len() } else { room.saturating_sub(2).max(1) };
        self.first = self.first.min(self.last());
        let shown = body.iter().skip(self.first).take(self.page).cloned();
        let more = (!fits).then(|| {
            let last = (self.first + self.page).min(self.lines);
            let long = format!("{}-{last} of {}: up down", self.first + 1, self.lines);
            if long.len() <= most_columns { long } else { format!("{last}/{} up down", self.lines) }
        });
        let lines: Vec<Line> =
            [leave].into_iter().chain(shown).chain(more).map(Line::from).collect();
        message(canvas, picture, "keys", Text::from(lines));
    }
}

/// The line that says how to close the help and, if there is space, how to leave the game.
fn how_to_leave(bindings: &Bindings, most_columns: usize) -> String {
    let first = |action| bindings.keys(action).next().map(|key| key.to_string());
    let close = first(Action::ToggleHelp).unwrap_or_else(|| Key::Escape.to_string());
    let leave = first(Action::Leave).map(|leave| format!("{close} closes; {leave} leaves"));
    leave
        .filter(|text| text.chars().count() <= most_columns)
        .unwrap_or_else(|| format!("{close} closes"))
}

/// Groups of actions that share a line. The line stands in the place of the first action.
const TOGETHER: [(&[Action], &str); 5] = [
    (&[Action::Want(Intent::StrafeLeft), Action::Want(Intent::StrafeRight)], "strafe"),
    (&[Action::Want(Intent::FineLeft), Action::Want(Intent::FineRight)], "turn by 5°"),
    (
        &[Action::ChangeMap(MapChange::Larger), Action::ChangeMap(MapChange::Smaller)],
        "scale the map",
    ),
    (
        &[
            Action::ChangeMap(MapChange::North),
            Action::ChangeMap(MapChange::South),
            Action::ChangeMap(MapChange::West),
            Action::ChangeMap(MapChange::East),
        ],
        "move the map",
    ),
    (&[Action::WidenView, Action::NarrowView], "widen, narrow"),
];

/// The keys and a short description of all actions that have one, in the order of [`Action::ALL`].
fn described(bindings: &Bindings) -> Vec<(String, &'static str)> {
    let line = |(_, does, action, _): (_, &'static str, Action, _)| {
        let Some((actions, does)) = TOGETHER.iter().find(|group| group.0.contains(&action)) else {
            return Some((bindings.key_names(action), does));
        };
        let is_first = actions.first() == Some(&action);
        let keys = actions.iter().map(|&action| bindings.key_names(action));
        is_first.then(|| (keys.collect::<Vec<_>>().join(" ").trim().to_owned(), *does))
    };
    Action::ALL.into_iter().filter_map(line).filter(|(keys, _)| !keys.is_empty()).collect()
}

/// The lines with keys and descriptions, in as many columns as needed to fit into `room` lines, up
/// to the number that fits into `most_columns`. If not even one column fits, lines are wrapped.
fn keys_in_columns(bindings: &Bindings, room: usize, most_columns: usize) -> Vec<String> {
    let lines = described(bindings);
    let padded: Vec<String> =
        lines.iter().map(|(keys, does)| format!("{keys:<10}  {does}")).collect();
    let widest = padded.iter().map(|line| line.chars().count()).max().unwrap_or_default();
    if widest > most_columns {
        let lines = lines.iter();
        return lines
            .flat_map(|(keys, does)| wrapped(&format!("{keys}: {does}"), most_columns))
            .collect();
    }
    let width = widest + COLUMN_GAP;
    let columns =
        padded.len().div_ceil(room.max(1)).clamp(1, ((most_columns + COLUMN_GAP) / width).max(1));
    let height = padded.len().div_ceil(columns);
    (0..height)
        .map(|row| padded[row..].iter().step_by(height).map(|line| format!("{line:<width$}")))
        .map(|cells| cells.collect::<Vec<_>>().concat().trim_end().to_owned())
        .collect()
}

/// The smallest playable window.
const MIN_COLUMNS: u16 = 20;
const MIN_ROWS: u16 = 6;
/// The smallest picture with room for a minimap.
const MIN_SIZE_WITH_MINIMAP: (u16, u16) = (36, 12);
/// The columns that a narrow minimap has at least.
const MIN_MINIMAP_COLUMNS: u16 = 13;
/// The largest minimap. A larger one would hide too much of the picture.
const MAX_MINIMAP_SIZE: (u16, u16) = (40, 20);
/// The number of columns or rows that the borders of a panel take.
pub(crate) const BORDERS: u16 = 2;
/// The number of blank columns beside a message, both sides together.
pub(crate) const PADDING: u16 = 2;

/// Returns true if `area` is too small to play in.
pub fn is_too_small(area: Rect) -> bool {
    area.width < MIN_COLUMNS || area.height < MIN_ROWS
}

/// Draws the message that the window is too small.
pub fn too_small(canvas: &mut impl Canvas) {
    let text = format!("Too small to play: {MIN_COLUMNS}×{MIN_ROWS} at least.");
    canvas.draw_widget(Paragraph::new(text).wrap(Wrap { trim: true }), canvas.bounds());
}

/// The areas of the picture and the status line.
pub fn picture_and_status(area: Rect) -> [Rect; 2] {
    let picture = Rect { height: area.height.saturating_sub(1), ..area };
    let status = Rect { y: picture.bottom(), height: area.height - picture.height, ..area };
    [picture, status]
}

/// The area of the panel of `map` in the upper right corner of the picture; `None` if there is no
/// room for it. A narrow panel takes a fifth of the picture's width, or as much as a map needs to be
/// of use.
pub(crate) fn minimap(picture: Rect, map: &Minimap, is_narrow: bool) -> Option<Rect> {
    let (least_columns, least_rows) = MIN_SIZE_WITH_MINIMAP;
    if picture.width < least_columns || picture.height < least_rows {
        return None;
    }
    let width = picture.width / 3;
    let narrow = (picture.width / 5).saturating_sub(BORDERS).max(MIN_MINIMAP_COLUMNS);
    let room = Size {
        width: if is_narrow { narrow.min(width) } else { width }.min(MAX_MINIMAP_SIZE.0),
        height: (picture.height / 2 - BORDERS).min(MAX_MINIMAP_SIZE.1),
    };
    let size = map.size_within(room);
    let (width, height) = (size.width + BORDERS, size.height + BORDERS);
    Some(Rect { x: picture.right() - width, y: picture.y, width, height })
}

/// Draws the border of a panel with a title, and returns the area inside.
///
/// Rejected: a ratatui block. In each frame it would clear the inside, which a minimap fills
/// anyway, and allocate a list for its titles.
pub fn framed(canvas: &mut impl Canvas, area: Rect, title: &str) -> Rect {
    let inside = Block::bordered().inner(area);
    if area.width < BORDERS || area.height < BORDERS {
        return inside;
    }
    let (right, bottom) = (area.right() - 1, area.bottom() - 1);
    let mut draw = |x, y, character| canvas.draw_character(x, y, character, [Color::Reset; 2]);
    for y in area.top() + 1..bottom {
        draw(area.x, y, '│');
        draw(right, y, '│');
    }
    for (y, [first, last]) in [(area.y, ['┌', '┐']), (bottom, ['└', '┘'])] {
        draw(area.x, y, first);
        (area.x + 1..right).for_each(|x| draw(x, y, '─'));
        draw(right, y, last);
    }
    let title = Span::raw(title);
    let width = (title.width() as u16).min(right - area.x - 1);
    canvas.draw_widget(title, Rect { x: area.x + 1, width, height: 1, ..area });
    inside
}

/// Draws the question whether to leave; `effect` says what leaving does.
pub fn leaving(canvas: &mut impl Canvas, picture: Rect, bindings: &Bindings, effect: &str) {
    let leave = bindings.keys(Action::Leave).find(|&key| key != Key::Escape);
    let keys = leave.map_or_else(String::new, |key| format!("{key} or "));
    let text = format!("{keys}Enter {effect}\nany other key cancels");
    message(canvas, picture, "leave?", Text::from(text).centered());
}

/// Draws a panel in the middle of the picture, as large as `text` needs and the picture allows.
pub fn message(canvas: &mut impl Canvas, picture: Rect, title: &str, text: Text) {
    let [width, height] = panel_size(title, &text).map(Constraint::Length);
    let [area] = Layout::horizontal([width]).flex(Flex::Center).areas(picture);
    let [area] = Layout::vertical([height]).flex(Flex::Center).areas(area);
    panel(canvas, area, title, text);
}

/// The width and the height that a panel needs.
fn panel_size(title: &str, text: &Text) -> [u16; 2] {
    let widest = text.width().max(Span::raw(title).width()) as u16;
    [widest.saturating_add(BORDERS + PADDING), (text.height() as u16).saturating_add(BORDERS)]
}

/// Draws a panel with a text.
pub fn panel(canvas: &mut impl Canvas, area: Rect, title: &str, text: Text) {
    let inside = framed(canvas, area, title);
    let padded = Block::new().padding(Padding::horizontal(PADDING / 2));
    canvas.draw_widget(Paragraph::new(text).block(padded), inside);
}

/// Wraps `text` into lines of up to `width` characters. Lines break between words, and inside a
/// word only if it is longer than a line.
pub fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    let mut room = width;
    for word in text.split_whitespace() {
        let length = word.chars().count();
        if room < width {
            if length < room {
                lines[..].last_mut().into_iter().for_each(|line| line.push(' '));
                room -= 1;
            } else {
                lines.push(String::new());
                room = width;
            }
        }
        for character in word.chars() {
            if room == 0 {
                lines.push(String::new());
                room = width;
            }
            lines[..].last_mut().into_iter().for_each(|line| line.push(character));
            room -= 1;
        }
    }
    lines
}

#[cfg(test)]
mod tests;
