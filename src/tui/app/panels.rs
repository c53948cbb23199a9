//! What shows besides the picture: the status line, the minimap's frame, and messages.

use ratatui::Frame;
use ratatui::layout::{Constraint, Flex, Layout, Rect, Size};
use ratatui::style::{Modifier, Style};
use ratatui::text::{Line, Text};
use ratatui::widgets::{Block, Clear, Paragraph, Wrap};

use crate::tui::Minimap;
use crate::tui::bindings::{Action, Bindings};
use crate::world::World;

/// The least that can be played in.
const LEAST_COLUMNS: u16 = 20;
const LEAST_ROWS: u16 = 6;
/// The least picture that leaves room for a minimap.
const LEAST_WITH_MINIMAP: (u16, u16) = (36, 12);
/// The largest minimap: more would hide too much of the picture.
const LARGEST_MINIMAP: (u16, u16) = (40, 20);
/// What the borders of a panel take of its width and height.
const BORDERS: u16 = 2;

/// Whether `area` is too small to play in.
pub(super) fn is_too_small(area: Rect) -> bool {
    area.width < LEAST_COLUMNS || area.height < LEAST_ROWS
}

/// Says so.
pub(super) fn too_small(frame: &mut Frame) {
    let text = format!("Too small to play: {LEAST_COLUMNS}×{LEAST_ROWS} at least.");
    frame.render_widget(Paragraph::new(text).wrap(Wrap { trim: true }), frame.area());
}

/// Where the picture and the status line go.
pub(super) fn picture_and_status(area: Rect) -> [Rect; 2] {
    Layout::vertical([Constraint::Fill(1), Constraint::Length(1)]).areas(area)
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

/// Draws an empty panel with a border and a title, and tells where its inside is.
pub(super) fn framed(frame: &mut Frame, area: Rect, title: &str) -> Rect {
    let block = Block::bordered().title(title);
    let inside = block.inner(area);
    frame.render_widget(Clear, area);
    frame.render_widget(block, area);
    inside
}

/// The line below the picture.
pub(super) fn status(
    frame: &mut Frame,
    area: Rect,
    world: &World,
    runs: bool,
    bindings: &Bindings,
) {
    let running = if runs { "  running" } else { "" };
    let left = Line::from(format!(" {}{running}", title(world)));
    let right = Line::from(format!("{} help ", key_names(bindings, Action::ToggleHelp)));
    frame.render_widget(left.style(Style::new().add_modifier(Modifier::REVERSED)), area);
    frame.render_widget(right.right_aligned(), area);
}

/// That the game waits.
pub(super) fn paused(frame: &mut Frame, picture: Rect, bindings: &Bindings) {
    let keys = key_names(bindings, Action::TogglePause);
    message(frame, picture, "paused", Text::from(format!("{keys} goes on")).centered());
}

/// Which key does what.
pub(super) fn help(frame: &mut Frame, picture: Rect, bindings: &Bindings) {
    let lines = Action::ALL.into_iter().map(|(_, does, action)| {
        Line::from(format!("{:<10}  {does}", key_names(bindings, action)))
    });
    message(frame, picture, "keys", lines.collect());
}

/// That the exit was reached, and how soon.
pub(super) fn level_done(frame: &mut Frame, picture: Rect, world: &World, seconds: f64) {
    let text = format!("{} in {}\n\nEnter goes on", title(world), time(seconds));
    message(frame, picture, "you found the way out", Text::from(text).centered());
}

/// That there are no more levels, and how soon the player got through them.
pub(super) fn end(frame: &mut Frame, picture: Rect, seconds: f64) {
    let text = format!("all levels in {}\n\nEnter leaves", time(seconds));
    message(frame, picture, "the end", Text::from(text).centered());
}

/// A panel in the middle of the picture, as large as `text` needs.
fn message(frame: &mut Frame, picture: Rect, title: &str, text: Text) {
    const PADDING: u16 = 2;
    let widest = text.width().max(title.len()) as u16;
    let width = Constraint::Length(widest.saturating_add(BORDERS + PADDING));
    let height = Constraint::Length((text.height() as u16).saturating_add(BORDERS));
    let [area] = Layout::horizontal([width]).flex(Flex::Center).areas(picture);
    let [area] = Layout::vertical([height]).flex(Flex::Center).areas(area);
    let inside = framed(frame, area, title);
    let [inside] =
        Layout::horizontal([Constraint::Fill(1)]).horizontal_margin(PADDING / 2).areas(inside);
    frame.render_widget(Paragraph::new(text), inside);
}

fn title(world: &World) -> &str {
    if world.title().is_empty() { "a level without a name" } else { world.title() }
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
    use super::*;

    #[test]
    fn times_are_minutes_seconds_and_tenths() {
        assert_eq!(time(0.0), "0:00.0");
        assert_eq!(time(61.26), "1:01.2");
        assert_eq!(time(3600.0), "60:00.0");
    }
}
