//! The half-block glyph set: a cell shows two pixels, one above the other.
//!
//! Frames in few colours are drawn by [`mixed`] and [`mono`], which consider several pixels at
//! once. Flat colours, such as those of a map, become the nearest colours; without colour, a fixed
//! 4×4 matrix of thresholds decides whether a pixel is lit. All patterns are fixed to the screen,
//! so that a still picture stays still. Error diffusion was refused: one changed pixel changes all
//! pixels after it.

mod mixed;
mod mono;

use ratatui::layout::Rect;
use ratatui::style::Color;

use super::glyphs::color_at;
use crate::canvas::Canvas;
use crate::color::Rgb;
use crate::color::palette::{ColorDepth, mixture};
use crate::render::{Frame, Surface};

/// Draws the pixels of `frame` on `area`. The first `above` rows of pixels are above its top edge.
/// `surface` is needed without colours only.
pub(super) fn draw_frame(
    area: Rect,
    canvas: &mut impl Canvas,
    depth: ColorDepth,
    above: u32,
    frame: &Frame,
    surface: impl Fn(u32, u32) -> Option<Surface>,
) {
    match depth {
        ColorDepth::Indexed256 => mixed::draw(area, canvas, &mixture::OF_256, above, frame),
        ColorDepth::Indexed16 => mixed::draw(area, canvas, &mixture::OF_16, above, frame),
        ColorDepth::True => draw(area, canvas, depth, above, |y| frame.row(y)),
        ColorDepth::Mono => mono::draw(area, canvas, above, frame, surface),
    }
}

/// Draws two pixels in each cell of `area`. `row(y)` is a row of pixels from the left edge; the
/// first `above` rows are above the top edge.
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

/// The character whose halves are lit or unlit.
pub(super) fn lit_glyph(top: bool, bottom: bool) -> char {
    match (top, bottom) {
        (true, true) => '█',
        (true, false) => '▀',
        (false, true) => '▄',
        (false, false) => ' ',
    }
}

/// The threshold matrix of ordered dither. In each 2×2 part of it, two thresholds are in the lower
/// half of the range and two in the upper.
///
/// Source: B. E. Bayer, "An Optimum Method for Two-Level Rendition of Continuous-Tone Pictures"
/// (1973).
const THRESHOLDS: [[u8; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];

/// The rank of a pixel's threshold, from 0 to 15.
fn threshold_rank(x: u32, y: u32) -> u8 {
    THRESHOLDS[(y % 4) as usize][(x % 4) as usize]
}

/// Whether a pixel with that colour and position is lit.
pub(super) fn is_lit(color: Rgb, x: u32, y: u32) -> bool {
    color.luma() >= 16 * threshold_rank(x, y) + 8
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
    fn brightness_without_colour_is_the_share_of_lit_pixels() {
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
