//! Half blocks without colour: what differs from its surroundings is drawn before how bright it is.
//!
//! A pixel is lit where it is brighter than its place in Bayer's pattern asks for. Before that, its difference
//! from the pixels around it is made larger, so that joints and edges are lines, and dark rooms are drawn
//! brighter than they are. To measure a frame and spread its shades was refused: one lamp that comes into view would change
//! every cell.

use ratatui::layout::Rect;
use ratatui::style::Color;

use super::{lit_glyph, order};
use crate::render::Frame;
use crate::tui::Canvas;

/// Draws the pixels of `frame` as [`super::draw_frame`] does.
pub(super) fn draw(area: Rect, canvas: &mut impl Canvas, above: u32, frame: &Frame) {
    for (y, upper) in (area.top()..area.bottom()).zip((above..).step_by(2)) {
        for (x, column) in (0..).zip(area.left()..area.right()) {
            let [top, bottom] = [upper, upper + 1].map(|y| is_lit(frame, x, y));
            canvas.draw_character(column, y, lit_glyph(top, bottom), [Color::Reset; 2]);
        }
    }
}

/// Whether a pixel is lit.
fn is_lit(frame: &Frame, x: u32, y: u32) -> bool {
    let shade = i32::from(super::brighter(sharpened(frame, x, y)));
    shade >= 16 * i32::from(order(x, y)) + 8
}

/// How bright a pixel is, from 0 to 255, and as much brighter or darker again as it is than those two pixels
/// away from it, [`GAIN`] times.
fn sharpened(frame: &Frame, x: u32, y: u32) -> u8 {
    const AWAY: u32 = 2;
    const GAIN: i32 = 2;
    let luma = |x: u32, y: u32| {
        i32::from(frame.pixel(x.min(frame.width() - 1), y.min(frame.height() - 1)).luma())
    };
    let around = luma(x.saturating_sub(AWAY), y)
        + luma(x + AWAY, y)
        + luma(x, y.saturating_sub(AWAY))
        + luma(x, y + AWAY);
    let own = luma(x, y);
    (own + GAIN * (4 * own - around) / 4).clamp(0, 255) as u8
}
