//! Blocks: a cell shows two, four, six or eight pixels, each in one of two colours.
//!
//! [`split`] chooses the two colours of a cell and the pixels that have the first of them. In a small
//! palette a cell may be a shade instead ([`mixed`]), and so it may without colour ([`mono`]). Flat
//! colours, such as those of a map, become the nearest colours.
//!
//! Nothing depends on earlier frames, and patterns are fixed to the screen, so that a still picture
//! stays still. Rejected: error diffusion, since one changed pixel changes all pixels after it.

mod mixed;
mod mono;
pub(crate) mod split;

use std::array;

use ratatui::layout::Rect;

use self::split::{Split, Splits};
use super::GlyphSet;
use super::glyphs::color_at;
use crate::color::Rgb;
use crate::color::palette::{ColorDepth, ShadeInk};
use crate::render::{Frame, Surface};
use crate::tui::canvas::{Canvas, Mosaic};

/// Draws the pixels of `frame` on `area`. The first `above` rows of pixels are above its top edge.
/// `surface` is needed without colours only.
pub(crate) fn draw_frame(
    area: Rect,
    canvas: &mut impl Canvas,
    glyphs: GlyphSet,
    (depth, ink): (ColorDepth, ShadeInk),
    above: u32,
    frame: &Frame,
    surface: impl Fn(u32, u32) -> Option<Surface>,
) {
    match depth {
        ColorDepth::True => draw(area, canvas, glyphs, depth, |y| {
            let row = frame.row_slice(above + y);
            move |x| row[x as usize]
        }),
        ColorDepth::Indexed256 | ColorDepth::Indexed16 => {
            let draw = match glyphs {
                GlyphSet::Octant => mixed::draw::<8, _>,
                GlyphSet::Sextant => mixed::draw::<6, _>,
                GlyphSet::Quadrant => mixed::draw::<4, _>,
                _ => mixed::draw::<2, _>,
            };
            draw(area, canvas, (depth, ink), above, frame);
        }
        ColorDepth::Mono => match glyphs {
            GlyphSet::Octant => mono::draw::<8>(area, canvas, above, frame, surface),
            GlyphSet::Sextant => mono::draw::<6>(area, canvas, above, frame, surface),
            GlyphSet::Quadrant => mono::draw::<4>(area, canvas, above, frame, surface),
            _ => mono::draw::<2>(area, canvas, above, frame, surface),
        },
    }
}

/// Draws the pixels of each cell of `area` as `glyphs`, in the nearest colours of `depth`. `row(y)` is a
/// row of pixels, as a function of the column.
pub(crate) fn draw<Row: Fn(u32) -> Rgb>(
    area: Rect,
    canvas: &mut impl Canvas,
    glyphs: GlyphSet,
    depth: ColorDepth,
    row: impl Fn(u32) -> Row,
) {
    match glyphs {
        // Most cells of most pictures, which need no search.
        GlyphSet::Half if depth == ColorDepth::True => {
            for (y, upper) in (area.top()..area.bottom()).zip((0..).step_by(2)) {
                let [upper, lower] = [row(upper), row(upper + 1)];
                let pixels = (0..u32::from(area.width)).map(|x| [upper(x), lower(x)]);
                canvas.draw_pixels(area.x, y, pixels);
            }
        }
        GlyphSet::Octant => draw_cells::<8, _>(area, canvas, depth, row),
        GlyphSet::Sextant => draw_cells::<6, _>(area, canvas, depth, row),
        GlyphSet::Quadrant => draw_cells::<4, _>(area, canvas, depth, row),
        _ => draw_cells::<2, _>(area, canvas, depth, row),
    }
}

fn draw_cells<const PIXELS: usize, Row: Fn(u32) -> Rgb>(
    area: Rect,
    canvas: &mut impl Canvas,
    depth: ColorDepth,
    row: impl Fn(u32) -> Row,
) {
    let [columns, rows] = pixels_per_cell::<PIXELS>();
    for (top, y) in (0..).step_by(rows as usize).zip(area.top()..area.bottom()) {
        // A row is there once for each of its pixels in a cell.
        let pixel_rows: [Row; PIXELS] = array::from_fn(|pixel| row(top + pixel as u32 / columns));
        let pixel = |x: u32, place: usize| pixel_rows[place](columns * x + place as u32 % columns);
        let cells = Splits::of_row::<PIXELS>(area.width, pixel).map(|Split { mask, colors }| {
            (mosaic::<PIXELS>(mask), colors.map(|color| color_at(depth, color)))
        });
        canvas.draw_mosaics(area.x, y, cells);
    }
}

/// The mosaic of `glyphs` with these dots, row by row.
pub(crate) fn lit(glyphs: GlyphSet, dots: impl Iterator<Item = bool>) -> Mosaic {
    let mask = mask(dots);
    match glyphs {
        GlyphSet::Octant => mosaic::<8>(mask),
        GlyphSet::Sextant => mosaic::<6>(mask),
        GlyphSet::Quadrant => mosaic::<4>(mask),
        _ => mosaic::<2>(mask),
    }
}

/// The columns and the rows of pixels in a cell of that number of them.
const fn pixels_per_cell<const PIXELS: usize>() -> [u32; 2] {
    if PIXELS == 2 { [1, 2] } else { [2, PIXELS as u32 / 2] }
}

/// The mosaic of that number of dots.
#[inline]
const fn mosaic<const DOTS: usize>(mask: u8) -> Mosaic {
    match DOTS {
        8 => Mosaic::octants(mask),
        6 => Mosaic::sextants(mask),
        4 => Mosaic::quadrants(mask),
        _ => Mosaic::halves(mask),
    }
}

/// The mask with these bits, from the lowest on.
fn mask(bits: impl Iterator<Item = bool>) -> u8 {
    (0..).zip(bits).fold(0, |mask, (place, bit)| mask | u8::from(bit) << place)
}
