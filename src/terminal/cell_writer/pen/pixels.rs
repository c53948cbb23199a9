//! Draws the pixels of a row.
//!
//! Most cells of most pictures are two pixels, drawn after another such cell. Between them, the colours and
//! the column of the cursor are in registers, and nothing else of the terminal's state matters: a cell takes
//! half of the instructions that it takes one by one.

use ratatui::layout::Position;

use super::Pen;
use crate::terminal::cell_writer::block_element;
use crate::terminal::cell_writer::control::ControlSequence;
use crate::terminal::cell_writer::packed_cell::PackedCell;
use crate::terminal::cell_writer::packed_position::PackedPosition;
use crate::terminal::cell_writer::shape::Shape;
use crate::terminal::cell_writer::style::{Shade, Style};

/// The state of the terminal between cells of pixels.
#[derive(Clone, Copy)]
struct PixelState {
    /// The text colour and the background, in true colour; there are no modifiers.
    colors: [Shade; 2],
    /// The column of the cursor in the row.
    column: usize,
}

impl Pen {
    /// Draws these columns of row `y`, and has `draw_other` draw those that cannot be drawn as pixels now.
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

    /// The state in which pixels can be drawn: after a cell of pixels in row `y`, on a terminal that neither
    /// repeats characters nor has a palette.
    #[inline]
    fn pixel_state(&self, y: u16) -> Option<PixelState> {
        let Position { x, y: row } = self.cursor()?;
        let colors = self.style?.plain_colors()?;
        let is_sound = colors.into_iter().all(Shade::is_rgb)
            && row == y
            && !self.repeats
            && self.repeated == 0
            && !self.palette.is_on()
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

    /// Adds a cell of pixels where the cursor is, and returns the colours after it.
    #[inline]
    fn push_pixels(&mut self, shape: Shape, pixels: [Shade; 2], current: [Shade; 2]) -> [Shade; 2] {
        let (element, colors) = block_element::cheapest_after(current, pixels);
        let mut piece = self.frame.piece();
        if colors != current {
            let mut rendition = ControlSequence::begin(&mut piece);
            Shade::push_change(colors, current, |shade| shade, &mut rendition);
            rendition.end(b'm');
        }
        let (encoded, count) =
            if shape == Shape::HALF { element.encoded() } else { shape.encoded(element) };
        piece.push(encoded, count);
        piece.finish();
        colors
    }
}
