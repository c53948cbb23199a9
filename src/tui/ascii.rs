//! ASCII: a cell shows one pixel, by a character that tells what it is before it tells how bright.
//!
//! Each surface has characters of its own, so that walls of either side, floor, ceiling and sky can
//! be told apart without any colour; within a surface four characters stand for four shades. One
//! ramp of brightness for all was refused: a dark wall before a bright one and a bright floor
//! before a dark wall looked the same.

use ratatui::layout::Rect;

use super::Canvas;
use super::glyphs::color_at;
use crate::palette::ColorDepth;
use crate::render::Surface;
use crate::world::Rgb;

/// Draws the pixels of `area`, as many as cells: `pixel(x, y)` counts from its top left corner.
pub(super) fn draw(
    area: Rect,
    canvas: &mut impl Canvas,
    depth: ColorDepth,
    pixel: impl Fn(u32, u32) -> (Rgb, char),
) {
    for (row, y) in (0u32..).zip(area.top()..area.bottom()) {
        for (column, x) in (0u32..).zip(area.left()..area.right()) {
            let (color, character) = pixel(column, row);
            let colors = [color, Rgb::BLACK].map(|color| color_at(depth, color));
            canvas.draw_character(x, y, character, colors);
        }
    }
}

/// The character for a pixel of `surface` in that colour.
pub(super) fn character(surface: Surface, color: Rgb) -> char {
    let shades = shades(surface);
    let brightness = match surface {
        // It is drawn at half brightness; its four characters are for the brightness before that.
        Surface::WallY => color.luma().saturating_mul(2),
        _ => color.luma(),
    };
    shades[usize::from(brightness) * shades.len() / 256]
}

/// A surface's characters, from dark to bright.
fn shades(surface: Surface) -> [char; 4] {
    match surface {
        Surface::Ceiling => ['`', '\'', '"', '^'],
        Surface::Sky => [' '; 4],
        Surface::WallX => ['x', '%', '#', '@'],
        Surface::WallY => ['!', '/', '|', 'H'],
        Surface::Floor => ['.', ':', '-', '='],
        Surface::Thing => ['c', 'o', 'O', '8'],
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn no_character_stands_for_two_surfaces() {
        let surfaces = [
            Surface::Ceiling,
            Surface::Sky,
            Surface::WallX,
            Surface::WallY,
            Surface::Floor,
            Surface::Thing,
        ];
        let mut seen = HashSet::new();
        for surface in surfaces {
            let own: HashSet<char> = shades(surface).into_iter().collect();
            assert!(own.iter().all(|&character| seen.insert(character)), "{surface:?}");
        }
    }

    #[test]
    fn a_y_side_of_a_white_wall_is_as_bright_as_a_y_side_gets() {
        assert_eq!(character(Surface::WallX, Rgb::WHITE), '@');
        assert_eq!(character(Surface::WallY, Rgb::WHITE.halved()), 'H');
        assert_eq!(character(Surface::Floor, Rgb::BLACK), '.');
    }
}
