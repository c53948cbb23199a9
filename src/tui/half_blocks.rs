//! Half blocks: a cell shows two pixels, one above the other.
//!
//! A picture in few colours is drawn as a picture: [`mixed`] and [`mono`] look at more than one pixel. What is
//! drawn in flat colours, such as a map, shows the nearest ones; without colour a pixel of it is lit or not by a
//! fixed 4×4 pattern of thresholds. All patterns stand still while the picture does. Error diffusion was
//! refused: there, one changed pixel changes all that follow.

mod mixed;
mod mono;

use ratatui::layout::Rect;
use ratatui::style::Color;

use super::glyphs::color_at;
use crate::canvas::Canvas;
use crate::color::Rgb;
use crate::color::palette::{ColorDepth, mixture};
use crate::render::Frame;

/// Draws the pixels of `frame` on `area`, from `above` pixels under its top edge on.
pub(super) fn draw_frame(
    area: Rect,
    canvas: &mut impl Canvas,
    depth: ColorDepth,
    above: u32,
    frame: &Frame,
) {
    match depth {
        ColorDepth::Indexed256 => mixed::draw(area, canvas, &mixture::OF_256, above, frame),
        ColorDepth::Indexed16 => mixed::draw(area, canvas, &mixture::OF_16, above, frame),
        ColorDepth::True => draw(area, canvas, depth, above, |y| frame.row(y)),
        ColorDepth::Mono => mono::draw(area, canvas, above, frame),
    }
}

/// Draws the pixels of `area`, twice as many as cells from top to bottom: `row(y)` is a row of them from
/// the left edge on, and counts from `above` pixels over the top edge.
pub(super) fn draw<Row: Iterator<Item = Rgb>>(
    area: Rect,
    canvas: &mut impl Canvas,
    depth: ColorDepth,
    above: u32,
    row: impl Fn(u32) -> Row,
) {
    for (y, upper) in (area.top()..area.bottom()).zip((above..).step_by(2)) {
        let lower = upper + 1;
        let pixels = (0..u32::from(area.width)).zip(row(upper).zip(row(lower)));
        match depth {
            ColorDepth::True => {
                canvas.draw_pixels(area.x, y, pixels.map(|(_, (top, bottom))| [top, bottom]));
            }
            ColorDepth::Indexed256 | ColorDepth::Indexed16 => {
                let color = |pixel| color_at(depth, pixel);
                let colors = pixels.map(|(_, (top, bottom))| [color(top), color(bottom)]);
                canvas.draw_halves(area.x, y, colors);
            }
            ColorDepth::Mono => {
                for (x, (top, bottom)) in pixels {
                    let glyph = lit_glyph(is_lit(top, x, upper), is_lit(bottom, x, lower));
                    canvas.draw_character(area.x + x as u16, y, glyph, [Color::Reset; 2]);
                }
            }
        }
    }
}

/// The character whose halves are lit or not.
pub(super) fn lit_glyph(top: bool, bottom: bool) -> char {
    match (top, bottom) {
        (true, true) => '█',
        (true, false) => '▀',
        (false, true) => '▄',
        (false, false) => ' ',
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

#[cfg(test)]
mod tests {
    use ratatui::buffer::Buffer;

    use super::*;

    fn drawn(depth: ColorDepth, rows: &[&[Rgb]]) -> Buffer {
        let area = Rect::new(0, 0, rows[0].len() as u16, rows.len() as u16 / 2);
        let mut buffer = Buffer::empty(area);
        draw(area, &mut buffer, depth, 0, |y| rows[y as usize].iter().copied());
        buffer
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
