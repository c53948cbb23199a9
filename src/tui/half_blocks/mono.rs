//! Half blocks and shades without colour.
//!
//! A cell has one of the densities of ` ░▒▓█` for its brightness and for its contrast with the
//! surroundings, so that joints and edges show. A cell whose halves differ is a half block instead.
//! Measuring a frame and stretching its range of brightness was rejected: one lamp that comes into
//! view would change every cell. Rejected: lit and unlit pixels in a pattern (Bayer's matrix), whose
//! dots hide joints, and a guard among them.
//!
//! Things have an outline: their outermost pixels are lit, and the pixels next to them are unlit.

use ratatui::layout::Rect;
use ratatui::style::Color;

use super::mixed::SHADES;
use super::{lit_glyph, local_contrast};
use crate::canvas::Canvas;
use crate::render::{Frame, Surface};
use crate::tui::outline::{Edge, outline};

/// Draws the pixels of `frame` as [`super::draw_frame`] does.
pub(super) fn draw(
    area: Rect,
    canvas: &mut impl Canvas,
    above: u32,
    frame: &Frame,
    surface: impl Fn(u32, u32) -> Option<Surface>,
) {
    let edge = |x, y| outline(frame.size(), &surface, x, y);
    for (y, upper) in (area.top()..area.bottom()).zip((above..).step_by(2)) {
        for (x, column) in (0..).zip(area.left()..area.right()) {
            let rows = [upper, upper + 1];
            let glyph = glyph(
                rows.map(|y| brightness(frame, x, y)),
                rows.map(|y| edge(x, y).map(|edge| edge == Edge::Inner)),
            );
            canvas.draw_character(column, y, glyph, [Color::Reset; 2]);
        }
    }
}

/// The brightness of a pixel, raised or lowered by its contrast with those around it.
fn brightness(frame: &Frame, x: u32, y: u32) -> i32 {
    let luma = i32::from(frame.pixel(x.min(frame.width() - 1), y.min(frame.height() - 1)).luma());
    luma + local_contrast(frame, x, y) * 3 / 2
}

/// The character for the brightness of two halves, of which outlines may be lit or unlit.
fn glyph(halves: [i32; 2], outlines: [Option<bool>; 2]) -> char {
    /// The brightness below which a cell is blank, and from which on it is full.
    const DARKEST: i32 = 8;
    const BRIGHTEST: i32 = 180;
    let mean = (halves[0] + halves[1]) / 2;
    let differ = (halves[0] - halves[1]).abs() > 14 + mean.max(0) / 4;
    if differ || outlines != [None; 2] {
        let lit = [0, 1].map(|half| outlines[half].unwrap_or(halves[half] > mean));
        return lit_glyph(lit[0], lit[1]);
    }
    let [light, medium, dark] = SHADES;
    let densities = [' ', light, medium, dark, '█'];
    let step = (BRIGHTEST - DARKEST) / densities.len() as i32;
    densities[((mean - DARKEST) / step).clamp(0, densities.len() as i32 - 1) as usize]
}
