//! The built-in textures: small patterns, computed rather than stored.

use std::num::NonZeroU32;

use super::Texture;
use crate::world::Rgb;

/// The names of all built-in textures.
pub const NAMES: &[&str] = &["brick", "stone"];

const SIDE: NonZeroU32 = NonZeroU32::new(64).unwrap();

/// The built-in texture of that name, 64 × 64 texels.
pub fn named(name: &str) -> Option<Texture> {
    let texel = match name {
        "brick" => brick,
        "stone" => stone,
        _ => return None,
    };
    Some(Texture::from_fn(SIDE, SIDE, texel))
}

/// Courses 8 texels high of bricks 16 texels long, every other course shifted by half a brick.
fn brick(x: u32, y: u32) -> Rgb {
    let shift = if (y / 8).is_multiple_of(2) { 0 } else { 8 };
    if y.is_multiple_of(8) || (x + shift).is_multiple_of(16) {
        Rgb::new(0x6a, 0x62, 0x5a)
    } else {
        Rgb::new(0xa0, 0x40, 0x30)
    }
}

/// Blocks 32 texels wide and 16 high.
fn stone(x: u32, y: u32) -> Rgb {
    if y.is_multiple_of(16) || x.is_multiple_of(32) {
        Rgb::new(0x48, 0x48, 0x4c)
    } else {
        Rgb::new(0x80, 0x80, 0x86)
    }
}
