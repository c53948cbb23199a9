//! Half blocks and shades in a small palette.
//!
//! Each cell is a half block in two palette colours or one of the shades ░ ▒ ▓, whichever shows it
//! better (see [`mixture`](crate::color::palette::mixture)). No cell depends on the frames before it,
//! so that a still picture stays still.

use std::iter;

use ratatui::layout::Rect;
use ratatui::style::Color;

use crate::canvas::Canvas;
use crate::color::Rgb;
use crate::color::palette::mixture::{Look, Mixer, WHOLE};
use crate::color::palette::{ColorDepth, ShadeInk};
use crate::render::Frame;
use crate::tui::correction::raised;

/// The shades of one, two and three quarters.
pub(super) const SHADES: [char; 3] = ['░', '▒', '▓'];

/// Draws the pixels of `frame` as [`super::draw_frame`] does.
pub(super) fn draw(
    area: Rect,
    canvas: &mut impl Canvas,
    depth: ColorDepth,
    ink: ShadeInk,
    above: u32,
    frame: &Frame,
) {
    let is_coarse = depth == ColorDepth::Indexed16;
    for (y, upper) in (area.top()..area.bottom()).zip((above..).step_by(2)) {
        let mut mixer = Mixer::new(depth, ink);
        for (column, x) in (0..).zip(area.left()..area.right()) {
            let halves = [upper, upper + 1].map(|row| {
                if is_coarse { clarified(frame, column, row) } else { frame.pixel(column, row) }
            });
            match mixer.look(halves, WHOLE / 2) {
                Look::Parts(halves) => {
                    canvas.draw_halves(x, y, iter::once(halves.map(Color::Indexed)));
                }
                Look::Shade(quarters, colors) => {
                    let shade = SHADES[usize::from(quarters - 1)];
                    canvas.draw_character(x, y, shade, colors.map(Color::Indexed));
                }
            }
        }
    }
}

/// The colour of a pixel with more contrast to those around it. In 16 colours, the shades of a dark
/// wall would otherwise be one.
fn clarified(frame: &Frame, x: u32, y: u32) -> Rgb {
    raised(frame.pixel(x, y), super::local_contrast(frame, x, y))
}
