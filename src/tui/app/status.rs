//! The line below the picture.
//!
//! It is written anew for each frame, into memory that is kept: nothing has to know when it changes,
//! and nothing is allocated for it.

use std::fmt::{self, Write};

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};
use ratatui::text::Span;
use ratatui::widgets::Widget;

use super::played::Played;
use super::stats::Stats;
use crate::tui::bindings::{Action, Bindings};

/// How the player walks, whatever keys are held.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Gait {
    pub(super) runs: bool,
    pub(super) ducks: bool,
    pub(super) walks_on: bool,
}

/// What the line says: where and how the player is to the left, and how to get help to the right.
#[derive(Clone, Debug, Default)]
pub(super) struct StatusLine {
    left: String,
    right: String,
}

impl StatusLine {
    /// Says how things are.
    pub(super) fn update(
        &mut self,
        game: &Played,
        gait: Gait,
        stats: Option<&Stats>,
        bindings: &Bindings,
    ) {
        self.left.clear();
        self.right.clear();
        // A string takes whatever is written.
        _ = write_left(&mut self.left, game, gait);
        _ = write_right(&mut self.right, stats, bindings);
    }
}

impl Widget for &StatusLine {
    /// What is to the right goes first where there is not room for both.
    fn render(self, area: Rect, buffer: &mut Buffer) {
        let [left, right] = [&self.left, &self.right].map(|text| Span::raw(text.as_str()));
        let width = (right.width() as u16).min(area.width);
        let left_area = Rect { width: area.width - width, ..area };
        let right_area = Rect { x: left_area.right(), width, ..area };
        left.render(left_area, buffer);
        right.render(right_area, buffer);
        buffer.set_style(area, Style::new().add_modifier(Modifier::REVERSED));
    }
}

fn write_left(text: &mut String, game: &Played, gait: Gait) -> fmt::Result {
    write!(text, " {}", game.title())?;
    if let Some(site) = game.site() {
        write!(text, "  {}, {}", site.column, site.row)?;
    }
    if gait.runs {
        text.push_str("  running");
    }
    if gait.ducks {
        text.push_str("  ducking");
    }
    if gait.walks_on {
        text.push_str("  walking on");
    }
    game.keys().try_for_each(|key| write!(text, "  {key} key"))?;
    game.message().map_or(Ok(()), |message| write!(text, "  {message}"))
}

fn write_right(text: &mut String, stats: Option<&Stats>, bindings: &Bindings) -> fmt::Result {
    if let Some(stats) = stats {
        write!(text, "  {stats} ")?;
    }
    for key in bindings.keys(Action::ToggleHelp) {
        write!(text, " {key}")?;
    }
    text.write_str(" help ")
}

#[cfg(test)]
mod tests {
    use ratatui::buffer::Cell;

    use super::*;

    #[test]
    fn help_is_told_of_before_anything_else() {
        let line = StatusLine { left: " a level".to_owned(), right: " ? help ".to_owned() };
        for (columns, shown) in [(20, " a level     ? help "), (12, " a l ? help "), (4, " ? h")] {
            let mut buffer = Buffer::empty(Rect::new(0, 0, columns, 1));
            line.render(buffer.area, &mut buffer);
            assert_eq!(buffer.content().iter().map(Cell::symbol).collect::<String>(), shown);
        }
    }
}
