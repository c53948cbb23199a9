//! Half blocks: a cell shows two pixels, one in the colour of its text, one in that of its ground.
//!
//! Of the glyphs that show the same two pixels, the one is taken that shares more colours with the
//! cell before it, because those need not be sent again. Two pixels alike are a space.
//!
//! Without colour a pixel is lit or it is not; which one is decided by comparing its brightness with
//! a fixed 4×4 pattern of thresholds. With 16 colours the same pattern makes pixels lighter and
//! darker before the nearest colour is taken. So shades stay apart, and stand still while the picture
//! does. Error diffusion was refused: there, one changed pixel changes all that follow.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Color;

use super::glyphs::color_at;
use crate::palette::ColorDepth;
use crate::world::Rgb;

const UPPER: char = '▀';
const LOWER: char = '▄';
const FULL: char = '█';
const EMPTY: char = ' ';

/// Draws the pixels of `area`, twice as many as cells from top to bottom: `pixel(x, y)` counts from
/// its left edge and from `above` pixels over its top edge.
pub(super) fn draw(
    area: Rect,
    buffer: &mut Buffer,
    depth: ColorDepth,
    above: u32,
    pixel: impl Fn(u32, u32) -> Rgb,
) {
    let glyph_at = |x: u32, row: u32, before: &Glyph| {
        let upper = above + 2 * row;
        let lower = upper + 1;
        let (top, bottom) = (pixel(x, upper), pixel(x, lower));
        match depth {
            ColorDepth::Mono => Glyph::lit(is_lit(top, x, upper), is_lit(bottom, x, lower)),
            ColorDepth::Indexed16 => {
                let (top, bottom) = (dithered(top, x, upper), dithered(bottom, x, lower));
                Glyph::colored(color_at(depth, top), color_at(depth, bottom), before)
            }
            ColorDepth::True | ColorDepth::Indexed256 => {
                Glyph::colored(color_at(depth, top), color_at(depth, bottom), before)
            }
        }
    };
    for (row, y) in (0u32..).zip(area.top()..area.bottom()) {
        let mut glyph = Glyph { character: EMPTY, text: Color::Reset, ground: Color::Reset };
        for (column, x) in (0u32..).zip(area.left()..area.right()) {
            glyph = glyph_at(column, row, &glyph);
            let cell = &mut buffer[(x, y)];
            cell.reset();
            cell.set_char(glyph.character).set_fg(glyph.text).set_bg(glyph.ground);
        }
    }
}

struct Glyph {
    character: char,
    text: Color,
    ground: Color,
}

impl Glyph {
    fn colored(top: Color, bottom: Color, before: &Self) -> Self {
        let shared = |text: Color, ground: Color| {
            u8::from(text == before.text) + u8::from(ground == before.ground)
        };
        if top == bottom {
            Self { character: EMPTY, text: top, ground: top }
        } else if shared(bottom, top) > shared(top, bottom) {
            Self { character: LOWER, text: bottom, ground: top }
        } else {
            Self { character: UPPER, text: top, ground: bottom }
        }
    }

    fn lit(top: bool, bottom: bool) -> Self {
        let character = match (top, bottom) {
            (true, true) => FULL,
            (true, false) => UPPER,
            (false, true) => LOWER,
            (false, false) => EMPTY,
        };
        Self { character, text: Color::Reset, ground: Color::Reset }
    }
}

/// Bayer's ordered dither: every 2×2 part of it has two of the lower and two of the upper half.
const ORDER: [[u8; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];

/// The place of a pixel in that order, from 0 to 15.
fn order(x: u32, y: u32) -> u8 {
    ORDER[(y % 4) as usize][(x % 4) as usize]
}

/// Whether a pixel of that colour is lit at that place.
fn is_lit(color: Rgb, x: u32, y: u32) -> bool {
    color.luma() >= 16 * order(x, y) + 8
}

/// `color` made lighter or darker, by less than the named colours differ.
fn dithered(color: Rgb, x: u32, y: u32) -> Rgb {
    const STRENGTH: i16 = 2;
    let offset = STRENGTH * (2 * i16::from(order(x, y)) - 15);
    let [red, green, blue] =
        color.channels().map(|channel| (i16::from(channel) + offset).clamp(0, 255) as u8);
    Rgb::new(red, green, blue)
}

#[cfg(test)]
mod tests {
    use ratatui::buffer::Cell;

    use super::*;

    fn drawn(depth: ColorDepth, rows: &[&[Rgb]]) -> Buffer {
        let area = Rect::new(0, 0, rows[0].len() as u16, rows.len() as u16 / 2);
        let mut buffer = Buffer::empty(area);
        draw(area, &mut buffer, depth, 0, |x, y| rows[y as usize][x as usize]);
        buffer
    }

    #[test]
    fn the_glyph_that_shares_colours_with_its_neighbour_is_taken() {
        let (a, b, c) = (Rgb::new(1, 0, 0), Rgb::new(2, 0, 0), Rgb::new(3, 0, 0));
        let buffer = drawn(ColorDepth::True, &[&[a, b, c, c], &[b, a, b, c]]);
        let symbols: String = buffer.content().iter().map(Cell::symbol).collect();
        assert_eq!(symbols, "▀▄▀ ");
        let second = &buffer.content()[1];
        assert_eq!((second.fg, second.bg), (Color::Rgb(1, 0, 0), Color::Rgb(2, 0, 0)));
    }

    #[test]
    fn brightness_without_colour_is_how_many_pixels_are_lit() {
        let lit = |level| {
            let grey = Rgb::new(level, level, level);
            (0..16).filter(|index| is_lit(grey, index % 4, index / 4)).count()
        };
        assert_eq!((lit(0), lit(64), lit(128), lit(255)), (0, 4, 8, 16));
        let row = [Rgb::WHITE, Rgb::BLACK];
        let buffer = drawn(ColorDepth::Mono, &[&row, &[Rgb::BLACK, Rgb::BLACK]]);
        assert_eq!((buffer.content()[0].symbol(), buffer.content()[1].symbol()), ("▀", " "));
        assert_eq!(buffer.content()[0].fg, Color::Reset);
    }
}
