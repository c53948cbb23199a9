//! The encoder: converts ratatui's cells to control sequences.
//!
//! The writer collects the bytes of a frame and writes them with one `write`, between the control sequences of
//! synchronized output. It writes nothing for a frame without a change. It records the terminal's colours and cursor
//! position from frame to frame. It sends only the colours that differ, and moves the cursor only if it must.
//! Ratatui's own backends send both colours if one differs, and 25 bytes for a frame without a change.
//!
//! The writer keeps a model of the screen, cell by cell. It does not send cells that are already right. If parts of a
//! row have moved sideways, it makes the terminal shift them, unless the [`Effort`] is greedy. At a [`Fidelity`] that is
//! not exact, it searches each row for the cheapest way to show it within the tolerance: half blocks or characters, in
//! true colour or in a palette. A screen that does not change becomes exact in ten frames.

mod block;
mod bytes;
mod greedy;
mod ink;
mod packed_cell;
mod palette;
mod pen;
mod row;
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
use self::ink::Price;
use self::pen::Pen;
use self::row::Refinement;
use self::row::{RowEncoder, draw_row};
pub use self::screen::Screen;
use self::shift::Shifts;
#[cfg(feature = "cli")]
pub(crate) use self::style::Style;
#[cfg(not(feature = "cli"))]
use self::style::Style;
use self::style::{Notation, PackedColor};
use super::fidelity::{Effort, Fidelity};
use crate::tui::canvas::Mosaic;

/// A ratatui backend that writes to `W`.
///
/// It writes the colours and the modifiers bold, dim, italic, underlined and reversed, and leaves out ratatui's other
/// modifiers. It writes a space for a cell whose text contains a control character or has no width, and for a wide
/// character that the last column would cut. A wide character covers the cells after it. When it is overwritten, these
/// cells are blank until they are drawn.
///
/// ```
/// use cellcaster::terminal::CellWriter;
/// use ratatui::Terminal;
/// use ratatui::layout::Size;
/// use ratatui::widgets::Paragraph;
///
/// let backend = CellWriter::new(Vec::new(), Size::new(80, 24));
/// let mut terminal = Terminal::new(backend)?;
/// terminal.draw(|frame| frame.render_widget(Paragraph::new("hello"), frame.area()))?;
/// // A frame that equals the one before takes no bytes.
/// let bytes = terminal.backend().bytes_written();
/// terminal.draw(|frame| frame.render_widget(Paragraph::new("hello"), frame.area()))?;
/// assert_eq!(terminal.backend().bytes_written(), bytes);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct CellWriter<W> {
    output: W,
    screen: Screen,
    pen: Pen,
    cursor_visible: bool,
    bytes_written: u64,
    fidelity: Fidelity,
    effort: Effort,
    shifts: Shifts,
    refinement: Refinement,
}

impl<W: Write> CellWriter<W> {
    /// A backend that writes to `output`, which must be a blank terminal of `size` with a hidden
    /// cursor.
    pub fn new(output: W, size: Size) -> Self {
        Self {
            output,
            screen: Screen::blank(size),
            pen: Pen::new(size),
            cursor_visible: false,
            bytes_written: 0,
            fidelity: Fidelity::EXACT,
            effort: Effort::Search,
            shifts: Shifts::default(),
            refinement: Refinement::new(),
        }
    }

    /// The total number of bytes written.
    pub fn bytes_written(&self) -> u64 {
        self.bytes_written
    }

    /// The output. The writer does not see bytes that other code writes to it.
    pub fn output_mut(&mut self) -> &mut W {
        &mut self.output
    }

    /// Sets the fidelity of colours from the next frame on.
    pub fn set_fidelity(&mut self, fidelity: Fidelity) {
        self.fidelity = fidelity;
    }

    /// Sets the effort at fidelities that are not exact, from the next frame on.
    pub fn set_effort(&mut self, effort: Effort) {
        self.effort = effort;
    }

    /// Sets whether characters beyond ASCII are replaced by similar ones, from the next frame on.
    pub fn set_ascii(&mut self, is_ascii: bool) {
        self.screen.set_ascii(is_ascii);
    }

    /// Sets whether repeated characters are written once with a repeat count, from the next frame
    /// on. The terminal must understand REP (`CSI n b`), also after half blocks.
    pub fn set_repeats(&mut self, repeats: bool) {
        self.pen.set_repeats(repeats);
    }

