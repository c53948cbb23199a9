//! The pen: the bytes of a frame, with the shortest motions of the cursor, and the state of the terminal after them.
//!
//! A move to a lower row is a carriage return and line feeds. With the return, the result is the same whether or not
//! the terminal's line discipline adds a return to each feed. With a line feed alone, it would differ.

use std::cell::Cell;
use std::mem;

use crossterm::terminal::{BeginSynchronizedUpdate, EndSynchronizedUpdate};
use crossterm::{Command, queue};
use ratatui::buffer::CellWidth;
use ratatui::layout::{Position, Size};

use crate::terminal::cell_writer::block::{BlockElement, MosaicShape};
use crate::terminal::cell_writer::bytes::{Bytes, ControlSequence, Piece};
use crate::terminal::cell_writer::ink::Price;
use crate::terminal::cell_writer::packed_cell::PackedCell;
use crate::terminal::cell_writer::palette::TerminalPalette;
use crate::terminal::cell_writer::screen::Screen;
use crate::terminal::cell_writer::shift::{Shift, ShiftDirection};
use crate::terminal::cell_writer::style::{PackedColor, Style};

thread_local! {
    /// The memory of frames, between the frames of all pens of a thread. A frame takes up to 32 kB, and a server has
    /// hundreds of pens.
    static MEMORY: Cell<Bytes> = const { Cell::new(Bytes::NONE) };
}

/// Writes a frame, and tracks the terminal's style and cursor position.
#[derive(Debug)]
pub(crate) struct Pen {
    /// The bytes of the frame. They begin with the start of synchronized output.
    frame: Bytes,
    /// The size of the terminal.
    pub(crate) size: Size,
    /// The terminal's style. `None` if it is unknown.
    pub(crate) style: Option<Style>,
    /// The position of the cursor. `None` if it is unknown. In the column after the last one, the cursor waits to
    /// wrap.
    cursor: Option<PackedPosition>,
    /// Whether the terminal repeats characters (REP).
    pub(crate) repeats: bool,
    /// The last block drawn, unless other bytes were written since.
    last: Option<(MosaicShape, BlockElement)>,
    /// The number of repetitions of that block that are drawn but not written yet.
    repeated: u16,
    palette: TerminalPalette,
}

/// The state of the terminal between cells of pixels.
///
/// Most cells of most pictures are two pixels, drawn after another such cell. Between them, the colours and the column
/// of the cursor are in registers, and nothing else of the terminal's state matters. A cell then takes half of the
/// instructions that it takes when it is drawn alone.
#[derive(Clone, Copy)]
struct PixelState {
    /// The text colour and the background, in true colour. There are no modifiers.
    colors: [PackedColor; 2],
    /// The column of the cursor in the row.
    column: usize,
}

/// The final bytes of the sequences that delete characters and that insert blank ones.
const DELETE: u8 = b'P';
const INSERT: u8 = b'@';
/// The final byte of the sequence that repeats the preceding character (REP).
const REPEAT: u8 = b'b';

impl Pen {
    /// A pen for a terminal of this size and otherwise unknown state.
    pub(crate) fn new(size: Size) -> Self {
        Self {
            frame: Bytes::default(),
            size,
            style: None,
            cursor: None,
            repeats: false,
            last: None,
            repeated: 0,
            palette: TerminalPalette::default(),
        }
    }

    /// Sets whether a block that is drawn several times is written once and repeated.
    pub(crate) fn set_repeats(&mut self, repeats: bool) {
        self.repeats = repeats;
    }

    /// The terminal's palette.
    pub(crate) fn palette(&mut self) -> &mut TerminalPalette {
        &mut self.palette
    }

    /// Defines entries of the palette for the targets of `screen`, if that saves bytes.
    pub(crate) fn define_colors(&mut self, screen: &Screen, price: Option<Price>) {
        if self.palette.begin_frame(screen, self.style, price) {
            self.frame();
            self.frame.push_text(self.palette.definitions());
        }
    }

