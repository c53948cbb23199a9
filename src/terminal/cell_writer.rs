//! Cells to bytes: ratatui's changed cells, as the control sequences that draw them.
//!
//! The bytes of a frame are collected and written with one `write`, between the marks of
//! synchronized output; a frame that changes nothing writes nothing. What the terminal has been
//! told is carried from frame to frame, so only the colour that differs is sent, and the cursor is
//! moved only where it does not already stand. Ratatui's own backends send both colours when one
//! differs, and 25 bytes for a frame without a change.
//!
//! What the terminal shows is modelled cell by cell: what looks as it should is not sent, and what
//! moved sideways is moved by the terminal.

mod control;
mod look;
mod screen;
mod shift;
mod style;
mod tolerance;

use std::io::{self, Write};

use crossterm::cursor::{Hide, Show};
use crossterm::queue;
use crossterm::terminal::{self, BeginSynchronizedUpdate, Clear, EndSynchronizedUpdate};
use ratatui::backend::{Backend, ClearType, WindowSize};
use ratatui::buffer::{Cell, CellWidth};
use ratatui::layout::{Position, Size};
use ratatui::style::Color;

use self::control::ControlSequence;
use self::look::{Block, Look};
use self::screen::{Row, Screen};
use self::shift::{Shift, Way};
use self::style::Shade;
pub(crate) use self::style::Style;
use self::tolerance::Tolerance;
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
    /// What is to be written; it begins with the mark of synchronized output.
    frame: Vec<u8>,
    style: Option<Style>,
    position: Option<Position>,
    cursor_visible: bool,
    bytes_written: u64,
    fidelity: Fidelity,
    /// How far colours may be off at present: shrinks while nothing moves.
    tolerance: Tolerance,
}

impl<W: Write> CellWriter<W> {
    /// A backend that writes to `output`, a terminal of `size` whose cursor is hidden, and which is
    /// blank.
    pub fn new(output: W, size: Size) -> Self {
        Self {
            output,
            size,
            screen: Screen::blank(size),
            frame: Vec::new(),
            style: None,
            position: None,
            cursor_visible: false,
            bytes_written: 0,
            fidelity: Fidelity::EXACT,
            tolerance: Tolerance::of(Fidelity::EXACT),
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

    /// Whether the terminal shows exactly what was drawn last. Where it does not, each further draw
    /// without a changed cell brings it nearer, and the tenth is exact.
    pub fn is_settled(&self) -> bool {
        self.screen.is_exact()
    }

    /// Draws what is shown inexactly anew, a little more exactly: what a draw without a changed cell
    /// does. It is written with the next flush.
    ///
    /// # Errors
    ///
    /// None but those of writing into memory.
    pub fn refine(&mut self) -> io::Result<()> {
        self.tolerance = self.tolerance.refined(self.fidelity);
        self.screen.redraw_inexact();
        self.draw_changed()
    }

    /// The colours that the terminal shows in the upper and the lower half of a cell; `None` where
    /// it shows text in it, where nobody knows, and off the screen.
    pub fn shown_colors(&self, column: u16, row: u16) -> Option<[Color; 2]> {
        Some(self.screen.shown(column, row)?.halves()?.map(Shade::color))
    }

    /// Takes note that the window is now of `size`; ratatui clears it in the next frame.
    pub fn set_size(&mut self, size: Size) {
        self.size = size;
        self.screen.resize(size);
    }

    /// Takes note that others may have written to the terminal: nothing is known but that the
    /// cursor is hidden.
    pub fn forget(&mut self) {
        self.frame.clear();
        self.screen.forget();
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

    /// Makes every row that has changed look as it is wanted.
    fn draw_changed(&mut self) -> io::Result<()> {
        // Taken out while it is read, as what is written to goes by the same name.
        let mut screen = std::mem::replace(&mut self.screen, Screen::none());
        let drawn = screen.take_changed().try_for_each(|row| self.draw_row(row));
        self.screen = screen;
        drawn
    }

    /// Makes a row look as it is wanted.
    fn draw_row(&mut self, row: Row) -> io::Result<()> {
        let Row { y, shown, looks, wanted, exact } = row;
        if shown.iter().chain(looks).all(|look| look.can_move()) {
            for _ in 0..MOST_SHIFTS {
                let Some(shift) = Shift::best(shown, looks, self.tolerance) else { break };
                self.shift(&shift, y)?;
                shift.apply(shown);
            }
        }
        let mut covered = 0;
        *exact = true;
        for (x, (shown, &look)) in (0..).zip(shown.iter_mut().zip(looks)) {
            if covered > 0 {
                // The second half of a wide character.
                covered -= 1;
                *shown = Look::UNKNOWN;
                continue;
            }
            if !shown.is_near(look, self.tolerance) {
                *shown = match look.halves() {
                    Some(halves) => self.draw_block(Position { x, y }, halves)?,
                    None => self.draw_cell(Position { x, y }, &wanted[usize::from(x)], look)?,
                };
            }
            if look.is_intricate() {
                covered = wanted[usize::from(x)].cell_width().saturating_sub(1);
            }
            *exact &= *shown == look;
        }
        Ok(())
    }

    /// Writes what passes for a block of these two halves, and answers what it looks like.
    fn draw_block(&mut self, position: Position, halves: [Shade; 2]) -> io::Result<Look> {
        self.move_to(position)?;
        let Block { symbol, style, look } = look::cheapest(halves, self.style, self.tolerance);
        self.set_style(style)?;
        self.frame()?.extend_from_slice(symbol.as_bytes());
        self.position = Some(Position { x: position.x.saturating_add(1), ..position })
            .filter(|next| next.x < self.size.width);
        Ok(look)
    }

    /// Writes `cell` as it is.
    fn draw_cell(&mut self, position: Position, cell: &Cell, look: Look) -> io::Result<Look> {
        self.move_to(position)?;
        self.set_style(Style::of(cell))?;
        self.write_symbol(position, cell.symbol())?;
        Ok(look)
    }

    /// Moves a stretch of row `y`. What is to the right of it moves back and forth.
    fn shift(&mut self, shift: &Shift, y: u16) -> io::Result<()> {
        let (start, end, by) =
            (shift.columns.start as u16, shift.columns.end as u16, shift.by as u16);
        let is_whole = end == self.size.width;
        match shift.way {
            Way::Left => {
                self.edit_row(Position { x: start, y }, by, DELETE)?;
                if !is_whole {
                    self.edit_row(Position { x: end - by, y }, by, INSERT)?;
                }
            }
            Way::Right => {
                if !is_whole {
                    self.edit_row(Position { x: end - by, y }, by, DELETE)?;
                }
                self.edit_row(Position { x: start, y }, by, INSERT)?;
            }
        }
        Ok(())
    }

    /// Deletes or inserts `count` characters; the cursor stays.
    fn edit_row(&mut self, at: Position, count: u16, operation: u8) -> io::Result<()> {
        self.move_to(at)?;
        let mut edit = ControlSequence::begin(self.frame()?);
        edit.parameter(count);
        edit.end(operation);
        Ok(())
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

/// How often a row is shifted in a frame: its left, its right and its middle may each move their way.
const MOST_SHIFTS: usize = 6;

/// The last bytes of the sequences that delete characters, and insert blank ones.
const DELETE: u8 = b'P';
const INSERT: u8 = b'@';

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
            self.screen.want(x, y, cell);
        }
        if !self.screen.is_changed() {
            return self.refine();
        }
        self.tolerance = Tolerance::of(self.fidelity);
        self.draw_changed()
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
        self.screen.clear(region, self.position.unwrap_or(Position::ORIGIN));
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
