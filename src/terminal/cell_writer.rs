//! Cells to bytes: ratatui's changed cells, as the control sequences that draw them.
//!
//! The bytes of a frame are collected and written with one `write`, between the marks of
//! synchronized output; a frame that changes nothing writes nothing. What the terminal has been
//! told is carried from frame to frame, so only the colour that differs is sent, and the cursor is
//! moved only where it does not already stand. Ratatui's own backends send both colours when one
//! differs, and 25 bytes for a frame without a change.

mod control;
mod look;
mod style;

use std::io::{self, Write};

use crossterm::cursor::{Hide, Show};
use crossterm::queue;
use crossterm::terminal::{self, BeginSynchronizedUpdate, Clear, EndSynchronizedUpdate};
use ratatui::backend::{Backend, ClearType, WindowSize};
use ratatui::buffer::{Cell, CellWidth};
use ratatui::layout::{Position, Size};

use self::control::ControlSequence;
pub(crate) use self::style::Style;

/// A ratatui backend that writes to `W`.
///
/// The colours and the modifiers bold, dim, italic, underlined and reversed are written; ratatui's
/// other modifiers are left out. A control character in a cell is written as a space.
#[derive(Debug)]
pub struct CellWriter<W> {
    output: W,
    size: Size,
    /// What is to be written; it begins with the mark of synchronized output.
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

    /// The frame, begun if it was not.
    fn frame(&mut self) -> io::Result<&mut Vec<u8>> {
        if self.frame.is_empty() {
            queue!(self.frame, BeginSynchronizedUpdate)?;
        }
        Ok(&mut self.frame)
    }

    fn move_to(&mut self, target: Position) -> io::Result<()> {
        if self.position == Some(target) {
            return Ok(());
        }
        let position = self.position;
        let mut motion = ControlSequence::begin(self.frame()?);
        match position {
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
        Ok(())
    }

    fn set_style(&mut self, target: Style) -> io::Result<()> {
        if self.style != Some(target) {
            target.write_from(self.style, self.frame()?);
            self.style = Some(target);
        }
        Ok(())
    }

    fn write_symbol(&mut self, at: Position, symbol: &str) -> io::Result<()> {
        let symbol = if symbol.chars().any(char::is_control) { " " } else { symbol };
        self.frame()?.extend_from_slice(symbol.as_bytes());
        self.position = Some(Position { x: at.x.saturating_add(1), ..at })
            .filter(|next| next.x < self.size.width && advances_by_one(symbol));
        Ok(())
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
            self.move_to(position)?;
            let (symbol, style) = look::cheapest(cell, self.style);
            self.set_style(style)?;
            self.write_symbol(position, symbol)?;
        }
        Ok(())
    }

    fn hide_cursor(&mut self) -> io::Result<()> {
        if self.cursor_visible {
            queue!(self.frame()?, Hide)?;
            self.cursor_visible = false;
        }
        Ok(())
    }

    fn show_cursor(&mut self) -> io::Result<()> {
        if !self.cursor_visible {
            queue!(self.frame()?, Show)?;
            self.cursor_visible = true;
        }
        Ok(())
    }

    /// Where the next character would go, as far as it is known without asking the terminal.
    fn get_cursor_position(&mut self) -> io::Result<Position> {
        Ok(self.position.unwrap_or(Position::ORIGIN))
    }

    fn set_cursor_position<P: Into<Position>>(&mut self, position: P) -> io::Result<()> {
        self.move_to(position.into())
    }

    fn clear(&mut self) -> io::Result<()> {
        self.clear_region(ClearType::All)
    }

    fn clear_region(&mut self, region: ClearType) -> io::Result<()> {
        self.set_style(Style::RESET)?;
        let region = match region {
            ClearType::All => terminal::ClearType::All,
            ClearType::AfterCursor => terminal::ClearType::FromCursorDown,
            ClearType::BeforeCursor => terminal::ClearType::FromCursorUp,
            ClearType::CurrentLine => terminal::ClearType::CurrentLine,
            ClearType::UntilNewLine => terminal::ClearType::UntilNewLine,
        };
        queue!(self.frame()?, Clear(region))
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
        queue!(self.frame, EndSynchronizedUpdate)?;
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