    /// If all colours are shown as entries of the palette, defines the entries and replaces the colours of all targets
    /// by them.
    pub(crate) fn quantize(&mut self, screen: &mut Screen) {
        if let Some(definitions) = self.palette.quantize(screen) {
            self.frame().push_text(definitions.as_slice());
            // The colours of the style may be entries that have changed.
            self.style = None;
        }
    }

    /// The position of the cursor. `None` if it is unknown.
    pub(crate) fn position(&self) -> Option<Position> {
        self.cursor().filter(|cursor| cursor.x < self.size.width)
    }

    /// The position of the cursor. Moves the cursor to the first cell if its position is unknown.
    pub(crate) fn settle(&mut self) -> Position {
        self.position().unwrap_or_else(|| {
            self.move_to(Position::ORIGIN);
            Position::ORIGIN
        })
    }

    /// Sets the size of the terminal.
    pub(crate) fn set_size(&mut self, size: Size) {
        self.size = size;
        self.cursor = None;
    }

    /// Ends the frame and returns it, unless it is empty. The next bytes belong to another frame.
    pub(crate) fn finish_frame(&mut self) -> Option<&[u8]> {
        if self.frame.is_empty() {
            return None;
        }
        self.command(EndSynchronizedUpdate);
        Some(self.frame.as_slice())
    }

    /// Begins another frame.
    pub(crate) fn clear(&mut self) {
        self.frame.clear();
        MEMORY.set(mem::take(&mut self.frame));
    }

    /// Forgets the terminal's state and the unsent bytes.
    pub(crate) fn forget(&mut self) {
        self.clear();
        self.palette.forget();
        (self.style, self.cursor, self.last, self.repeated) = (None, None, None, 0);
    }

    /// Writes a crossterm command that changes neither the cursor's position nor the style.
    pub(crate) fn command(&mut self, command: impl Command) {
        // A write to memory cannot fail.
        _ = queue!(self.frame(), command);
    }

    /// Moves the cursor to `target`, or to the nearest cell of the screen, as the terminal would.
    #[inline(never)]
    pub(crate) fn move_to(&mut self, target: Position) {
        let (cursor, size) = (self.cursor(), self.size);
        let target = Position {
            x: target.x.min(size.width.saturating_sub(1)),
            y: target.y.min(size.height.saturating_sub(1)),
        };
        let mut piece = self.frame().piece();
        push_motion(cursor, target, size, &mut piece);
        piece.finish();
        self.cursor = Some(PackedPosition::of(target));
    }

    pub(crate) fn set_style(&mut self, target: Style) {
        if self.style != Some(target) {
            let current = self.style;
            self.frame();
            let Self { frame, palette, .. } = self;
            let mut piece = frame.piece();
            target.push_from(current, |shade| palette.told(shade), &mut piece);
            piece.finish();
            self.style = Some(target);
        }
    }

    /// Draws a block at a position on the screen: a shape in the way in which `element` draws it. A block of one
    /// colour has the shape of halves.
    pub(crate) fn draw_block(
        &mut self,
        position: Position,
        (shape, element): (MosaicShape, BlockElement),
        style: Style,
    ) {
        let current = self.style;
        if self.cursor != Some(PackedPosition::of(position)) {
            self.move_to(position);
        } else if self.last == Some((shape, element)) && current == Some(style) {
            self.repeated += 1;
            self.advance(position);
            return;
        }
        self.frame();
        let Self { frame, palette, .. } = self;
        let mut piece = frame.piece();
        if current != Some(style) {
            style.push_from(current, |shade| palette.told(shade), &mut piece);
        }
        let (encoded, count) = shape.encoded(element);
        piece.push(encoded, count);
        piece.finish();
        self.style = Some(style);
        self.last = self.repeats.then_some((shape, element));
        self.advance(position);
    }

