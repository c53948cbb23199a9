//! Half blocks without colour: what differs from its surroundings is drawn before how bright it is.
//!
//! A pixel that is clearly brighter or darker than those around it is lit, or not: joints and edges become
//! lines. All others are lit where they are brighter than their place in Bayer's pattern asks for. To measure
//! a frame and spread its shades was refused: one lamp that comes into view would change every cell.

use ratatui::layout::Rect;
use ratatui::style::Color;

use super::{lit_glyph, order};
use crate::canvas::Canvas;
use crate::render::Frame;

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
    /// The pixels around are those that far away.
    const AWAY: u32 = 2;
    let luma = |x: u32, y: u32| {
        u32::from(frame.pixel(x.min(frame.width() - 1), y.min(frame.height() - 1)).luma())
    };
    let around = luma(x.saturating_sub(AWAY), y)
        + luma(x + AWAY, y)
        + luma(x, y.saturating_sub(AWAY))
        + luma(x, y + AWAY);
    let own = luma(x, y);
    // Four times as bright as the mean of the four; clearly is by a sixth and a little more.
    let (own_four, clearly) = (4 * own, around / 6 + 16);
    if own_four > around + clearly {
        true
    } else if own_four + clearly < around {
        false
    } else {
        own >= 16 * u32::from(order(x, y)) + 8
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Rgb;
    use crate::render::{FrameSize, PixelAspect};

    /// A wall of that shade with a joint across it, in row 8.
    fn wall(brick: u8, joint: u8) -> Frame {
        let size = FrameSize::new(16, 16).unwrap();
        let mut frame = Frame::new(size, PixelAspect::SQUARE);
        let mut pixels = frame.whole();
        for row in 0..16 {
            let shade = if row == 8 { joint } else { brick };
            pixels.row_mut(row).fill(Rgb::new(shade, shade, shade));
        }
        frame
    }

    #[test]
    fn a_joint_is_a_line_however_dark_the_wall_is() {
        for (brick, joint) in [(40, 70), (60, 100), (100, 160), (150, 230)] {
            let (light, dark) = (wall(brick, joint), wall(joint, brick));
            for x in 0..16 {
                assert!(is_lit(&light, x, 8), "{brick} {joint}");
                assert!(!is_lit(&dark, x, 8), "{brick} {joint}");
            }
        }
    }

    #[test]
    fn a_flat_wall_is_as_bright_as_it_is() {
        let frame = wall(64, 64);
        let lit = (0..16).flat_map(|y| (0..16).map(move |x| (x, y)));
        assert_eq!(lit.filter(|&(x, y)| is_lit(&frame, x, y)).count(), 64);
    }
}
