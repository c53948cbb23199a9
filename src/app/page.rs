//! Pages over the picture: the page shown, the way back from it, the effect of keys on it, and how it is drawn.
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
//!
//! A menu is a panel with text and a list of entries, with one selected. Every panel that asks for a choice is a menu,
//! and the same keys work in all of them: the arrows or the keys to walk select, Enter or Space chooses, a digit
//! chooses the entry with that number, Escape or Backspace goes back. On a result, only Enter and the arrows act, and
//! the selection stops at both ends. A list that is higher than the window scrolls, and the text above it is cut first.
//!
//! The help is a panel with the keys of all actions. Its first line says how to close it. If it is higher than the
//! window, keys that every terminal has scroll it: the arrows, the page keys, and the space bar.

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
        let (page, menu) = self.behind.pop().unwrap_or_else(|| (home, Menu::default()));
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
        let (selected, choice) = (self.menu.selected, self.menu.choice());
        let index = menu.entries.iter().position(|entry| Some(entry.choice) == choice);
        self.menu = menu.selecting(index.filter(|_| selected > 0).unwrap_or(selected));
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
            Kind::Help | Kind::Bare => Effect::Other,
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
            Kind::Menu { .. } | Kind::Result => match self.menu.chosen_by(key) {
                Some(chosen) => {
                    self.menu.selected = chosen;
                    Effect::Choose
                }
                None => Effect::Answer(key),
            },
            Kind::Help | Kind::Bare => Effect::Answer(key),
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
    value: String,
    choice: C,
}

/// Whether `key` changes a value to the next one, or to the one before; `None` if it does neither.
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

/// The columns before a label, with a mark if the entry is selected.
const MARK: &str = "> ";
/// The least number of columns between a label and its value.
const GAP: usize = 2;

