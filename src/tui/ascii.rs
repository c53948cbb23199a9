//! ASCII: a cell shows one pixel, by a character that tells what it is before it tells how bright.
//!
//! Each surface has characters of its own, so that walls of either side, floor, ceiling and sky can
//! be told apart without any colour; within a surface four characters stand for four shades. One
//! ramp of brightness for all was refused: a dark wall before a bright one and a bright floor
//! before a dark wall looked the same.

use ratatui::layout::Rect;
use ratatui::style::Color;

use super::glyphs::color_at;
use crate::canvas::Canvas;
use crate::color::Rgb;
use crate::color::palette::ColorDepth;
use crate::render::Surface;

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

/// The corner of the cube: the nearest colour to black, among those that are nearly black, is a grey.
const BLACK_OF_256: u8 = 16;

/// Draws the pixels of a picture whose characters tell how bright they are: their colours are as bright as
/// they get, or else a dark wall would be darkened twice.
pub(super) fn draw_picture(
    area: Rect,
    canvas: &mut impl Canvas,
    depth: ColorDepth,
    pixel: impl Fn(u32, u32) -> (Rgb, char),
) {
    let ground = match depth {
        ColorDepth::Indexed256 => Color::Indexed(BLACK_OF_256),
        _ => color_at(depth, Rgb::BLACK),
    };
    for (row, y) in (0u32..).zip(area.top()..area.bottom()) {
        for (column, x) in (0u32..).zip(area.left()..area.right()) {
            let (color, character) = pixel(column, row);
            let text = match depth {
                ColorDepth::Indexed16 => Color::Indexed(name(brightened(color))),
                _ => color_at(depth, brightened(color)),
            };
            canvas.draw_character(x, y, character, [text, ground]);
        }
    }
}

/// `color` with its brightest channel at the most. The hue of what is nearly black is not to be
/// trusted, and fades.
fn brightened(color: Rgb) -> Rgb {
    const FADE: u32 = 12;
    let channels = color.channels().map(u32::from);
    let [red, green, blue] = channels;
    let brightest = red.max(green).max(blue) + FADE;
    let [red, green, blue] = channels.map(|channel| ((channel + FADE) * 255 / brightest) as u8);
    Rgb::new(red, green, blue)
}

/// The index of the named colour that has about the hue of a bright `color`, or is white. Users give the sixteen
/// colours of their own, but red stays red; blue is the bright one, as the other can hardly be read.
fn name(color: Rgb) -> u8 {
    const WHITE: u8 = 7;
    const NAMES: [u8; 8] = [WHITE, 1, 2, 3, 12, 5, 6, WHITE];
    const IS_ON: u8 = 190;
    const IS_PALE: u8 = 150;
    let channels = color.channels();
    if channels.iter().all(|&channel| channel >= IS_PALE) {
        return WHITE;
    }
    let on = channels.map(|channel| usize::from(channel >= IS_ON));
    NAMES[on[0] | on[1] << 1 | on[2] << 2]
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
    fn brightness_counts_once() {
        let [dark, bright] = [Rgb::new(80, 32, 24), Rgb::new(160, 64, 48)].map(brightened);
        assert_eq!((dark.red(), bright.red()), (255, 255));
        assert!(dark.green().abs_diff(bright.green()) < 24);
        assert_eq!(brightened(Rgb::BLACK), Rgb::WHITE);
    }

    #[test]
    fn hues_have_the_names_that_people_give_them() {
        let named = |red, green, blue| name(brightened(Rgb::new(red, green, blue)));
        assert_eq!((named(120, 40, 30), named(130, 100, 50)), (1, 3));
        assert_eq!((named(40, 110, 50), named(30, 40, 120)), (2, 12));
        // Stone that is a little blue, and moss that is a little green, are no bright spots.
        assert_eq!((named(110, 115, 130), named(90, 100, 85), named(0, 0, 0)), (7, 7, 7));
    }

    #[test]
    fn a_y_side_of_a_white_wall_is_as_bright_as_a_y_side_gets() {
        assert_eq!(character(Surface::WallX, Rgb::WHITE), '@');
        assert_eq!(character(Surface::WallY, Rgb::WHITE.halved()), 'H');
        assert_eq!(character(Surface::Floor, Rgb::BLACK), '.');
    }
}
