//! Glyph sets finer than half blocks: each cell shows several pixels by dots in two colours.
//!
//! The picture has a pixel for each dot. [`split`] chooses which dots of a cell have the one colour and which
//! the other. In a palette, both colours become the nearest ones; without colour, each pixel is lit by its
//! brightness alone.

pub(crate) mod split;

use std::array;

use ratatui::layout::Rect;
use ratatui::style::Color;

use self::split::Split;
use super::glyphs::color_at;
use super::{GlyphSet, half_blocks};
use crate::canvas::{Canvas, Mosaic};
use crate::color::Rgb;
use crate::color::palette::ColorDepth;

/// Draws the pixels of each cell of `area` as `glyphs`. `row(y)` is a row of pixels, as a function of the column.
pub(super) fn draw<Row: Fn(u32) -> Rgb>(
    area: Rect,
    canvas: &mut impl Canvas,
    glyphs: GlyphSet,
    depth: ColorDepth,
    row: impl Fn(u32) -> Row,
) {
    match glyphs {
        GlyphSet::Octant => draw_cells::<8, _>(area, canvas, depth, Mosaic::octants, row),
        GlyphSet::Sextant => draw_cells::<6, _>(area, canvas, depth, Mosaic::sextants, row),
        _ => draw_cells::<4, _>(area, canvas, depth, Mosaic::quadrants, row),
    }
}

/// Draws `PIXELS` pixels in each cell, in two columns.
fn draw_cells<const PIXELS: usize, Row: Fn(u32) -> Rgb>(
    area: Rect,
    canvas: &mut impl Canvas,
    depth: ColorDepth,
    mosaic: fn(u8) -> Mosaic,
    row: impl Fn(u32) -> Row,
) {
    for (top, y) in (0..).step_by(PIXELS / 2).zip(area.top()..area.bottom()) {
        // Each row is there twice: for the left and for the right pixel of a cell.
        let rows: [Row; PIXELS] = array::from_fn(|pixel| row(top + pixel as u32 / 2));
        let pixels = |x: u32| array::from_fn(|pixel| rows[pixel](2 * x + pixel as u32 % 2));
        let columns = 0..u32::from(area.width);
        if depth == ColorDepth::Mono {
            for x in columns {
                let lit = (0..).zip(pixels(x)).map(|(pixel, color): (u32, Rgb)| {
                    half_blocks::is_lit(color, 2 * x + pixel % 2, top + pixel / 2)
                });
                let character = mosaic(mask(lit)).character();
                canvas.draw_character(area.x + x as u16, y, character, [Color::Reset; 2]);
            }
            continue;
        }
        let cells = columns.map(|x| {
            let Split { mask, colors } = Split::of::<PIXELS>(&pixels(x));
            (mosaic(mask), colors.map(|color| color_at(depth, color)))
        });
        canvas.draw_mosaics(area.x, y, cells);
    }
}

/// The mosaic of `glyphs` with these dots, row by row.
pub(super) fn lit(glyphs: GlyphSet, dots: impl Iterator<Item = bool>) -> Mosaic {
    let mask = mask(dots);
    match glyphs {
        GlyphSet::Octant => Mosaic::octants(mask),
        GlyphSet::Sextant => Mosaic::sextants(mask),
        _ => Mosaic::quadrants(mask),
    }
}

/// The mask with these bits, from the lowest on.
fn mask(bits: impl Iterator<Item = bool>) -> u8 {
    (0..).zip(bits).fold(0, |mask, (place, bit)| mask | u8::from(bit) << place)
}