    /// Writes the repetitions that are drawn but not written yet.
    #[cold]
    fn write_repeated(&mut self) {
        let Some((shape, element)) = self.last else { return };
        let count = usize::from(mem::take(&mut self.repeated));
        let (encoded, bytes) = shape.encoded(element);
        let digits = if count > 1 { digits(count as u16) } else { 0 };
        if count * bytes <= 3 + digits {
            (0..count).for_each(|_| self.frame.push_text(&encoded[..bytes]));
        } else {
            let mut piece = self.frame.piece();
            if count > 1 {
                let mut repetition = ControlSequence::begin(&mut piece);
                repetition.place(count as u16);
                repetition.end(REPEAT);
            } else {
                piece.push([b'\x1b', b'[', REPEAT], 3);
            }
            piece.finish();
        }
    }

    /// The frame, with its beginning and all drawn repetitions.
    #[inline]
    fn frame(&mut self) -> &mut Bytes {
        if self.repeated > 0 {
            self.write_repeated();
        }
        self.last = None;
        if self.frame.is_empty() {
            self.frame = MEMORY.take();
            // A write to memory cannot fail.
            _ = queue!(self.frame, BeginSynchronizedUpdate);
        }
        &mut self.frame
    }

    /// Draws text without control characters.
    pub(crate) fn draw_text(&mut self, position: Position, text: &str, style: Style) {
        self.move_to(position);
        self.set_style(style);
        self.frame().push_text(text.as_bytes());
        if advances_by_one(text) {
            self.advance(position);
        } else {
            self.cursor = None;
        }
    }

    /// The position of the cursor, which may be in the column after the last one.
    #[inline]
    fn cursor(&self) -> Option<Position> {
        self.cursor.map(PackedPosition::get)
    }

    /// Records that the cursor has moved on from `position` by one column.
    #[inline]
    fn advance(&mut self, position: Position) {
        let next = Position { x: position.x.saturating_add(1), ..position };
        self.cursor = Some(PackedPosition::of(next));
    }

    /// Moves a stretch of row `y`. The cells to the right of the stretch move away and back.
    pub(crate) fn shift_row(&mut self, shift: &Shift, y: u16) {
        let (start, end) = (shift.columns.start as u16, shift.columns.end as u16);
        let by = shift.by as u16;
        let is_whole = end == self.size.width;
        let (start, end) = (Position { x: start, y }, Position { x: end - by, y });
        match shift.way {
            ShiftDirection::Left => {
                self.edit_row(start, by, DELETE);
                if !is_whole {
                    self.edit_row(end, by, INSERT);
                }
            }
            ShiftDirection::Right => {
                if !is_whole {
                    self.edit_row(end, by, DELETE);
                }
                self.edit_row(start, by, INSERT);
            }
        }
    }

    /// Deletes or inserts `count` characters at a position. The cursor stays there.
    fn edit_row(&mut self, at: Position, count: u16, operation: u8) {
        self.move_to(at);
        let mut piece = self.frame().piece();
        let mut edit = ControlSequence::begin(&mut piece);
        edit.place(count);
        edit.end(operation);
        piece.finish();
    }

    /// Draws these columns of row `y`. Calls `draw_other` for the cells that cannot be drawn as pixels now.
    #[inline]
    pub(crate) fn draw_pixels(
        &mut self,
        y: u16,
        cells: impl Iterator<Item = (usize, PackedCell)>,
        mut draw_other: impl FnMut(&mut Self, usize, PackedCell),
    ) {
        let mut state = self.pixel_state(y);
        for (column, target) in cells {
            let Some((now, (shape, pixels))) = state.zip(target.pixels()) else {
                self.keep_pixel_state(y, state);
                draw_other(self, column, target);
                state = self.pixel_state(y);
                continue;
            };
            if column != now.column {
                self.keep_pixel_state(y, state);
                self.move_to(Position { x: column as u16, y });
            }
            let colors = self.push_pixels(shape, pixels, now.colors);
            state = Some(PixelState { colors, column: column + 1 });
        }
        self.keep_pixel_state(y, state);
    }

