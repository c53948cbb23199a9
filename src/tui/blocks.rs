//! Blocks: a cell shows two, four, six or eight pixels, each in one of two colours.
//!
//! [`split`] chooses the two colours of a cell and the pixels that have the first of them. Flat colours, such as the
//! colours of a map, become the nearest colours of the colour depth.
//!
//! In a small palette, each cell of a picture is a block in two palette colours or one of the shades ░ ▒ ▓, whichever
//! shows it better (see [`mixture`](crate::color::palette::mixture)).
//!
//! Without colour, a cell shows one of the densities ` ░▒▓█`, by its brightness and its contrast with the
//! surroundings, so that joints and edges show. A cell whose pixels differ is a block of lit and unlit pixels instead.
//! Things have an outline: their outermost pixels are lit, and the pixels next to them are unlit.
//!
//! Nothing depends on earlier frames, and patterns are fixed to the screen, so that a still picture stays still.
//!
//! Rejected: error diffusion. One changed pixel changes all pixels after it. Rejected without colour: measuring a
//! frame and stretching its range of brightness. One lamp that comes into view would change every cell. Rejected
//! without colour: lit and unlit pixels in a pattern (Bayer's matrix). Joints, and even a guard, are lost among its
//! dots.

mod split;

use std::{array, iter};

use ratatui::layout::Rect;
use ratatui::style::Color;

use self::split::{Split, Splits};
use super::canvas::{Canvas, Mosaic, SHADES, draw_characters};
use super::correction::{Edge, local_contrast, outline, raised};
use super::glyphs::{GlyphSet, color_at};
use crate::color::Rgb;
use crate::color::palette::mixture::{CellMixture, Mixer, WHOLE};
use crate::color::palette::{ColorDepth, ShadeInk};
use crate::render::{Frame, Surface};

/// Draws the pixels of `frame` on `area`. The first `above` rows of pixels are above its top edge. `surface` is used
/// only without colours.
pub(crate) fn draw_frame(
    area: Rect,
    canvas: &mut impl Canvas,
    glyphs: GlyphSet,
    colors: (ColorDepth, ShadeInk),
    above: u32,
    frame: &Frame,
    surface: impl Fn(u32, u32) -> Option<Surface>,
) {
    let draw = match glyphs {
        GlyphSet::Octant => draw_frame_of::<8, _, _>,
        GlyphSet::Sextant => draw_frame_of::<6, _, _>,
        GlyphSet::Quadrant => draw_frame_of::<4, _, _>,
        _ => draw_frame_of::<2, _, _>,
    };
    draw(area, canvas, colors, above, frame, surface);
}

/// Does the same as [`draw_frame`], with `PIXELS` pixels in each cell.
fn draw_frame_of<const PIXELS: usize, C: Canvas, S: Fn(u32, u32) -> Option<Surface>>(
    area: Rect,
    canvas: &mut C,
    (depth, ink): (ColorDepth, ShadeInk),
    above: u32,
    frame: &Frame,
    surface: S,
) {
    match depth {
        ColorDepth::True => draw_cells::<PIXELS, _, _>(area, canvas, depth, |y| {
            let row = frame.row_slice(above + y);
            move |x| row[x as usize]
        }),
        ColorDepth::Indexed256 | ColorDepth::Indexed16 => {
            draw_mixed::<PIXELS>(area, canvas, (depth, ink), above, frame);
        }
        ColorDepth::Mono => draw_mono::<PIXELS>(area, canvas, above, frame, surface),
    }
}

/// Draws the pixels of each cell of `area` as `glyphs`, in the nearest colours of `depth`. `row(y)` returns a row of
/// pixels, as a function of the column.
pub(crate) fn draw<Row: Fn(u32) -> Rgb>(
    area: Rect,
    canvas: &mut impl Canvas,
    glyphs: GlyphSet,
    depth: ColorDepth,
    row: impl Fn(u32) -> Row,
) {
    match glyphs {
        GlyphSet::Octant => draw_cells::<8, _, _>(area, canvas, depth, row),
        GlyphSet::Sextant => draw_cells::<6, _, _>(area, canvas, depth, row),
        GlyphSet::Quadrant => draw_cells::<4, _, _>(area, canvas, depth, row),
        _ => draw_cells::<2, _, _>(area, canvas, depth, row),
    }
}

fn draw_cells<const PIXELS: usize, C: Canvas, Row: Fn(u32) -> Rgb>(
    area: Rect,
    canvas: &mut C,
    depth: ColorDepth,
    row: impl Fn(u32) -> Row,
) {
    let [columns, rows] = pixels_per_cell::<PIXELS>();
    for (top, y) in (0..).step_by(rows as usize).zip(area.top()..area.bottom()) {
        if PIXELS == 2 && depth == ColorDepth::True {
            // These are most cells of most pictures, and need no search.
            let [upper, lower] = [row(top), row(top + 1)];
            let pixels = (0..u32::from(area.width)).map(|x| [upper(x), lower(x)]);
            canvas.draw_pixels(area.x, y, pixels);
            continue;
        }
        // Each row occurs once for each of its pixels in a cell.
        let pixel_rows: [Row; PIXELS] = array::from_fn(|pixel| row(top + pixel as u32 / columns));
        let pixel = |x: u32, place: usize| pixel_rows[place](columns * x + place as u32 % columns);
        let cells = Splits::of_row::<PIXELS>(area.width, pixel).map(|Split { mask, colors }| {
            (Mosaic::of_dots(PIXELS, mask), colors.map(|color| color_at(depth, color)))
        });
        canvas.draw_mosaics(area.x, y, cells);
    }
}

