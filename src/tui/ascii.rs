//! The glyph sets `ascii` and `ramp`: a cell shows one pixel.
//!
//! In `ascii`, the character shows first which surface the pixel belongs to, and then how bright it is. Each surface
//! has its own characters, so that x sides and y sides of walls, floor, ceiling and sky differ without colour. Without
//! colour, the cells around a thing are also blank. Within a surface, four characters stand for four shades. In `ramp`,
//! sixteen characters show the brightness of every surface.
//!
//! Rejected: `ramp` alone. A dark wall in front of a bright wall looks the same as a bright floor in front of a dark
//! wall.

use ratatui::style::Color;

use super::glyphs::color_at;
use crate::color::Rgb;
use crate::color::palette::ColorDepth;
use crate::render::Surface;

/// The black corner of the cube. The nearest colour to an almost black colour would be a grey.
const BLACK_OF_256: u8 = 16;

/// The colours of a character that shows the brightness of `color`. They are at full brightness, because a dark wall
/// would otherwise be darkened twice.
pub(crate) fn picture_colors(depth: ColorDepth, color: Rgb) -> [Color; 2] {
    let background = match depth {
        ColorDepth::Indexed256 => Color::Indexed(BLACK_OF_256),
        _ => color_at(depth, Rgb::BLACK),
    };
    let text = match depth {
        ColorDepth::Indexed16 => Color::Indexed(named_color(brightened(color))),
        _ => color_at(depth, brightened(color)),
    };
    [text, background]
}

/// `color` with its brightest channel at the maximum. An almost black colour has an unreliable hue,
/// and becomes paler.
fn brightened(color: Rgb) -> Rgb {
    const FADE: u32 = 12;
    let channels = color.channels().map(u32::from);
    let [red, green, blue] = channels;
    let brightest = red.max(green).max(blue) + FADE;
    let [red, green, blue] = channels.map(|channel| ((channel + FADE) * 255 / brightest) as u8);
    Rgb::new(red, green, blue)
}

/// The index of the named colour with the hue nearest to a bright `color`'s, or white. Users can redefine the sixteen
/// colours, but red stays red. Blue is the bright blue, because the dark blue is hard to read.
fn named_color(color: Rgb) -> u8 {
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

/// The character for a pixel of `surface` with this colour.
pub(crate) fn character(surface: Surface, color: Rgb) -> char {
    let shades = shades(surface);
    let brightness = match surface {
        // A y side is drawn at half brightness. Its characters are chosen by the full brightness.
        Surface::WallY => color.luma().saturating_mul(2),
        _ => color.luma(),
    };
    shades[usize::from(brightness) * shades.len() / 256]
}

/// The characters of a surface, from dark to bright.
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

/// The sixteen characters of the ramp, by the share of the cell that they light, from most to none.
const RAMP: &[u8; 16] = b"WM0KXkxocl;:,'. ";

/// The character of the ramp for a pixel with this colour.
pub(crate) fn ramp_character(color: Rgb) -> char {
    let darkness = usize::from(u8::MAX - color.luma());
    char::from(RAMP[darkness * RAMP.len() / 256])
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn surfaces_share_no_character() {
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
    fn colours_of_one_hue_have_the_same_brightness() {
        let [dark, bright] = [Rgb::new(80, 32, 24), Rgb::new(160, 64, 48)].map(brightened);
        assert_eq!((dark.red(), bright.red()), (255, 255));
        assert!(dark.green().abs_diff(bright.green()) < 24);
        assert_eq!(brightened(Rgb::BLACK), Rgb::WHITE);
    }

    #[test]
    fn colours_map_to_the_named_colour_of_their_hue() {
        let named = |red, green, blue| named_color(brightened(Rgb::new(red, green, blue)));
        assert_eq!((named(120, 40, 30), named(130, 100, 50)), (1, 3));
        assert_eq!((named(40, 110, 50), named(30, 40, 120)), (2, 12));
        // Stone that is slightly blue and moss that is slightly green stay white.
        assert_eq!((named(110, 115, 130), named(90, 100, 85), named(0, 0, 0)), (7, 7, 7));
    }

    #[test]
    fn a_white_y_side_has_the_brightest_y_side_character() {
        assert_eq!(character(Surface::WallX, Rgb::WHITE), '@');
        assert_eq!(character(Surface::WallY, Rgb::WHITE.halved()), 'H');
        assert_eq!(character(Surface::Floor, Rgb::BLACK), '.');
    }

    #[test]
    fn the_ramp_goes_from_black_to_white() {
        let shades =
            (0..16).map(|shade| ramp_character(Rgb::new(shade * 17, shade * 17, shade * 17)));
        let ramp: Vec<u8> = shades.map(|character| character as u8).rev().collect();
        assert_eq!(ramp, RAMP);
    }
}