    /// The state in which pixels can be drawn: after a cell of pixels in row `y`, on a terminal that neither repeats
    /// characters nor uses a palette.
    #[inline]
    fn pixel_state(&self, y: u16) -> Option<PixelState> {
        let Position { x, y: row } = self.cursor()?;
        let colors = self.style?.plain_colors()?;
        let is_sound = colors.into_iter().all(PackedColor::is_rgb)
            && row == y
            && !self.repeats
            && self.repeated == 0
            && !self.palette.is_on
            && !self.frame.is_empty();
        is_sound.then_some(PixelState { colors, column: x.into() })
    }

    #[inline]
    fn keep_pixel_state(&mut self, y: u16, state: Option<PixelState>) {
        if let Some(PixelState { colors: [text, ground], column }) = state {
            self.style = Some(Style::plain(text, ground));
            self.cursor = Some(PackedPosition::of(Position { x: column as u16, y }));
            self.last = None;
        }
    }

    /// Adds a cell of pixels at the cursor, and returns the colours after it.
    #[inline]
    fn push_pixels(
        &mut self,
        shape: MosaicShape,
        pixels: [PackedColor; 2],
        current: [PackedColor; 2],
    ) -> [PackedColor; 2] {
        let (element, colors) = BlockElement::cheapest_after(current, pixels);
        let mut piece = self.frame.piece();
        if colors != current {
            let mut rendition = ControlSequence::begin(&mut piece);
            PackedColor::push_change(colors, current, |shade| shade, &mut rendition);
            rendition.end(b'm');
        }
        let (encoded, count) =
            if shape == MosaicShape::HALF { element.encoded() } else { shape.encoded(element) };
        piece.push(encoded, count);
        piece.finish();
        colors
    }
}

/// Returns true if all terminals advance the cursor by one cell for `symbol`. These are European letters, and symbols
/// of the Unicode blocks from punctuation to arrows and of the block elements. For other symbols, terminals differ in
/// width, and join letters of some scripts.
fn advances_by_one(symbol: &str) -> bool {
    let mut characters = symbol.chars();
    let is_sure = |it| matches!(it, ..'\u{590}' | '\u{1e00}'..'\u{2e00}' | '\u{1cc00}'..'\u{1cec0}' | '\u{1fb00}'..'\u{1fc00}');
    characters.next().is_some_and(is_sure)
        && characters.next().is_none()
        && symbol.cell_width() == 1
}

/// A position in one word.
///
/// Rejected: a [`Position`]. The pen stores its position after each cell and loads it before the next. The two fields
/// were stored one by one and loaded as one word. A processor cannot forward two pending stores to one load, and
/// waited for a third of the time that drawing a cell took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct PackedPosition(u32);

impl PackedPosition {
    #[inline]
    fn of(position: Position) -> Self {
        Self(u32::from(position.y) << u16::BITS | u32::from(position.x))
    }

    #[inline]
    fn get(self) -> Position {
        Position { x: self.0 as u16, y: (self.0 >> u16::BITS) as u16 }
    }
}

/// Adds the motion from `cursor` to `target`, on a terminal of `size`. In the column after the last
/// one, a cursor waits to wrap.
fn push_motion(cursor: Option<Position>, target: Position, size: Size, piece: &mut Piece) {
    if cursor == Some(target) {
        return;
    }
    match cursor {
        Some(cursor) if cursor.y == target.y && cursor.x < target.x => {
            push_right(target.x - cursor.x, piece);
        }
        _ => push_far(cursor, target, size, piece),
    }
}

fn push_right(by: u16, piece: &mut Piece) {
    if by == 1 {
        piece.push(*b"\x1b[C", 3);
    } else {
        let mut motion = ControlSequence::begin(piece);
        motion.place(by);
        motion.end(b'C');
    }
}

/// More line feeds than this take more bytes than an absolute row.
const MAX_FEEDS: u16 = 5;

