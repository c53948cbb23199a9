//! The flash at the edge of the picture: red when the player is hurt, on the side from which the
//! blow came, and golden when they find something.
//!
//! Colours tint the pixels before they are painted, so that every colour depth shows the tint as it
//! shows everything else. Without colours, the edge is drawn in characters.

use ratatui::layout::Rect;
use ratatui::style::Color;

use crate::color::Rgb;
use crate::game::{Flash, FlashKind};
use crate::render::Frame;
use crate::tui::canvas::Canvas;
use crate::world::Heading;

/// The colours of a flash.
const HURT: Rgb = Rgb::new(0xe8, 0x18, 0x10);
const GAIN: Rgb = Rgb::new(0xff, 0xd0, 0x40);
/// The opacity of the tint at the edge.
const HURT_OPACITY: f64 = 210.0;
const GAIN_OPACITY: f64 = 130.0;
/// The width of the tint, as a share of the picture's smaller side, on the side of the blow and on
/// the others.
const NEAR_SIDE: f64 = 0.3;
const OTHER_SIDES: f64 = 0.08;

/// A side of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Ahead,
    Right,
    Behind,
    Left,
}

/// The sides of the picture on which the flash is: one, or all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Sides(Option<Side>);

impl Sides {
    /// All of them, or the one from which the player was hurt.
    fn of(flash: &Flash, heading: Heading) -> Self {
        let FlashKind::Hurt { bearing: Some(bearing) } = flash.kind else {
            return Self(None);
        };
        let clockwise = (bearing.degrees() - heading.degrees()).rem_euclid(360.0);
        let clockwise_from_ahead = [Side::Ahead, Side::Right, Side::Behind, Side::Left];
        Self(Some(clockwise_from_ahead[(clockwise / 90.0).round() as usize % 4]))
    }

    fn contains(self, side: Side) -> bool {
        self.0.is_none_or(|only| only == side)
    }
}

/// Tints the pixels at the edge of `frame`.
pub fn tint(frame: &mut Frame, flash: &Flash, heading: Heading) {
    let (color, opacity) = match flash.kind {
        FlashKind::Hurt { .. } => (HURT, HURT_OPACITY),
        FlashKind::Gain => (GAIN, GAIN_OPACITY),
    };
    let opacity = opacity * flash.strength();
    let sides = Sides::of(flash, heading);
    // A flash without a direction is thin on all sides.
    let (width, height) = (f64::from(frame.width()), f64::from(frame.height()));
    // Half blocks are square; the pixels of other glyphs are higher than wide.
    let aspect = frame.pixel_aspect().height_over_width();
    let side = width.min(height * aspect);
    let reach = |which| side * if sides.0 == Some(which) { NEAR_SIDE } else { OTHER_SIDES };
    let share = |distance: f64, reach: f64| (1.0 - distance / reach.max(1.0)).max(0.0);
    for (y, row) in frame.rows_mut().enumerate() {
        let (top, bottom) = ((y as f64 + 0.5) * aspect, (height - y as f64 - 0.5) * aspect);
        let rows = share(top, reach(Side::Ahead)).max(share(bottom, reach(Side::Behind)));
        for (x, pixel) in row.iter_mut().enumerate() {
            let (left, right) = (x as f64 + 0.5, width - x as f64 - 0.5);
            let columns = share(left, reach(Side::Left)).max(share(right, reach(Side::Right)));
            let alpha = opacity * rows.max(columns);
            if alpha >= 1.0 {
                *pixel = color.over(*pixel, alpha as u8);
            }
        }
    }
}

/// Draws the edge in characters, for pictures without colours.
pub fn draw(canvas: &mut impl Canvas, picture: Rect, flash: &Flash, heading: Heading) {
    let character = match flash.kind {
        FlashKind::Hurt { .. } => '#',
        FlashKind::Gain => '+',
    };
    let sides = Sides::of(flash, heading);
    let mut draw = |x, y| canvas.draw_character(x, y, character, [Color::Reset; 2]);
    let (last_column, last_row) =
        (picture.right().saturating_sub(1), picture.bottom().saturating_sub(1));
    for x in picture.left()..picture.right() {
        let rows = [(Side::Ahead, picture.top()), (Side::Behind, last_row)];
        rows.into_iter().filter(|row| sides.contains(row.0)).for_each(|(_, y)| draw(x, y));
    }
    for y in picture.top()..picture.bottom() {
        let columns = [(Side::Left, picture.left()), (Side::Right, last_column)];
        columns.into_iter().filter(|column| sides.contains(column.0)).for_each(|(_, x)| draw(x, y));
    }
}

#[cfg(test)]
mod tests {
    use ratatui::buffer::Buffer;

    use super::*;
    use crate::render::{FrameSize, PixelAspect};

    fn hurt(degrees: Option<f64>) -> Flash {
        let bearing = degrees.and_then(Heading::from_degrees);
        Flash { kind: FlashKind::Hurt { bearing }, left: 20 }
    }

    fn reds(flash: &Flash) -> [u8; 5] {
        let mut frame = Frame::new(FrameSize::new(80, 46).unwrap(), PixelAspect::SQUARE);
        tint(&mut frame, flash, Heading::from_degrees(90.0).unwrap());
        [(40, 2), (77, 23), (40, 43), (2, 23), (40, 23)].map(|(x, y)| frame.pixel(x, y).red())
    }

    #[test]
    fn a_blow_reddens_the_side_that_it_comes_from() {
        for (degrees, side) in [(90.0, 0), (180.0, 1), (270.0, 2), (0.0, 3)] {
            let reds = reds(&hurt(Some(degrees)));
            for other in (0..4).filter(|&other| other != side) {
                assert!(reds[side] > reds[other] + 60, "{degrees}: {reds:?}");
            }
            assert_eq!(reds[4], 0, "the middle stays as it is");
        }
        let around = reds(&hurt(None));
        assert!(around[..4].iter().all(|&red| red == around[0] && red > 0), "{around:?}");
    }

    #[test]
    fn without_colours_the_side_is_characters() {
        let area = Rect::new(0, 0, 20, 6);
        let mut buffer = Buffer::empty(area);
        draw(&mut buffer, area, &hurt(Some(0.0)), Heading::from_degrees(90.0).unwrap());
        let marked: Vec<_> = buffer.content().iter().map(|cell| cell.symbol() == "#").collect();
        assert!((0..120).all(|index| marked[index] == (index % 20 == 0)), "{buffer:?}");
        let gain = Flash { kind: FlashKind::Gain, left: 3 };
        draw(&mut buffer, area, &gain, Heading::from_degrees(0.0).unwrap());
        assert_eq!(buffer.content().iter().filter(|cell| cell.symbol() == "+").count(), 48);
        draw(&mut buffer, Rect::default(), &gain, Heading::from_degrees(0.0).unwrap());
    }
}
