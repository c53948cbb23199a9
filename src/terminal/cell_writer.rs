//! The encoder: ratatui's cells to control sequences.
//!
//! The bytes of a frame are collected and written with one `write`, between the control sequences
//! of synchronized output. A frame without a change writes nothing. The writer records the
//! terminal's colours and cursor position from frame to frame, so that it sends only colours that
//! differ and moves the cursor only if it must. Ratatui's own backends send both colours if one
//! differs, and 25 bytes for a frame without a change.
//!
//! The writer keeps a model of the screen, cell by cell. It does not send cells that are already
//! right, and it has the terminal move parts of rows that moved sideways. At a [`Fidelity`] that is
//! not exact, it searches each row for the cheapest way to show it within the tolerance: half
//! blocks or characters, in true colour or in a palette. A screen that does not change becomes
//! exact in ten frames.

mod ascii;
mod backend;
mod block_element;
mod bytes;
mod control;
mod exact;
mod glyph_table;
mod inexact;
mod ink;
mod motion;
mod packed_cell;
mod packed_position;
mod palette;
mod pen;
mod refinement;
mod screen;
mod shape;
mod shift;
mod style;
mod symbol;
mod trellis;

use std::io::Write;

use ratatui::layout::Size;
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
#[cfg(feature = "cli")]
pub(crate) use self::style::Style;
use super::fidelity::Fidelity;
#[cfg(feature = "lab")]
use crate::tui::canvas::Mosaic;

/// A ratatui backend that writes to `W`.
///
/// The colours and the modifiers bold, dim, italic, underlined and reversed are written; ratatui's
/// other modifiers are left out. A cell whose text contains a control character or has no width is
/// written as a space, and so is a wide character that the last column would cut. A wide character
/// covers the cells after it; when it goes, they are blank until they are drawn.
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
    size: Size,
    screen: Screen,
    pen: Pen,
    cursor_visible: bool,
    bytes_written: u64,
    fidelity: Fidelity,
    shifts: Shifts,
    refinement: Refinement,
}

impl<W: Write> CellWriter<W> {
    /// A backend that writes to `output`, which must be a blank terminal of `size` with a hidden
    /// cursor.
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
            refinement: Refinement::new(),
        }
    }

    /// The number of bytes written so far.
    pub fn bytes_written(&self) -> u64 {
        self.bytes_written
    }

    /// The output. The writer does not see bytes that other code writes to it.
    pub fn output_mut(&mut self) -> &mut W {
        &mut self.output
    }

    /// Returns the output.
    pub fn into_output(self) -> W {
        self.output
    }

    /// Sets the fidelity of colours from the next frame on.
    pub fn set_fidelity(&mut self, fidelity: Fidelity) {
        self.fidelity = fidelity;
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

    /// Sets whether frequent colours are defined as entries 24 to 255 of the terminal's palette
    /// (OSC 4) and used as these, from the next frame on. A caller that turns this on must reset
    /// the palette at the end (OSC 104).
    ///
    /// The terminal then shows ratatui's indexed colours from the sixteenth on as in xterm's
    /// standard palette.
    pub fn set_palette(&mut self, uses_palette: bool) {
        if self.pen.palette().is_quantizing() {
            self.screen.redraw();
        }
        self.pen.palette().set_on(uses_palette);
    }

    /// Shows all colours as entries 24 to 255 of the terminal's palette, which are defined to be near
    /// the colours of the frames, from the next frame on. It is drawn whole. For terminals that show
    /// 256 colours and let programs define them (OSC 4); the caller must reset the palette at the
    /// end (OSC 104).
    ///
    /// [`CellWriter::shown_colors`] then returns colours of entries, and a screen that shows these is
    /// settled. The 16 named colours and the terminal's own are not changed.
    pub fn set_own_palette(&mut self) {
        self.pen.palette().set_quantizing();
        self.screen.redraw();
    }

    /// Whether the terminal shows exactly the last frame drawn. If it does not, each further draw
    /// without a changed cell brings it nearer, and the tenth makes it exact.
    pub fn is_settled(&self) -> bool {
        self.screen.is_exact()
    }

    /// Draws a part of the inexact cells again, exactly, as a draw without a changed cell does. The
    /// next flush writes it.
    pub fn refine(&mut self) {
        self.refinement.draw(&mut self.pen, &mut self.shifts, &mut self.screen);
    }

    /// The colours that the terminal shows in the upper and the lower half of a cell, in the dots of a
    /// finer block and in the rest, or of its text and its background. `None` if they are unknown, and off the screen.
    pub fn shown_colors(&self, column: u16, row: u16) -> Option<[Color; 2]> {
        Some(self.screen.shown_colors(column, row)?.map(Shade::color))
    }

    /// The mosaic that a cell shows in its colours; `None` if it shows none, or an unknown one.
    #[cfg(feature = "lab")]
    pub(crate) fn shown_mosaic(&self, column: u16, row: u16) -> Option<Mosaic> {
        self.screen.shown_mosaic(column, row)
    }

    /// Sets the size of the window. Ratatui clears it in the next frame.
    pub fn set_size(&mut self, size: Size) {
        self.size = size;
        self.screen.resize(size);
        self.pen.set_size(size);
    }

    /// Forgets the state of the terminal, except that the cursor is hidden: others may have written
    /// to it.
    pub fn forget(&mut self) {
        self.screen.forget();
        self.pen.forget();
        self.cursor_visible = false;
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
        self.screen.begin_frame();
        draw(&mut self.screen);
        self.pen.quantize(&mut self.screen);
        self.screen.end_frame();
        self.update();
    }

    /// Draws the changed rows; refines the screen if there are none.
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
            rows.for_each(|row| exact::draw_row(pen, shifts, row));
        } else {
            RowEncoder::draw_rows(pen, shifts, rows, self.fidelity);
        }
    }
}

#[cfg(test)]
mod tests;
