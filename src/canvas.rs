//! The canvas: cells that pictures and widgets are drawn on.
//!
//! Ratatui's [`Buffer`] is a canvas, so that what this crate draws are ordinary widgets. The screen of
//! our own encoder is the other: what is drawn there never becomes ratatui's cells, of forty bytes and
//! a text each, that are blanked, filled, compared and taken apart again, which was half the time of a
//! frame of the game.
//!
//! A third kind of cell between the two, that both are made from, was refused: it would be one more
//! copy of each picture for everybody.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::widgets::{Clear, Widget};

use crate::color::Rgb;

/// Cells that one draws on; places off it take nothing.
pub trait Canvas {
    /// The cells that there are.
    fn bounds(&self) -> Rect;

    /// Shows two colours in each of the cells from `(x, y)` to the right, the first above the second.
    fn draw_halves(&mut self, x: u16, y: u16, row: impl Iterator<Item = [Color; 2]>);

    /// As [`Canvas::draw_halves`], in true colour: most cells of most pictures.
    #[inline]
    fn draw_pixels(&mut self, x: u16, y: u16, row: impl Iterator<Item = [Rgb; 2]>) {
        self.draw_halves(x, y, row.map(|halves| halves.map(true_color)));
    }

    /// Shows a character that is one cell wide, in the colours of its text and of its ground.
    fn draw_character(&mut self, x: u16, y: u16, character: char, colors: [Color; 2]);

    /// Shows a widget, on blank ground.
    fn draw_widget(&mut self, widget: impl Widget, area: Rect);
}

impl Canvas for Buffer {
    fn bounds(&self) -> Rect {
        self.area
    }

    /// Of the glyphs that show the same two colours, the one is taken that shares more colours with
    /// the cell before it: most encoders need not send those again. Two colours alike are a space.
    fn draw_halves(&mut self, x: u16, y: u16, row: impl Iterator<Item = [Color; 2]>) {
        let mut before = [Color::Reset; 2];
        for (x, [top, bottom]) in (x..self.area.right()).zip(row) {
            let (glyph, colors) = likest_glyph([top, bottom], before);
            self.draw_character(x, y, glyph, colors);
            before = colors;
        }
    }

    fn draw_character(&mut self, x: u16, y: u16, character: char, [text, ground]: [Color; 2]) {
        if let Some(cell) = self.cell_mut((x, y)) {
            cell.reset();
            cell.set_char(character).set_fg(text).set_bg(ground);
        }
    }

    fn draw_widget(&mut self, widget: impl Widget, area: Rect) {
        let area = area.intersection(self.area);
        Clear.render(area, self);
        widget.render(area, self);
    }
}

/// `color`, as ratatui names it.
#[inline]
pub(crate) fn true_color(color: Rgb) -> Color {
    Color::Rgb(color.red(), color.green(), color.blue())
}

/// The glyph that shows two halves, and the colours of its text and ground, of which as many as
/// possible are those from `before`.
fn likest_glyph([top, bottom]: [Color; 2], before: [Color; 2]) -> (char, [Color; 2]) {
    let shared =
        |[text, ground]: [Color; 2]| u8::from(text == before[0]) + u8::from(ground == before[1]);
    if top == bottom {
        (' ', [top, top])
    } else if shared([bottom, top]) > shared([top, bottom]) {
        ('▄', [bottom, top])
    } else {
        ('▀', [top, bottom])
    }
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
