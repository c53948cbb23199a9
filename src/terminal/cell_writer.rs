//! Cells to bytes: ratatui's changed cells, as the control sequences that draw them.
//!
//! The bytes of a frame are collected and written with one `write`, between the marks of
//! synchronized output; a frame that changes nothing writes nothing. What the terminal has been
//! told is carried from frame to frame, so only the colour that differs is sent, and the cursor is
//! moved only where it does not already stand. Ratatui's own backends send both colours when one
//! differs, and 25 bytes for a frame without a change.
//!
//! The writer keeps a model of the screen, cell by cell. A cell that looks as it should is not sent, and a part of
//! a row that moved sideways is moved by the terminal. At a [`Fidelity`] that is not exact, each row is searched
//! for the cheapest way to show it within the tolerance, whatever its cells are made of: half blocks or
//! characters, in true colour or in a palette. A screen that does not change becomes exact in ten frames.

mod ascii;
mod bytes;
mod control;
mod exact;
mod glyph_table;
mod inexact;
mod ink;
mod motion;
mod packed_cell;
mod palette;
mod pen;
mod refinement;
mod screen;
mod shift;
mod style;
mod trellis;

use std::io::{self, Write};

use crossterm::cursor::{Hide, Show};
use crossterm::terminal::{self, Clear};
use ratatui::backend::{Backend, ClearType, WindowSize};
use ratatui::buffer::Cell;
use ratatui::layout::{Position, Size};
use ratatui::style::Color;

#[cfg(feature = "cli")]
pub(crate) use self::bytes::Bytes;
use self::inexact::RowEncoder;
use self::ink::{Notation, Price};
use self::pen::Pen;
use self::refinement::Refinement;
pub use self::screen::Screen;
use self::shift::Shifts;
use self::style::Shade;
pub(crate) use self::style::Style;
use super::fidelity::Fidelity;

/// A ratatui backend that writes to `W`.
///
/// The colours and the modifiers bold, dim, italic, underlined and reversed are written; ratatui's
/// other modifiers are left out. A control character in a cell is written as a space.
#[derive(Debug)]
pub struct CellWriter<W> {
    output: W,
    size: Size,
    screen: Screen,
    pen: Pen,
    cursor_visible: bool,
    bytes_written: u64,
    fidelity: Fidelity,
    shifts: Shifts,
    row_encoder: RowEncoder,
    refinement: Refinement,
}

impl<W: Write> CellWriter<W> {
    /// A backend that writes to `output`, a terminal of `size` whose cursor is hidden, and which is
    /// blank.
    pub fn new(output: W, size: Size) -> Self {
        Self {
            output,
            size,
            screen: Screen::blank(size),
            pen: Pen::new(size),
            cursor_visible: false,
            bytes_written: 0,
            fidelity: Fidelity::EXACT,
            shifts: Shifts::default(),
            row_encoder: RowEncoder::default(),
            refinement: Refinement::new(),
        }
    }

    /// How many bytes have been written so far.
    pub fn bytes_written(&self) -> u64 {
        self.bytes_written
    }

    /// What is written to. A byte that others write to it is one that this does not know of.
    pub fn output_mut(&mut self) -> &mut W {
        &mut self.output
    }

    /// What was written to.
    pub fn into_output(self) -> W {
        self.output
    }

    /// From the next frame on, colours may be as far off as `fidelity` says.
    pub fn set_fidelity(&mut self, fidelity: Fidelity) {
        self.fidelity = fidelity;
    }

    /// From the next frame on, what is not ASCII is replaced by what looks like it, or is not.
    pub fn set_ascii(&mut self, is_ascii: bool) {
        self.screen.set_ascii(is_ascii);
    }

    /// From the next frame on, characters that follow themselves are written once and repeated, where
    /// `repeats`: the terminal must understand REP (`CSI n b`), also after half blocks.
    pub fn set_repeats(&mut self, repeats: bool) {
        self.pen.set_repeats(repeats);
    }

