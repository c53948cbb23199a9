//! Blocks and shades in a small palette.
//!
//! Each cell is a block in two palette colours or one of the shades ░ ▒ ▓, whichever shows it better
//! (see [`mixture`](crate::color::palette::mixture)).

use std::iter;

use ratatui::layout::Rect;
use ratatui::style::Color;

use super::split::{Split, Splits};
use super::{mosaic, pixels_per_cell};
use crate::color::Rgb;
use crate::color::palette::mixture::{Look, Mixer, WHOLE};
use crate::color::palette::{ColorDepth, ShadeInk};
use crate::render::Frame;
use crate::tui::canvas::Canvas;
use crate::tui::correction::{local_contrast, raised};

/// The shades of one, two and three quarters.
pub(crate) const SHADES: [char; 3] = ['░', '▒', '▓'];

/// Draws the pixels of `frame` as [`super::draw_frame`] does, `PIXELS` in each cell.
pub(crate) fn draw<const PIXELS: usize, C: Canvas>(
    area: Rect,
    canvas: &mut C,
    (depth, ink): (ColorDepth, ShadeInk),
    above: u32,
    frame: &Frame,
) {
    let [columns, rows] = pixels_per_cell::<PIXELS>();
    let pixel = |x, y| match depth {
        ColorDepth::Indexed16 => clarified(frame, [x, y], [columns, rows]),
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
                Look::Parts(parts) => {
                    let cell = (mosaic::<PIXELS>(mask), parts.map(Color::Indexed));
                    canvas.draw_mosaics(x, y, iter::once(cell));
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
fn clarified(frame: &Frame, [x, y]: [u32; 2], pixels_per_cell: [u32; 2]) -> Rgb {
    let luma = |x, y| frame.pixel(x, y).luma();
    let size = [frame.width(), frame.height()];
    raised(frame.pixel(x, y), local_contrast(size, luma, [x, y], pixels_per_cell))
}
