//! The `ramp` glyph set: a character for each of sixteen shades, for every surface.

use crate::color::Rgb;

/// From the character that lights most of its cell to the one that lights nothing.
const RAMP: &[u8; 16] = b"WM0KXkxocl;:,'. ";

/// The character for a pixel with that colour.
pub(crate) fn character(color: Rgb) -> char {
    let darkness = usize::from(u8::MAX - color.luma());
    char::from(RAMP[darkness * RAMP.len() / 256])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ramp_goes_from_black_to_white() {
        let shades = (0..16).map(|shade| character(Rgb::new(shade * 17, shade * 17, shade * 17)));
        let ramp: Vec<u8> = shades.map(|character| character as u8).rev().collect();
        assert_eq!(ramp, RAMP);
    }
}