    /// From the next frame on, frequent colours are defined as entries 24 to 255 of the terminal's palette (OSC 4)
    /// where `uses_palette`, and used as these. Who turns that on gives the palette back (OSC 104) when all is
    /// done.
    ///
    /// Ratatui's indexed colours from the sixteenth on are then shown as xterm's standard palette has them.
    pub fn set_palette(&mut self, uses_palette: bool) {
        self.pen.palette().set_on(uses_palette);
    }

    /// Whether the terminal shows exactly what was drawn last. Where it does not, each further draw
    /// without a changed cell brings it nearer, and after the tenth it is.
    pub fn is_settled(&self) -> bool {
        self.screen.is_exact()
    }

    /// Draws a part of what is shown inexactly anew, and exactly: what a draw without a changed cell
    /// does. It is written with the next flush.
    pub fn refine(&mut self) {
        self.refinement.draw(&mut self.pen, &mut self.shifts, &mut self.screen);
    }

    /// The colours that the terminal shows in the upper and the lower half of a cell, or of the text in it and of
    /// its ground; `None` where nobody knows, and off the screen.
    pub fn shown_colors(&self, column: u16, row: u16) -> Option<[Color; 2]> {
        Some(self.screen.shown_colors(column, row)?.map(Shade::color))
    }

    /// Takes note that the window is now of `size`; ratatui clears it in the next frame.
    pub fn set_size(&mut self, size: Size) {
        self.size = size;
        self.screen.resize(size);
        self.pen.set_size(size);
    }

    /// Takes note that others may have written to the terminal: nothing is known but that the
    /// cursor is hidden.
    pub fn forget(&mut self) {
        self.screen.forget();
        self.pen.forget();
        self.cursor_visible = false;
    }

    /// Has `draw` draw a whole frame, on a blank screen, and takes note of what must be written for it with
    /// the next flush: for drawing without ratatui's [`Terminal`](ratatui::Terminal) and its buffers.
    ///
    /// ```
    /// use cellcaster::terminal::CellWriter;
    /// use cellcaster::canvas::Canvas;
    /// use ratatui::backend::Backend;
    /// use ratatui::layout::Size;
    ///
    /// let mut writer = CellWriter::new(Vec::new(), Size::new(80, 24));
    /// writer.draw_frame(|screen| screen.draw_widget("hello", screen.bounds()));
    /// writer.flush()?;
    /// assert!(writer.output_mut().ends_with(b"hello\x1b[?2026l"));
    /// # Ok::<(), std::io::Error>(())
    /// ```
    pub fn draw_frame(&mut self, draw: impl FnOnce(&mut Screen)) {
        self.screen.begin_frame();
        draw(&mut self.screen);
        self.screen.end_frame();
        self.update();
    }

    /// Draws what has changed; where nothing has, refines.
    fn update(&mut self) {
        if self.screen.is_changed() {
            self.refinement.disturb();
            self.screen.count_rest();
            self.draw_changed();
            self.refinement.draw_resting(&mut self.pen, &mut self.shifts, &mut self.screen);
        } else {
            self.refine();
        }
    }

    /// Makes every row that has changed look as it is wanted.
    fn draw_changed(&mut self) {
        let is_exact = self.fidelity == Fidelity::EXACT;
        let (pen, shifts) = (&mut self.pen, &mut self.shifts);
        let price = (!is_exact).then(|| Price::at(self.fidelity, Notation::Entry));
        pen.define_colors(&self.screen, price);
        for row in self.screen.changed_rows() {
            if is_exact {
                exact::draw_row(pen, shifts, row);
            } else {
                self.row_encoder.draw_row(pen, shifts, row, self.fidelity);
            }
        }
    }
}

impl<W: Write> Backend for CellWriter<W> {
    type Error = io::Error;

    fn draw<'a, I>(&mut self, content: I) -> io::Result<()>
    where
        I: Iterator<Item = (u16, u16, &'a Cell)>,
    {
        for (x, y, cell) in content {
            self.screen.want(x, y, cell);
        }
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

    /// Where the next character would go, as far as it is known without asking the terminal.
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
        self.screen.clear(region, self.pen.position().unwrap_or(Position::ORIGIN));
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

    /// Writes the frame, if there is anything in it.
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

#[cfg(test)]
mod tests;