impl<C> Default for Menu<C> {
    fn default() -> Self {
        let (title, text, entries) = (String::new(), Vec::new(), Vec::new());
        Self { title, text, entries, selected: 0, first: 0, page: 0 }
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

    /// Adds entries with their labels, values and choices.
    pub fn entries<L: Into<String>, V: Into<String>>(
        self,
        entries: impl IntoIterator<Item = (L, V, C)>,
    ) -> Self {
        entries
            .into_iter()
            .fold(self, |menu, (label, value, choice)| menu.entry_with(label, value, choice))
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

    /// Selects the next entry, or the one before, if there is one.
    fn select_neighbour(&mut self, forward: bool) {
        let last = self.entries.len().saturating_sub(1);
        let selected = self.selected;
        self.selected = if forward { (selected + 1).min(last) } else { selected.saturating_sub(1) };
    }

    /// The index of the entry that `key` chooses: the selected one, or the one with that number, counted from 1.
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

    /// The index of the entry that `key` selects, if it is a key to walk, or a key for lists that every terminal has.
    /// After the last entry comes the first.
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

/// The scroll position of the help.
#[derive(Clone, Copy, Debug, Default)]
pub struct HelpScroll {
    /// The first line shown, below the lines that are always shown.
    first: usize,
    /// The number of lines shown last, and the number of all lines.
    page: usize,
    lines: usize,
}

/// The number of blank columns between two columns of text.
const COLUMN_GAP: usize = 3;

impl HelpScroll {
    /// Scrolls if `key` does that. Returns whether it does.
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

    /// The last scroll position.
    fn last(&self) -> usize {
        self.lines.saturating_sub(self.page)
    }

    /// Draws the help: further keys, in sentences, before the keys of the bindings, and `notes` about the
    /// terminal at the end.
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
        // The line that says how to scroll takes a line.
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

/// The line that says how to close the help and, if it fits, how to leave the game.
fn how_to_leave(bindings: &Bindings, most_columns: usize) -> String {
    let first = |action| bindings.keys(action).next().map(|key| key.to_string());
    let close = first(Action::ToggleHelp).unwrap_or_else(|| Key::Escape.to_string());
    let leave = first(Action::Leave).map(|leave| format!("{close} closes; {leave} leaves"));
    leave
        .filter(|text| text.chars().count() <= most_columns)
        .unwrap_or_else(|| format!("{close} closes"))
}

/// Actions that share a line, which begins with the first of them.
const TOGETHER: [(&[Action], &str); 4] = [
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

/// The keys of all actions with a short description each, in the order of [`Action::ALL`].
fn described(bindings: &Bindings) -> Vec<(String, &'static str)> {
    let line = |(_, does, action, _): (_, &'static str, Action, _)| {
        let Some((actions, does)) = TOGETHER.iter().find(|group| group.0.contains(&action)) else {
            return Some((bindings.key_names(action), does));
        };
        let is_first = actions.first() == Some(&action);
        let keys = actions.iter().map(|&action| bindings.key_names(action));
        is_first.then(|| (keys.collect::<Vec<_>>().join(" ").trim().to_owned(), *does))
    };
    Action::ALL.into_iter().filter_map(line).collect()
}

/// Each line with its keys, in as many columns as are needed to fit into `room` lines and possible
/// in `most_columns`. If not even one column fits, lines are wrapped.
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

/// The smallest window to play in.
const LEAST_COLUMNS: u16 = 20;
const LEAST_ROWS: u16 = 6;
/// The smallest picture with room for a minimap.
const LEAST_WITH_MINIMAP: (u16, u16) = (36, 12);
/// The largest minimap: a larger one would hide too much of the picture.
const LARGEST_MINIMAP: (u16, u16) = (40, 20);
/// The columns or rows that the borders of a panel take.
pub(crate) const BORDERS: u16 = 2;
/// The columns that a message leaves blank at both sides.
pub(crate) const PADDING: u16 = 2;

/// Whether `area` is too small to play in.
pub fn is_too_small(area: Rect) -> bool {
    area.width < LEAST_COLUMNS || area.height < LEAST_ROWS
}

/// Draws the message that the window is too small.
pub fn too_small(canvas: &mut impl Canvas) {
    let text = format!("Too small to play: {LEAST_COLUMNS}×{LEAST_ROWS} at least.");
    canvas.draw_widget(Paragraph::new(text).wrap(Wrap { trim: true }), canvas.bounds());
}

/// The areas of the picture and of the status line.
pub fn picture_and_status(area: Rect) -> [Rect; 2] {
    let picture = Rect { height: area.height.saturating_sub(1), ..area };
    let status = Rect { y: picture.bottom(), height: area.height - picture.height, ..area };
    [picture, status]
}

/// The area of the panel of `map`, in the upper right corner of the picture, if there is room for
/// it.
pub(crate) fn minimap(picture: Rect, map: &Minimap) -> Option<Rect> {
    let (least_columns, least_rows) = LEAST_WITH_MINIMAP;
    if picture.width < least_columns || picture.height < least_rows {
        return None;
    }
    let room = Size {
        width: (picture.width / 3).min(LARGEST_MINIMAP.0),
        height: (picture.height / 2 - BORDERS).min(LARGEST_MINIMAP.1),
    };
    let size = map.size_within(room);
    let (width, height) = (size.width + BORDERS, size.height + BORDERS);
    Some(Rect { x: picture.right() - width, y: picture.y, width, height })
}

/// Draws the border of a panel with a title, and returns the area inside.
///
/// A ratatui block would also clear the inside, which a minimap fills anyway, and allocate a list for
/// its titles, in each frame.
pub(crate) fn framed(canvas: &mut impl Canvas, area: Rect, title: &str) -> Rect {
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

/// Draws the question whether to leave; `effect` is what that does.
pub fn leaving(canvas: &mut impl Canvas, picture: Rect, bindings: &Bindings, effect: &str) {
    let leave = bindings.keys(Action::Leave).find(|&key| key != Key::Escape);
    let keys = leave.map_or_else(String::new, |key| format!("{key} or "));
    let text = format!("{keys}Enter {effect}\nany other key goes on");
    message(canvas, picture, "leave?", Text::from(text).centered());
}

/// Draws a panel in the middle of the picture, as large as `text` needs and the picture has room for.
pub fn message(canvas: &mut impl Canvas, picture: Rect, title: &str, text: Text) {
    let widest = text.width().max(Span::raw(title).width()) as u16;
    let width = Constraint::Length(widest.saturating_add(BORDERS + PADDING));
    let height = Constraint::Length((text.height() as u16).saturating_add(BORDERS));
    let [area] = Layout::horizontal([width]).flex(Flex::Center).areas(picture);
    let [area] = Layout::vertical([height]).flex(Flex::Center).areas(area);
    panel(canvas, area, title, text);
}

/// Draws a panel with a text.
pub(crate) fn panel(canvas: &mut impl Canvas, area: Rect, title: &str, text: Text) {
    let inside = framed(canvas, area, title);
    let padded = Block::new().padding(Padding::horizontal(PADDING / 2));
    canvas.draw_widget(Paragraph::new(text).block(padded), inside);
}

/// Wraps `text` into lines of up to `width` characters, between words, and within words that are
/// longer.
pub(crate) fn wrapped(text: &str, width: usize) -> Vec<String> {
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
