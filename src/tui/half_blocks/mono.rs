//! Half blocks without colour: contrast with the surroundings counts more than brightness.
//!
//! A pixel clear brighter than those around it is lit, and a clear darker one is unlit, so that
//! joints and edges become lines. Other pixels are lit if they exceed their threshold in Bayer's
//! matrix. Measuring a frame and stretching its range of brightness was refused: one lamp that
//! comes into view would change every cell.
//!
//! Things have an outline: their outermost pixels are lit, and the pixels next to them are unlit.
//! Otherwise a guard a few pixels wide is lost among the dots of the wall behind.

use ratatui::layout::Rect;
use ratatui::style::Color;

use super::{lit_glyph, threshold_rank};
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
    let outline = |x, y| outline(frame.size(), &surface, x, y);
    for (y, upper) in (area.top()..area.bottom()).zip((above..).step_by(2)) {
        for (x, column) in (0..).zip(area.left()..area.right()) {
            let is_lit = |y| match outline(x, y) {
                Some(edge) => edge == Edge::Inner,
                None => is_lit(frame, x, y),
            };
            let [top, bottom] = [upper, upper + 1].map(is_lit);
            canvas.draw_character(column, y, lit_glyph(top, bottom), [Color::Reset; 2]);
        }
    }
}

/// Whether a pixel is lit.
fn is_lit(frame: &Frame, x: u32, y: u32) -> bool {
    /// The distance of the four pixels that are compared.
    const DISTANCE: u32 = 2;
    let luma = |x: u32, y: u32| {
        u32::from(frame.pixel(x.min(frame.width() - 1), y.min(frame.height() - 1)).luma())
    };
    let around = luma(x.saturating_sub(DISTANCE), y)
        + luma(x + DISTANCE, y)
        + luma(x, y.saturating_sub(DISTANCE))
        + luma(x, y + DISTANCE);
    let own = luma(x, y);
    // The sums of four pixels are compared. The contrast is clear above a sixth plus 16.
    let (own_four, clear) = (4 * own, around / 6 + 16);
    if own_four > around + clear {
        true
    } else if own_four + clear < around {
        false
    } else {
        own >= 16 * u32::from(threshold_rank(x, y)) + 8
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Rgb;
    use crate::render::{FrameSize, PixelAspect};

    /// A wall of that shade with a joint across it in row 8.
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
    fn a_joint_is_a_line_on_dark_and_on_bright_walls() {
        for (brick, joint) in [(40, 70), (60, 100), (100, 160), (150, 230)] {
            let (light, dark) = (wall(brick, joint), wall(joint, brick));
            for x in 0..16 {
                assert!(is_lit(&light, x, 8), "{brick} {joint}");
                assert!(!is_lit(&dark, x, 8), "{brick} {joint}");
            }
        }
    }

    #[test]
    fn a_quarter_of_a_wall_of_a_quarter_of_full_brightness_is_lit() {
        let frame = wall(64, 64);
        let lit = (0..16).flat_map(|y| (0..16).map(move |x| (x, y)));
        assert_eq!(lit.filter(|&(x, y)| is_lit(&frame, x, y)).count(), 64);
    }
}