fn push_far(cursor: Option<Position>, target: Position, size: Size, piece: &mut Piece) {
    let Some(cursor) = cursor else { return push_absolute(target, piece) };
    if cursor.y == target.y && target.x < cursor.x && cursor.x < size.width {
        let by = cursor.x - target.x;
        let longest = bytes_of_return(target.x);
        if by <= 3 && usize::from(by) <= longest {
            (0..by).for_each(|_| piece.push([b'\x08'], 1));
            return;
        }
        if 3 + digits(by) <= longest {
            let mut motion = ControlSequence::begin(piece);
            motion.place(by);
            return motion.end(b'D');
        }
    }
    let feeds = target.y.wrapping_sub(cursor.y);
    let is_near = feeds <= MAX_FEEDS && target.y < size.height;
    if is_near && usize::from(feeds) + bytes_of_return(target.x) <= bytes_of_absolute(target) {
        piece.push([b'\r'], 1);
        (0..feeds).for_each(|_| piece.push([b'\n'], 1));
        if target.x > 0 {
            push_right(target.x, piece);
        }
        return;
    }
    push_absolute(target, piece);
}

fn push_absolute(target: Position, piece: &mut Piece) {
    let mut motion = ControlSequence::begin(piece);
    motion.place(target.y.saturating_add(1));
    if target.x > 0 {
        motion.place(target.x.saturating_add(1));
    }
    motion.end(b'H');
}

/// The number of bytes of a motion to column `x` through the first column.
fn bytes_of_return(x: u16) -> usize {
    match x {
        0 => 1,
        1 => 4,
        _ => 4 + digits(x),
    }
}

fn bytes_of_absolute(target: Position) -> usize {
    let column = if target.x > 0 { 1 + digits(target.x + 1) } else { 0 };
    3 + digits(target.y + 1) + column
}

/// The number of digits of `number`.
#[inline]
fn digits(number: u16) -> usize {
    1 + usize::from(number > 9)
        + usize::from(number > 99)
        + usize::from(number > 999)
        + usize::from(number > 9999)
}

#[cfg(test)]
mod tests {
    use super::super::bytes::Bytes;
    use super::*;
    use proptest::prelude::*;

    fn motion(cursor: Option<Position>, target: Position) -> Vec<u8> {
        let mut bytes = Bytes::default();
        let mut piece = bytes.piece();
        push_motion(cursor, target, Size::new(120, 40), &mut piece);
        piece.finish();
        bytes.as_slice().to_vec()
    }

    #[test]
    fn motions_to_near_cells_are_short() {
        let from = Position::new(10, 5);
        for (x, y, expected) in [
            (10, 5, ""),
            (11, 5, "\x1b[C"),
            (12, 5, "\x1b[2C"),
            (9, 5, "\x08"),
            (7, 5, "\x08\x08\x08"),
            (5, 5, "\x1b[5D"),
            (0, 5, "\r"),
            (0, 6, "\r\n"),
            (1, 6, "\r\n\x1b[C"),
            (0, 4, "\x1b[5H"),
            (3, 20, "\x1b[21;4H"),
        ] {
            let bytes = motion(Some(from), Position::new(x, y));
            assert_eq!(bytes, expected.as_bytes(), "{x} {y}");
        }
        assert_eq!(motion(None, Position::ORIGIN), b"\x1b[1H");
        // On some terminals, a backspace does not move a cursor that waits to wrap.
        assert_eq!(motion(Some(Position::new(120, 5)), Position::new(119, 5)), b"\r\x1b[119C");
    }

    proptest! {
        #[test]
        fn every_motion_reaches_its_target(from in (0..=120_u16, 0..40_u16), to in (0..120_u16, 0..40_u16)) {
            let mut screen = vt100::Parser::new(
                40.try_into().unwrap(),
                120.try_into().unwrap(),
                0,
            );
            let waits = from.0 == 120;
            screen.process(format!("\x1b[{};{}H", from.1 + 1, (from.0 + 1).min(120)).as_bytes());
            if waits {
                screen.process(b"x");
            }
            let target = Position::new(to.0, to.1);
            let bytes = motion(Some(Position::new(from.0, from.1)), target);
            screen.process(&bytes);
            prop_assert_eq!(screen.screen().cursor_position(), (to.1, to.0));
            prop_assert!(bytes.len() <= bytes_of_absolute(target));
        }
    }
}
