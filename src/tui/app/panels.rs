//! What shows on the picture and around it: the minimap's frame, and messages.

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Flex, Layout, Margin, Rect, Size};
use ratatui::text::{Line, Span, Text};
use ratatui::widgets::{Block, Borders, Padding, Paragraph, Widget, Wrap};

use crate::terminal::Key;
use crate::tui::bindings::{Action, Bindings};
use crate::tui::{Canvas, Minimap};

/// The least that can be played in.
const LEAST_COLUMNS: u16 = 20;
const LEAST_ROWS: u16 = 6;
/// The least picture that leaves room for a minimap.
const LEAST_WITH_MINIMAP: (u16, u16) = (36, 12);
/// The largest minimap: more would hide too much of the picture.
const LARGEST_MINIMAP: (u16, u16) = (40, 20);
/// What the borders of a panel take of its width and height.
const BORDERS: u16 = 2;
/// What a message leaves blank to its left and right.
const PADDING: u16 = 2;

/// Whether `area` is too small to play in.
pub(super) fn is_too_small(area: Rect) -> bool {
    area.width < LEAST_COLUMNS || area.height < LEAST_ROWS
}

/// Says so.
pub(super) fn too_small(canvas: &mut impl Canvas) {
    let text = format!("Too small to play: {LEAST_COLUMNS}×{LEAST_ROWS} at least.");
    canvas.draw_widget(Paragraph::new(text).wrap(Wrap { trim: true }), canvas.bounds());
}

/// Where the picture and the status line go.
pub(super) fn picture_and_status(area: Rect) -> [Rect; 2] {
    let picture = Rect { height: area.height.saturating_sub(1), ..area };
    let status = Rect { y: picture.bottom(), height: area.height - picture.height, ..area };
    [picture, status]
}

/// Where the panel of `map` goes, in the upper right corner of the picture, if there is room for it.
pub(super) fn minimap(picture: Rect, map: &Minimap) -> Option<Rect> {
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

/// Draws the border of a panel, with a title, and tells where its inside is.
///
/// It goes side by side: what is inside a minimap would be blanked for nothing.
pub(super) fn framed(canvas: &mut impl Canvas, area: Rect, title: &str) -> Rect {
    let inside = Block::bordered().inner(area);
    let row = |y| Rect { y, height: area.height.min(1), ..area };
    let column = |x| Rect { x, width: area.width.min(1), ..inside };
    for (sides, area) in [
        (Borders::LEFT, column(area.left())),
        (Borders::RIGHT, column(area.right().saturating_sub(1))),
        (Borders::BOTTOM | Borders::LEFT | Borders::RIGHT, row(area.bottom().saturating_sub(1))),
    ] {
        canvas.draw_widget(Block::new().borders(sides), area);
    }
    canvas.draw_widget(Lid { title }, row(area.top()));
    inside
}

/// The upper side of a panel, with a title. A block of ratatui's keeps its title in a list, which is too
/// much for what is drawn with each frame.
struct Lid<'a> {
    title: &'a str,
}

impl Widget for Lid<'_> {
    fn render(self, area: Rect, buffer: &mut Buffer) {
        Block::new().borders(Borders::TOP | Borders::LEFT | Borders::RIGHT).render(area, buffer);
        Span::raw(self.title).render(area.inner(Margin::new(1, 0)), buffer);
    }
}

/// That the game waits.
pub(super) fn paused(canvas: &mut impl Canvas, picture: Rect, bindings: &Bindings) {
    let keys = key_names(bindings, Action::TogglePause);
    message(canvas, picture, "paused", Text::from(format!("{keys} goes on")).centered());
}

/// Which key does what: in as many columns as it takes, or as much as there is room for.
pub(super) fn help(canvas: &mut impl Canvas, picture: Rect, bindings: &Bindings) {
    const GAP: usize = 3;
    let lines: Vec<String> = Action::ALL
        .into_iter()
        .map(|(_, does, action)| format!("{:<10}  {does}", key_names(bindings, action)))
        .collect();
    let width = lines.iter().map(|line| line.chars().count()).max().unwrap_or_default() + GAP;
    let room = usize::from(picture.height.saturating_sub(BORDERS)).max(1);
    let most_columns = usize::from(picture.width.saturating_sub(BORDERS + PADDING)) + GAP;
    let columns = lines.len().div_ceil(room).clamp(1, (most_columns / width).max(1));
    let height = lines.len().div_ceil(columns);
    let mut rows: Vec<String> = (0..height)
        .map(|row| lines[row..].iter().step_by(height).map(|line| format!("{line:<width$}")))
        .map(|cells| cells.collect::<Vec<_>>().concat().trim_end().to_owned())
        .collect();
    if height > room {
        rows.truncate(room - 1);
        rows.push("more in a larger window".to_owned());
    }
    message(canvas, picture, "keys", rows.into_iter().map(Line::from).collect());
}