    /// Sets whether frequent colours are defined as entries 24 to 255 of the terminal's palette (OSC 4) and sent as
    /// these entries, from the next frame on. A caller that turns this on must reset the palette at the end (OSC 104).
    ///
    /// The terminal then shows ratatui's indexed colours from the sixteenth on as in xterm's standard palette.
    pub fn set_palette(&mut self, uses_palette: bool) {
        if self.pen.palette().is_quantizing() {
            self.screen.redraw();
        }
        self.pen.palette().set_on(uses_palette);
    }

    /// From the next frame on, shows all colours as entries 24 to 255 of the terminal's palette, and defines these
    /// entries to be near the colours of the frames. The next frame is drawn in full. This is for terminals that show
    /// 256 colours and let programs define them (OSC 4). The caller must reset the palette at the end (OSC 104).
    ///
    /// [`CellWriter::shown_colors`] then returns the colours of the entries, and a screen that shows them is settled.
    /// The 16 named colours and the terminal's default colours do not change.
    pub fn set_own_palette(&mut self) {
        self.pen.palette().set_quantizing();
        self.screen.redraw();
    }

    /// Returns true if the terminal shows the last drawn frame exactly. If it does not, each further draw without a
    /// changed cell brings it nearer, and the tenth makes it exact.
    pub fn is_settled(&self) -> bool {
        self.screen.is_exact()
    }

    /// Redraws some of the inexact cells exactly, as a draw without a changed cell does. The next flush writes them.
    pub fn refine(&mut self) {
        self.refinement.draw(&mut self.pen, &mut self.shifts, &mut self.screen);
    }

    /// The two colours that the terminal shows in a cell: in its upper and its lower half, in the dots of a finer
    /// block and in the rest, or in its text and its background. `None` if they are unknown or the cell is off the
    /// screen.
    pub fn shown_colors(&self, column: u16, row: u16) -> Option<[Color; 2]> {
        Some(self.screen.shown_colors(column, row)?.map(PackedColor::color))
    }

    /// The mosaic that a cell shows in its colours. `None` if the cell shows no mosaic or is unknown.
    pub fn shown_mosaic(&self, column: u16, row: u16) -> Option<Mosaic> {
        self.screen.shown_mosaic(column, row)
    }

    /// Sets the size of the window. Ratatui clears it in the next frame.
    pub fn set_size(&mut self, size: Size) {
        self.screen.resize(size);
        self.pen.set_size(size);
    }

    /// Forgets the state of the terminal, because other code may have written to it. Only the cursor is still assumed
    /// to be hidden.
    pub fn forget(&mut self) {
        self.screen.forget();
        self.pen.forget();
        self.cursor_visible = false;
    }

    /// Forgets the position of the cursor and the colours in force. The next frame is then right for every terminal that
    /// shows the same screen.
    pub fn forget_pen(&mut self) {
        self.pen.forget();
    }

    /// Calls `draw` to draw a whole frame on a blank screen, without ratatui's
    /// [`Terminal`](ratatui::Terminal) and its buffers. The next flush writes the changes.
    ///
    /// ```
    /// use cellcaster::terminal::CellWriter;
    /// use cellcaster::tui::canvas::Canvas;
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
        let before = self.screen.begin_frame();
        draw(&mut self.screen);
        self.pen.quantize(&mut self.screen);
        self.screen.end_frame(before);
        self.update();
    }

    /// Draws the changed rows, or refines the screen if no row has changed.
    fn update(&mut self) {
        if self.screen.is_changed() {
            self.refinement.disturb();
            self.screen.count_rest();
            self.draw_changed();
            Refinement::draw_resting(&mut self.pen, &mut self.shifts, &mut self.screen);
        } else {
            self.refine();
        }
    }

    /// Makes every changed row look like its target.
    fn draw_changed(&mut self) {
        let is_exact = self.fidelity == Fidelity::EXACT;
        let (pen, shifts) = (&mut self.pen, &mut self.shifts);
        let price = (!is_exact).then(|| Price::at(self.fidelity, Notation::Entry));
        pen.define_colors(&self.screen, price);
        let rows = self.screen.changed_rows();
        if is_exact {
            rows.for_each(|row| draw_row(pen, shifts, row));
        } else {
            RowEncoder::draw_rows(pen, shifts, rows, (self.fidelity, self.effort));
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
        Ok(self.pen.size)
    }

    fn window_size(&mut self) -> io::Result<WindowSize> {
        Ok(WindowSize { columns_rows: self.pen.size, pixels: Size::ZERO })
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

#[cfg(test)]
mod tests;
