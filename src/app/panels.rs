//! Panels on the picture: frames, messages, and lines wrapped to fit.

use ratatui::layout::{Constraint, Flex, Layout, Rect, Size};
use ratatui::style::Color;
use ratatui::text::{Span, Text};
use ratatui::widgets::{Block, Padding, Paragraph, Wrap};

use crate::app::bindings::{Action, Bindings};
use crate::terminal::Key;
use crate::tui::Minimap;
use crate::tui::canvas::Canvas;

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
    let inside = framed(canvas, area, title);
    let padded = Block::new().padding(Padding::horizontal(PADDING / 2));
    canvas.draw_widget(Paragraph::new(text).block(padded), inside);
}

pub(crate) fn key_names(bindings: &Bindings, action: Action) -> String {
    let names: Vec<String> = bindings.keys(action).map(|key| key.to_string()).collect();
    names.join(" ")
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
mod tests {
    use super::*;

    #[test]
    fn lines_are_filled_to_the_width() {
        for (text, width, lines) in [
            ("", 5, &[""][..]),
            ("one two three", 7, &["one two", "three"]),
            ("one two three", 13, &["one two three"]),
            ("abcdefgh i", 3, &["abc", "def", "gh", "i"]),
            ("ä ö", 1, &["ä", "ö"]),
        ] {
            assert_eq!(wrapped(text, width), lines, "{text} in {width}");
        }
    }
}
