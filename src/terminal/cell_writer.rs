//! Cells to bytes: ratatui's changed cells, as the control sequences that draw them.
//!
//! The bytes of a frame are collected and written with one `write`, between the marks of
//! synchronized output; a frame that changes nothing writes nothing. What the terminal has been
//! told is carried from frame to frame, so only the colour that differs is sent, and the cursor is
//! moved only where it does not already stand. Ratatui's own backends send both colours when one
//! differs, and 25 bytes for a frame without a change.

mod control;
mod style;

use std::io::{self, Write};

use ratatui::backend::{Backend, ClearType, WindowSize};
use ratatui::buffer::{Cell, CellWidth};
use ratatui::layout::{Position, Size};

use self::control::ControlSequence;
pub(crate) use self::style::Style;
use super::sequence;

/// A ratatui backend that writes to `W`.
///
/// The colours and the modifiers bold, dim, italic, underlined and reversed are written; ratatui's
/// other modifiers are left out. A control character in a cell is written as a space.
#[derive(Debug)]
pub struct CellWriter<W> {
    output: W,
    size: Size,
    frame: Vec<u8>,
    style: Option<Style>,
    position: Option<Position>,
    cursor_visible: bool,
    bytes_written: u64,
}

impl<W: Write> CellWriter<W> {
    /// A backend that writes to `output`, a terminal of `size` whose cursor is hidden.
    pub fn new(output: W, size: Size) -> Self {
        Self {
            output,
            size,
            frame: Vec::new(),
            style: None,
            position: None,
            cursor_visible: false,
            bytes_written: 0,
        }
    }

    /// How many bytes have been written so far.
    pub fn bytes_written(&self) -> u64 {
        self.bytes_written
    }

    /// Takes note that the window is now of `size`; ratatui clears it in the next frame.
    pub fn set_size(&mut self, size: Size) {
        self.size = size;
    }

    /// Takes note that others may have written to the terminal: nothing is known but that the
    /// cursor is hidden.
    pub fn forget(&mut self) {
        self.frame.clear();
        self.style = None;
        self.position = None;
        self.cursor_visible = false;
    }

    fn push(&mut self, text: &str) {
        self.frame.extend_from_slice(text.as_bytes());
    }

    fn move_to(&mut self, target: Position) {
        if self.position == Some(target) {
            return;
        }
        let mut motion = ControlSequence::begin(&mut self.frame);
        match self.position {
            Some(position) if position.y == target.y && position.x < target.x => {
                motion.parameter(target.x - position.x);
                motion.end(b'C');
            }
            _ => {
                motion.parameters(
                    [target.y, target.x].map(|zero_based| zero_based.saturating_add(1)),
                );
                motion.end(b'H');
            }
        }
        self.position = Some(target);
    }

    fn set_style(&mut self, target: Style) {
        if self.style != Some(target) {
            target.write_from(self.style, &mut self.frame);
            self.style = Some(target);
        }
    }

    fn write_symbol(&mut self, at: Position, symbol: &str) {
        let symbol = if symbol.chars().any(char::is_control) { " " } else { symbol };
        self.push(symbol);
        self.position = Some(Position { x: at.x.saturating_add(1), ..at })
            .filter(|next| next.x < self.size.width && advances_by_one(symbol));
    }
}

/// Whether every terminal moves its cursor by one cell for `symbol`. They disagree about the rest.
fn advances_by_one(symbol: &str) -> bool {
    symbol.chars().nth(1).is_none() && symbol.cell_width() == 1
}

impl<W: Write> Backend for CellWriter<W> {
    type Error = io::Error;

    fn draw<'a, I>(&mut self, content: I) -> io::Result<()>
    where
        I: Iterator<Item = (u16, u16, &'a Cell)>,
    {
        for (x, y, cell) in content {
            let position = Position { x, y };
            self.move_to(position);
            self.set_style(Style::of(cell));
            self.write_symbol(position, cell.symbol());
        }
        Ok(())
    }

    fn hide_cursor(&mut self) -> io::Result<()> {
        if self.cursor_visible {
            self.push(sequence::HIDE_CURSOR);
            self.cursor_visible = false;
        }
        Ok(())
    }

    fn show_cursor(&mut self) -> io::Result<()> {
        if !self.cursor_visible {
            self.push(sequence::SHOW_CURSOR);
            self.cursor_visible = true;
        }
        Ok(())
    }

    /// Where the next character would go, as far as it is known without asking the terminal.
    fn get_cursor_position(&mut self) -> io::Result<Position> {
        Ok(self.position.unwrap_or(Position::ORIGIN))
    }

    fn set_cursor_position<P: Into<Position>>(&mut self, position: P) -> io::Result<()> {
        self.move_to(position.into());
        Ok(())
    }

    fn clear(&mut self) -> io::Result<()> {
        self.clear_region(ClearType::All)
    }

    fn clear_region(&mut self, region: ClearType) -> io::Result<()> {
        self.set_style(Style::RESET);
        self.push(match region {
            ClearType::All => sequence::CLEAR,
            ClearType::AfterCursor => sequence::CLEAR_AFTER_CURSOR,
            ClearType::BeforeCursor => sequence::CLEAR_BEFORE_CURSOR,
            ClearType::CurrentLine => sequence::CLEAR_LINE,
            ClearType::UntilNewLine => sequence::CLEAR_REST_OF_LINE,
        });
        Ok(())
    }

    fn size(&self) -> io::Result<Size> {
        Ok(self.size)
    }

    fn window_size(&mut self) -> io::Result<WindowSize> {
        Ok(WindowSize { columns_rows: self.size, pixels: Size::ZERO })
    }

    /// Writes the frame, if there is anything in it.
    fn flush(&mut self) -> io::Result<()> {
        if self.frame.is_empty() {
            return Ok(());
        }
        self.frame.splice(..0, sequence::BEGIN_SYNCHRONIZED.bytes());
        self.push(sequence::END_SYNCHRONIZED);
        let written = self.output.write_all(&self.frame).and_then(|()| self.output.flush());
        match written {
            Ok(()) => self.bytes_written += self.frame.len() as u64,
            Err(_) => self.forget(),
        }
        self.frame.clear();
        written
    }
}

#[cfg(test)]
mod tests;
