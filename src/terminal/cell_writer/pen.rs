//! What is written: the bytes of a frame, and what the terminal has been told by them.

use crossterm::terminal::{BeginSynchronizedUpdate, EndSynchronizedUpdate};
use crossterm::{Command, queue};
use ratatui::buffer::CellWidth;
use ratatui::layout::Position;

use super::bytes::{Bytes, Piece};
use super::control::ControlSequence;
use super::look::Glyph;
use super::shift::{Shift, Way};
use super::style::Style;

/// Writes a frame, and knows in which colours the terminal draws, and where its cursor stands.
#[derive(Debug)]
pub(super) struct Pen {
    /// It begins with the mark of synchronized output.
    frame: Bytes,
    /// How wide the terminal is.
    width: u16,
    style: Option<Style>,
    position: Option<Position>,
}

/// The last bytes of the sequences that delete characters, and insert blank ones.
const DELETE: u8 = b'P';
const INSERT: u8 = b'@';

impl Pen {
    /// For a terminal of that width of which nothing is known.
    pub(super) fn new(width: u16) -> Self {
        Self { frame: Bytes::default(), width, style: None, position: None }
    }

    /// What the terminal draws in; `None` where nobody knows.
    pub(super) fn style(&self) -> Option<Style> {
        self.style
    }

    /// Where the cursor stands; `None` where nobody knows.
    pub(super) fn position(&self) -> Option<Position> {
        self.position
    }

    /// The terminal is now so wide.
    pub(super) fn set_width(&mut self, width: u16) {
        self.width = width;
    }

    /// The frame, if anything is in it; what is written next is in another one.
    pub(super) fn finish_frame(&mut self) -> Option<&[u8]> {
        if self.frame.is_empty() {
            return None;
        }
        self.command(EndSynchronizedUpdate);
        Some(self.frame.as_slice())
    }

    /// Begins another frame.
    pub(super) fn clear(&mut self) {
        self.frame.clear();
    }

    /// Nothing is known of the terminal, and what was written has never been sent.
    pub(super) fn forget(&mut self) {
        *self = Self { frame: std::mem::take(&mut self.frame), ..Self::new(self.width) };
        self.frame.clear();
    }

    /// Writes one of crossterm's commands that changes neither the cursor's place nor the style.
    pub(super) fn command(&mut self, command: impl Command) {
        // Memory takes everything.
        _ = queue!(begun(&mut self.frame), command);
    }

    pub(super) fn move_to(&mut self, target: Position) {
        let mut piece = begun(&mut self.frame).piece();
        push_motion(self.position, target, &mut piece);
        piece.finish();
        self.position = Some(target);
    }

    pub(super) fn set_style(&mut self, target: Style) {
        if self.style != Some(target) {
            let mut piece = begun(&mut self.frame).piece();
            target.push_from(self.style, &mut piece);
            piece.finish();
            self.style = Some(target);
        }
    }

    /// Draws a block at a position on the screen.
    #[expect(clippy::inline_always, reason = "calls would take longer than what they do")]
    #[inline(always)]
    pub(super) fn draw_block(&mut self, position: Position, glyph: Glyph, style: Style) {
        let mut piece = begun(&mut self.frame).piece();
        push_motion(self.position, position, &mut piece);
        if self.style != Some(style) {
            style.push_from(self.style, &mut piece);
            self.style = Some(style);
        }
        let (encoded, count) = glyph.encoded();
        piece.push(encoded, count);
        piece.finish();
        self.advance(position);
    }

    /// Draws any text. A control character is written as a space.
    pub(super) fn draw_text(&mut self, position: Position, text: &str, style: Style) {
        let text = if text.chars().any(char::is_control) { " " } else { text };
        self.move_to(position);
        self.set_style(style);
        begun(&mut self.frame).push_text(text.as_bytes());
        if advances_by_one(text) {
            self.advance(position);
        } else {
            self.position = None;
        }
    }

    /// The cursor has moved on from there.
    #[inline]
    fn advance(&mut self, position: Position) {
        let next = Position { x: position.x.saturating_add(1), ..position };
        self.position = (next.x < self.width).then_some(next);
    }

    /// Moves a stretch of row `y`. What is to the right of it moves back and forth.
    pub(super) fn shift_row(&mut self, shift: &Shift, y: u16) {
        let (start, end) = (shift.columns.start as u16, shift.columns.end as u16);
        let by = shift.by as u16;
        let is_whole = end == self.width;
        let (start, end) = (Position { x: start, y }, Position { x: end - by, y });
        match shift.way {
            Way::Left => {
                self.edit_row(start, by, DELETE);
                if !is_whole {
                    self.edit_row(end, by, INSERT);
                }
            }
            Way::Right => {
                if !is_whole {
                    self.edit_row(end, by, DELETE);
                }
                self.edit_row(start, by, INSERT);
            }
        }
    }

    /// Deletes or inserts `count` characters at a position; the cursor stays there.
    fn edit_row(&mut self, at: Position, count: u16, operation: u8) {
        self.move_to(at);
        let mut piece = begun(&mut self.frame).piece();
        let mut edit = ControlSequence::begin(&mut piece);
        edit.place(count);
        edit.end(operation);
        piece.finish();
    }
}

/// The frame, begun if it was not.
#[inline]
fn begun(frame: &mut Bytes) -> &mut Bytes {
    if frame.is_empty() {
        // Memory takes everything.
        _ = queue!(frame, BeginSynchronizedUpdate);
    }
    frame
}

/// Adds the motion from where the cursor stands to `target`.
#[expect(clippy::inline_always, reason = "calls would take longer than what they do")]
#[inline(always)]
fn push_motion(position: Option<Position>, target: Position, piece: &mut Piece) {
    if position == Some(target) {
        return;
    }
    let mut motion = ControlSequence::begin(piece);
    match position {
        Some(position) if position.y == target.y && position.x < target.x => {
            motion.place(target.x - position.x);
            motion.end(b'C');
        }
        _ => {
            motion.place(target.y.saturating_add(1));
            motion.place(target.x.saturating_add(1));
            motion.end(b'H');
        }
    }
}

/// Whether every terminal moves its cursor by one cell for `symbol`. They disagree about the rest.
fn advances_by_one(symbol: &str) -> bool {
    symbol.chars().nth(1).is_none() && symbol.cell_width() == 1
}
