//! Blocks and shades without colour.
//!
//! A cell has one of the densities of ` ░▒▓█` for its brightness and for its contrast with the
//! surroundings, so that joints and edges show. A cell whose pixels differ is a block of lit and unlit
//! pixels instead. Rejected: measuring a frame and stretching its range of brightness, since one lamp
//! that comes into view would change every cell. Rejected: lit and unlit pixels in a pattern (Bayer's
//! matrix), whose dots hide joints, and a guard among them.
//!
//! Things have an outline: their outermost pixels are lit, and the pixels next to them are unlit.

use std::array;

use ratatui::layout::Rect;
use ratatui::style::Color;

use super::mixed::SHADES;
use super::{mask, mosaic, pixels_per_cell};
use crate::render::{Frame, Surface};
use crate::tui::canvas::Canvas;
use crate::tui::correction::local_contrast;
use crate::tui::outline::{Edge, outline};

/// Draws the pixels of `frame` as [`super::draw_frame`] does, `PIXELS` in each cell.
pub(crate) fn draw<const PIXELS: usize>(
    area: Rect,
    canvas: &mut impl Canvas,
    above: u32,
    frame: &Frame,
    surface: impl Fn(u32, u32) -> Option<Surface>,
) {
    let [columns, rows] = pixels_per_cell::<PIXELS>();
    for (top, y) in (above..).step_by(rows as usize).zip(area.top()..area.bottom()) {
        for (left, x) in (0..).step_by(columns as usize).zip(area.left()..area.right()) {
            let place = |pixel: u32| [left + pixel % columns, top + pixel / columns];
            let pixels: [Pixel; PIXELS] = array::from_fn(|pixel| {
                let [x, y] = place(pixel as u32);
                let edge = outline(frame.size(), &surface, x, y);
                Pixel {
                    brightness: brightness(frame, x, y, [columns, rows]),
                    outline: edge.map(|edge| edge == Edge::Inner),
                }
            });
            canvas.draw_character(x, y, character(&pixels), [Color::Reset; 2]);
        }
    }
}

#[derive(Clone, Copy)]
struct Pixel {
    brightness: i32,
    /// Whether it is lit, if it is part of an outline.
    outline: Option<bool>,
}

/// The brightness of a pixel, raised or lowered by its contrast with those around it.
fn brightness(frame: &Frame, x: u32, y: u32, pixels_per_cell: [u32; 2]) -> i32 {
    let luma = |x, y| frame.pixel(x, y).luma();
    let size = [frame.width(), frame.height()];
    let contrast = local_contrast(size, luma, [x, y], pixels_per_cell);
    i32::from(luma(x, y)) + contrast * 3 / 2
}

/// The character for the pixels of a cell.
fn character<const PIXELS: usize>(pixels: &[Pixel; PIXELS]) -> char {
    /// The brightness below which a cell is blank, and from which on it is full.
    const DARKEST: i32 = 8;
    const BRIGHTEST: i32 = 180;
    let all = || pixels.iter().map(|pixel| pixel.brightness);
    let mean = all().sum::<i32>() / PIXELS as i32;
    let spread = all().max().unwrap_or(0) - all().min().unwrap_or(0);
    let has_outline = pixels.iter().any(|pixel| pixel.outline.is_some());
    if has_outline || spread > 14 + mean.max(0) / 4 {
        let lit = pixels.iter().map(|pixel| pixel.outline.unwrap_or(pixel.brightness > mean));
        return mosaic::<PIXELS>(mask(lit)).character();
    }
    let [light, medium, dark] = SHADES;
    let densities = [' ', light, medium, dark, '█'];
    let step = (BRIGHTEST - DARKEST) / densities.len() as i32;
    densities[((mean - DARKEST) / step).clamp(0, densities.len() as i32 - 1) as usize]
}
