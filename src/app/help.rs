//! The help: a panel with the keys of all actions. It scrolls if it is higher than the window.
//!
//! The first line says how to close it. Keys that every terminal has scroll it: the arrows, the
//! page keys, and the space bar.

use ratatui::layout::Rect;
use ratatui::text::{Line, Text};

use super::panels::{BORDERS, PADDING, key_names, message, wrapped};
use crate::app::bindings::{Action, Bindings, MapChange};
use crate::game::Intent;
use crate::terminal::Key;
use crate::tui::canvas::Canvas;

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
const GAP: usize = 3;

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
    let line = |(_, does, action): (_, &'static str, Action)| {
        let Some((actions, does)) = TOGETHER.iter().find(|group| group.0.contains(&action)) else {
            return Some((key_names(bindings, action), does));
        };
        let is_first = actions.first() == Some(&action);
        let keys = actions.iter().map(|&action| key_names(bindings, action));
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
    let width = widest + GAP;
    let columns =
        padded.len().div_ceil(room.max(1)).clamp(1, ((most_columns + GAP) / width).max(1));
    let height = padded.len().div_ceil(columns);
    (0..height)
        .map(|row| padded[row..].iter().step_by(height).map(|line| format!("{line:<width$}")))
        .map(|cells| cells.collect::<Vec<_>>().concat().trim_end().to_owned())
        .collect()
}

#[cfg(test)]
mod tests {
    use ratatui::buffer::{Buffer, Cell};

    use super::*;

    fn shown(columns: u16, rows: u16, help: &mut HelpScroll) -> String {
        let mut buffer = Buffer::empty(Rect::new(0, 0, columns, rows));
        let note =
            "256 colours: your terminal did not offer more; see docs/terminals.md".to_owned();
        let notes = [note].into_iter();
        let keys = (&[][..], &Bindings::default());
        help.draw(&mut buffer, Rect::new(0, 0, columns, rows), keys, notes);
        let lines = buffer.content().chunks(columns.into());
        lines.flat_map(|line| line.iter().map(Cell::symbol).chain(["\n"])).collect()
    }

    fn shows_words(seen: &str, line: &str) -> bool {
        line.split_whitespace().all(|word| seen.contains(word))
    }

    #[test]
    fn every_line_can_be_reached_in_any_window() {
        for (columns, rows) in [(80, 23), (32, 24), (64, 13), (200, 60), (60, 9), (20, 5)] {
            let mut help = HelpScroll::default();
            let mut seen = String::new();
            loop {
                let text = shown(columns, rows, &mut help);
                assert!(text.contains("? closes"), "{columns} by {rows}:\n{text}");
                seen.extend(
                    text.chars().filter(|letter| !letter.is_whitespace() && *letter != '│'),
                );
                if help.first >= help.last() {
                    break;
                }
                help.first += help.page;
            }
            // Words longer than a line are broken.
            let most = usize::from(columns - BORDERS - PADDING);
            let shows =
                |text: &str| wrapped(text, most).iter().all(|line| shows_words(&seen, line));
            for (_, does) in described(&Bindings::default()) {
                assert!(shows(does), "{does}, {columns} by {rows}:\n{seen:?}");
            }
            assert!(shows("did not offer more; see docs/terminals.md"), "{columns} by {rows}");
        }
    }

    #[test]
    fn a_help_that_fits_does_not_scroll() {
        let mut help = HelpScroll::default();
        let text = shown(80, 24, &mut help);
        assert_eq!(help.last(), 0, "{text}");
        assert!(!text.contains(" of "), "{text}");
    }
}
