//! What the cells of a window look like.

use font8x8::{BASIC_FONTS, BLOCK_FONTS, UnicodeFonts};
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Rect, Size};
use ratatui::style::Color;
use ratatui::widgets::StatefulWidget;

use cellcaster::color::Rgb;
use cellcaster::color::palette::{ColorDepth, of_256};
use cellcaster::color::srgb::{encoded, linear};
use cellcaster::render::Filter;
use cellcaster::tui::{FirstPerson, GlyphSet, View};
use cellcaster::world::{Camera, World};

/// A window that shows pictures.
pub(crate) struct Window {
    glyphs: GlyphSet,
    depth: ColorDepth,
    filter: Filter,
    view: View,
    buffer: Buffer,
}

impl Window {
    /// A window of `size` cells.
    pub(crate) fn new(size: Size, glyphs: GlyphSet, depth: ColorDepth, filter: Filter) -> Self {
        let buffer = Buffer::empty(Rect::from(size));
        Self { glyphs, depth, filter, view: View::default(), buffer }
    }

    /// Draws and paints the view of `camera`.
    pub(crate) fn show(&mut self, world: &World, camera: &Camera) {
        let Self { glyphs, depth, filter, view, buffer } = self;
        let widget =
            FirstPerson::new(world, camera).glyphs(*glyphs).color_depth(*depth).filter(*filter);
        widget.render(buffer.area, buffer, view);
    }

    /// The mean light of each half of a cell in sRGB, from 0 to 255, row by row of halves.
    pub(crate) fn halves(&self) -> Vec<[f64; 3]> {
        let rows = self.buffer.content.chunks(usize::from(self.buffer.area.width).max(1));
        rows.flat_map(|cells| {
            [0, 1].into_iter().flat_map(move |half| cells.iter().map(move |cell| light(cell, half)))
        })
        .collect()
    }
}

/// The mean light of the upper half of a cell, which is 0, or of the lower half.
fn light(cell: &Cell, half: usize) -> [f64; 3] {
    const DOTS: f64 = 32.0;
    let character = cell.symbol().chars().next().unwrap_or(' ');
    let glyph = BASIC_FONTS.get(character).or_else(|| BLOCK_FONTS.get(character));
    let rows = glyph.unwrap_or_default();
    let dots: u32 = rows[4 * half..4 * (half + 1)].iter().map(|row| row.count_ones()).sum();
    let share = f64::from(dots) / DOTS;
    let [text, ground] = [rgb(cell.fg), rgb(cell.bg)];
    if share == 0.0 || share == 1.0 {
        let color = if share == 0.0 { ground } else { text };
        return color.channels().map(f64::from);
    }
    let [text, ground] = [text, ground].map(linear);
    std::array::from_fn(|channel| {
        255.0 * encoded(share * text[channel] + (1.0 - share) * ground[channel])
    })
}

fn rgb(color: Color) -> Rgb {
    match color {
        Color::Rgb(red, green, blue) => Rgb::new(red, green, blue),
        Color::Indexed(index) => of_256(index),
        _ => Rgb::BLACK,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_half_block_lights_one_half() {
        let mut cell = Cell::default();
        cell.set_char('▀').set_fg(Color::Rgb(200, 10, 0)).set_bg(Color::Indexed(16));
        assert_eq!((light(&cell, 0), light(&cell, 1)), ([200.0, 10.0, 0.0], [0.0; 3]));
        cell.set_char(' ').set_bg(Color::Rgb(7, 8, 9));
        assert_eq!((light(&cell, 0), light(&cell, 1)), ([7.0, 8.0, 9.0], [7.0, 8.0, 9.0]));
    }

    #[test]
    fn a_letter_lights_a_part() {
        let mut cell = Cell::default();
        cell.set_char('#').set_fg(Color::Rgb(255, 255, 255)).set_bg(Color::Rgb(0, 0, 0));
        let [red, green, blue] = light(&cell, 0);
        assert!(red == green && green == blue && red > 100.0 && red < 255.0, "{red}");
    }
}