/// Draws the pixels of `frame` as [`draw_frame`] does in a small palette.
fn draw_mixed<const PIXELS: usize>(
    area: Rect,
    canvas: &mut impl Canvas,
    (depth, ink): (ColorDepth, ShadeInk),
    above: u32,
    frame: &Frame,
) {
    let [columns, rows] = pixels_per_cell::<PIXELS>();
    let pixel = |x, y| match depth {
        // In 16 colours, the shades of a dark wall would otherwise all look the same.
        ColorDepth::Indexed16 => {
            raised(frame.pixel(x, y), contrast(frame, [x, y], [columns, rows]))
        }
        _ => frame.pixel(x, y),
    };
    for (top, y) in (above..).step_by(rows as usize).zip(area.top()..area.bottom()) {
        let mut mixer = Mixer::new(depth, ink);
        let splits = Splits::of_row::<PIXELS>(area.width, |x, place| {
            let place = place as u32;
            pixel(columns * x + place % columns, top + place / columns)
        });
        for (Split { mask, colors }, x) in splits.zip(area.left()..area.right()) {
            let share = mask.count_ones() as u8 * (WHOLE / PIXELS as u8);
            match mixer.look(colors, share) {
                CellMixture::Parts(parts) => {
                    let cell = (Mosaic::of_dots(PIXELS, mask), parts.map(Color::Indexed));
                    canvas.draw_mosaics(x, y, iter::once(cell));
                }
                CellMixture::Shade(quarters, colors) => {
                    let shade = SHADES[usize::from(quarters - 1)];
                    canvas.draw_character(x, y, shade, colors.map(Color::Indexed));
                }
            }
        }
    }
}

/// Draws the pixels of `frame` as [`draw_frame`] does without colour.
fn draw_mono<const PIXELS: usize>(
    area: Rect,
    canvas: &mut impl Canvas,
    above: u32,
    frame: &Frame,
    surface: impl Fn(u32, u32) -> Option<Surface>,
) {
    let [columns, rows] = pixels_per_cell::<PIXELS>();
    draw_characters(area, canvas, |column, row| {
        let pixels: [MonoPixel; PIXELS] = array::from_fn(|pixel| {
            let pixel = pixel as u32;
            let [x, y] = [columns * column + pixel % columns, above + rows * row + pixel / columns];
            let contrast = contrast(frame, [x, y], [columns, rows]);
            let edge = outline(frame.size(), &surface, x, y);
            MonoPixel {
                brightness: i32::from(frame.pixel(x, y).luma()) + contrast * 3 / 2,
                outline: edge.map(|edge| edge == Edge::Inner),
            }
        });
        (mono_character(&pixels), [Color::Reset; 2])
    });
}

/// A pixel of a picture without colour.
#[derive(Clone, Copy)]
struct MonoPixel {
    /// The brightness, raised or lowered by the contrast with the pixels around it.
    brightness: i32,
    /// `true` if the pixel is lit, `false` if it is unlit. `None` if it is not part of an outline.
    outline: Option<bool>,
}

/// The character for the pixels of a cell.
fn mono_character<const PIXELS: usize>(pixels: &[MonoPixel; PIXELS]) -> char {
    /// The brightness below which a cell is blank, and from which on it is full.
    const DARKEST: i32 = 8;
    const BRIGHTEST: i32 = 180;
    let all = || pixels.iter().map(|pixel| pixel.brightness);
    let mean = all().sum::<i32>() / PIXELS as i32;
    let spread = all().max().unwrap_or(0) - all().min().unwrap_or(0);
    let has_outline = pixels.iter().any(|pixel| pixel.outline.is_some());
    if has_outline || spread > 14 + mean.max(0) / 4 {
        let lit = pixels.iter().map(|pixel| pixel.outline.unwrap_or(pixel.brightness > mean));
        return Mosaic::of_dots(PIXELS, mask(lit)).character();
    }
    let [light, medium, dark] = SHADES;
    let densities = [' ', light, medium, dark, '█'];
    let step = (BRIGHTEST - DARKEST) / densities.len() as i32;
    densities[((mean - DARKEST) / step).clamp(0, densities.len() as i32 - 1) as usize]
}

/// The contrast of a pixel of `frame` with the pixels around it, in steps of luma.
fn contrast(frame: &Frame, place: [u32; 2], pixels_per_cell: [u32; 2]) -> i32 {
    let luma = |x, y| frame.pixel(x, y).luma();
    local_contrast([frame.width(), frame.height()], luma, place, pixels_per_cell)
}

/// The mosaic of `glyphs` with these dots, row by row.
pub(crate) fn lit(glyphs: GlyphSet, dots: impl Iterator<Item = bool>) -> Mosaic {
    let [columns, rows] = glyphs.pixels_per_cell();
    Mosaic::of_dots((columns * rows) as usize, mask(dots))
}

/// The numbers of columns and rows of pixels in a cell of `PIXELS` pixels.
const fn pixels_per_cell<const PIXELS: usize>() -> [u32; 2] {
    if PIXELS == 2 { [1, 2] } else { [2, PIXELS as u32 / 2] }
}

/// The mask with these bits, from the lowest on.
fn mask(bits: impl Iterator<Item = bool>) -> u8 {
    (0..).zip(bits).fold(0, |mask, (place, bit)| mask | u8::from(bit) << place)
}
