//! The encoder as ratatui's backend.

use std::io::{self, Write};

use crossterm::cursor::{Hide, Show};
use crossterm::terminal::{self, Clear};
use ratatui::backend::{Backend, ClearType, WindowSize};
use ratatui::buffer::Cell;
use ratatui::layout::{Position, Size};

use super::CellWriter;
use super::style::Style;

impl<W: Write> Backend for CellWriter<W> {
    type Error = io::Error;

    fn draw<'a, I>(&mut self, content: I) -> io::Result<()>
    where
        I: Iterator<Item = (u16, u16, &'a Cell)>,
    {
        for (x, y, cell) in content {
            self.screen.want(x, y, cell);
        }
        self.pen.quantize(&mut self.screen);
        self.update();
        Ok(())
    }

    fn hide_cursor(&mut self) -> io::Result<()> {
        if self.cursor_visible {
            self.pen.command(Hide);
            self.cursor_visible = false;
        }
        Ok(())
    }

    fn show_cursor(&mut self) -> io::Result<()> {
        if !self.cursor_visible {
            self.pen.command(Show);
            self.cursor_visible = true;
        }
        Ok(())
    }

    /// The position of the next character, as far as it is known without a query to the terminal.
    fn get_cursor_position(&mut self) -> io::Result<Position> {
        Ok(self.pen.position().unwrap_or(Position::ORIGIN))
    }

    fn set_cursor_position<P: Into<Position>>(&mut self, position: P) -> io::Result<()> {
        self.pen.move_to(position.into());
        Ok(())
    }

    fn clear(&mut self) -> io::Result<()> {
        self.clear_region(ClearType::All)
    }

    fn clear_region(&mut self, region: ClearType) -> io::Result<()> {
        self.pen.set_style(Style::RESET);
        let cursor = match region {
            ClearType::All => Position::ORIGIN,
            _ => self.pen.settle(),
        };
        self.screen.clear(region, cursor);
        let region = match region {
            ClearType::All => terminal::ClearType::All,
            ClearType::AfterCursor => terminal::ClearType::FromCursorDown,
            ClearType::BeforeCursor => terminal::ClearType::FromCursorUp,
            ClearType::CurrentLine => terminal::ClearType::CurrentLine,
            ClearType::UntilNewLine => terminal::ClearType::UntilNewLine,
        };
        self.pen.command(Clear(region));
        Ok(())
    }

    fn size(&self) -> io::Result<Size> {
        Ok(self.size)
    }

    fn window_size(&mut self) -> io::Result<WindowSize> {
        Ok(WindowSize { columns_rows: self.size, pixels: Size::ZERO })
    }

    /// Writes the frame, unless it is empty.
    fn flush(&mut self) -> io::Result<()> {
        let Some(frame) = self.pen.finish_frame() else { return Ok(()) };
        let written = self.output.write_all(frame).and_then(|()| self.output.flush());
        match written {
            Ok(()) => self.bytes_written += frame.len() as u64,
            Err(_) => self.forget(),
        }
        self.pen.clear();
        written
    }
}
