//! The canvas: cells that pictures and widgets are drawn on.
//!
//! Ratatui's [`Buffer`] is a canvas, so that this crate's pictures are ordinary widgets. The
//! encoder's own screen is the other canvas: it draws cells directly and never builds ratatui's
//! cells. Those take forty bytes and a string each, and clearing, filling, comparing and decoding
//! them took half the time of a frame of the game.
//!
//! An intermediate type of cell, from which both canvases are filled, was refused: it would be one
//! more copy of each picture.

mod mosaic;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::widgets::{Clear, Widget};

use crate::color::Rgb;
pub use mosaic::Mosaic;

/// Cells to draw on. Positions outside of the bounds are ignored.
pub trait Canvas {
    /// The area of the canvas, in cells.
    fn bounds(&self) -> Rect;

    /// Draws two colours in each cell from `(x, y)` to the right, the first above the second.
    fn draw_halves(&mut self, x: u16, y: u16, row: impl Iterator<Item = [Color; 2]>);

    /// Does the same as [`Canvas::draw_halves`] in true colour, which most cells of most pictures
    /// use.
    #[inline]
    fn draw_pixels(&mut self, x: u16, y: u16, row: impl Iterator<Item = [Rgb; 2]>) {
        self.draw_halves(x, y, row.map(|halves| halves.map(true_color)));
    }

    /// Draws a mosaic in each cell from `(x, y)` to the right, in the colours of its dots and of the rest.
    fn draw_mosaics(&mut self, x: u16, y: u16, row: impl Iterator<Item = (Mosaic, [Color; 2])>);

    /// Draws a character that is one cell wide, in a foreground and a background colour.
    fn draw_character(&mut self, x: u16, y: u16, character: char, colors: [Color; 2]);

    /// Clears `area` and draws a widget there.
    fn draw_widget(&mut self, widget: impl Widget, area: Rect);
}

impl Canvas for Buffer {
    fn bounds(&self) -> Rect {
        self.area
    }

    /// Two glyphs show the same two colours. Chooses the one that shares more colours with the cell
    /// to the left, since most encoders need not send those again. A cell of one colour is a space.
    fn draw_halves(&mut self, x: u16, y: u16, row: impl Iterator<Item = [Color; 2]>) {
        let mut before = [Color::Reset; 2];
        for (x, [top, bottom]) in (x..self.area.right()).zip(row) {
            let (glyph, colors) = glyph_sharing_most([top, bottom], before);
            self.draw_character(x, y, glyph, colors);
            before = colors;
        }
    }

    /// Chooses between a mosaic and its inverse as [`Canvas::draw_halves`] does.
    fn draw_mosaics(&mut self, x: u16, y: u16, row: impl Iterator<Item = (Mosaic, [Color; 2])>) {
        let mut before = [Color::Reset; 2];
        for (x, (mosaic, [dots, rest])) in (x..self.area.right()).zip(row) {
            let (mosaic, colors) = if dots == rest {
                (Mosaic::NONE, [dots; 2])
            } else if shared([rest, dots], before) > shared([dots, rest], before) {
                (mosaic.inverse(), [rest, dots])
            } else {
                (mosaic, [dots, rest])
            };
            self.draw_character(x, y, mosaic.character(), colors);
            before = colors;
        }
    }

    fn draw_character(
        &mut self,
        x: u16,
        y: u16,
        character: char,
        [foreground, background]: [Color; 2],
    ) {
        if let Some(cell) = self.cell_mut((x, y)) {
            cell.reset();
            cell.set_char(character).set_fg(foreground).set_bg(background);
        }
    }

    fn draw_widget(&mut self, widget: impl Widget, area: Rect) {
        let area = area.intersection(self.area);
        Clear.render(area, self);
        widget.render(area, self);
    }
}

/// `color` as a ratatui colour.
#[inline]
pub(crate) fn true_color(color: Rgb) -> Color {
    Color::Rgb(color.red(), color.green(), color.blue())
}

/// The glyph that shows two halves, and its foreground and background colours. Shares as many
/// colours as possible with `before`.
fn glyph_sharing_most([top, bottom]: [Color; 2], before: [Color; 2]) -> (char, [Color; 2]) {
    if top == bottom {
        (' ', [top, top])
    } else if shared([bottom, top], before) > shared([top, bottom], before) {
        ('▄', [bottom, top])
    } else {
        ('▀', [top, bottom])
    }
}

/// The number of colours that two cells share.
fn shared(one: [Color; 2], other: [Color; 2]) -> u8 {
    u8::from(one[0] == other[0]) + u8::from(one[1] == other[1])
}

#[cfg(test)]
mod tests {
    use ratatui::buffer::Cell;

    use super::*;

    #[test]
    fn the_glyph_that_shares_colours_with_its_neighbour_is_taken() {
        let [a, b, c] = [1, 2, 3].map(|red| Color::Rgb(red, 0, 0));
        let mut buffer = Buffer::empty(Rect::new(0, 0, 4, 1));
        buffer.draw_halves(0, 0, [[a, b], [b, a], [c, b], [c, c], [a, a]].into_iter());
        let symbols: String = buffer.content().iter().map(Cell::symbol).collect();
        assert_eq!(symbols, "▀▄▀ ");
        let second = &buffer.content()[1];
        assert_eq!((second.fg, second.bg), (a, b));
    }
}