/// Whether the player wants to leave.
pub(super) fn leaving(canvas: &mut impl Canvas, picture: Rect, bindings: &Bindings) {
    let leave = bindings.keys(Action::Leave).find(|&key| key != Key::Escape);
    let keys = leave.map_or_else(String::new, |key| format!("{key} or "));
    let text = format!("{keys}Enter leaves\nany other key goes on");
    message(canvas, picture, "leave?", Text::from(text).centered());
}

/// That the exit was reached, and how soon.
pub(super) fn level_done(canvas: &mut impl Canvas, picture: Rect, title: &str, seconds: f64) {
    let text = format!("{title}\nin {}\nEnter goes on", time(seconds));
    message(canvas, picture, "you found the way out", Text::from(text).centered());
}

/// That there are no more levels, and how soon the player got through them.
pub(super) fn end(canvas: &mut impl Canvas, picture: Rect, seconds: f64) {
    let text = format!("all levels\nin {}\nEnter leaves", time(seconds));
    message(canvas, picture, "the end", Text::from(text).centered());
}

/// A panel in the middle of the picture, as large as `text` needs.
fn message(canvas: &mut impl Canvas, picture: Rect, title: &str, text: Text) {
    let widest = text.width().max(title.len()) as u16;
    let width = Constraint::Length(widest.saturating_add(BORDERS + PADDING));
    let height = Constraint::Length((text.height() as u16).saturating_add(BORDERS));
    let [area] = Layout::horizontal([width]).flex(Flex::Center).areas(picture);
    let [area] = Layout::vertical([height]).flex(Flex::Center).areas(area);
    let inside = framed(canvas, area, title);
    let padded = Block::new().padding(Padding::horizontal(PADDING / 2));
    canvas.draw_widget(Paragraph::new(text).block(padded), inside);
}

fn key_names(bindings: &Bindings, action: Action) -> String {
    let names: Vec<String> = bindings.keys(action).map(|key| key.to_string()).collect();
    names.join(" ")
}

/// Minutes, seconds and tenths.
fn time(seconds: f64) -> String {
    let tenths = (seconds * 10.0) as u64;
    format!("{}:{:02}.{}", tenths / 600, tenths / 10 % 60, tenths % 10)
}

#[cfg(test)]
mod tests {
    use ratatui::buffer::{Buffer, Cell};

    use super::*;

    fn shown(columns: u16, rows: u16, draw: impl FnOnce(&mut Buffer)) -> String {
        let mut buffer = Buffer::empty(Rect::new(0, 0, columns, rows));
        draw(&mut buffer);
        let lines = buffer.content().chunks(columns.into());
        lines.flat_map(|line| line.iter().map(Cell::symbol).chain(["\n"])).collect()
    }

    #[test]
    fn help_is_whole_or_says_that_there_is_more() {
        let bindings = Bindings::default();
        for (columns, rows, is_whole) in
            [(32, 30, true), (70, 16, true), (200, 60, true), (60, 9, false), (20, 5, false)]
        {
            let text = shown(columns, rows, |canvas| help(canvas, canvas.bounds(), &bindings));
            let is_so = Action::ALL.iter().all(|(_, does, _)| text.contains(does));
            assert_eq!(is_so, is_whole, "{columns} by {rows}:\n{text}");
            assert_eq!(text.contains("more in a"), !is_whole, "{columns} by {rows}:\n{text}");
        }
    }

    #[test]
    fn times_are_minutes_seconds_and_tenths() {
        assert_eq!(time(0.0), "0:00.0");
        assert_eq!(time(61.26), "1:01.2");
        assert_eq!(time(3600.0), "60:00.0");
    }
}
