//! Light and shadow.

use super::noise::hash;
use crate::color::Rgb;

/// What full light turns every colour into: a warm white.
const LIGHT: Rgb = Rgb::new(0xff, 0xf4, 0xdc);
/// What full shadow turns every colour into: a cool black.
const SHADOW: Rgb = Rgb::new(0x10, 0x0e, 0x18);

/// Full light, and as a negative number full shadow.
pub(super) const FULL: i32 = 256;

/// Light comes in steps of this size, so that a surface has few colours and large flat areas.
const STEP: i32 = 6;

/// `color` in `light`: from `-FULL`, where it is black, through 0, where it is itself, to `FULL`.
pub(super) fn shade(color: Rgb, light: i32) -> Rgb {
    let light = (light / STEP * STEP).clamp(-FULL, FULL);
    mix(color, if light < 0 { SHADOW } else { LIGHT }, light.abs())
}

/// `share` parts of `to` in `from`, out of [`FULL`].
pub(super) fn mix(from: Rgb, to: Rgb, share: i32) -> Rgb {
    let channel = |from: u8, to: u8| {
        let (from, to) = (i32::from(from), i32::from(to));
        (from + (to - from) * share / FULL) as u8
    };
    Rgb::new(
        channel(from.red(), to.red()),
        channel(from.green(), to.green()),
        channel(from.blue(), to.blue()),
    )
}

/// One of `colors`, always the same for the same `id`.
pub(super) fn pick<const COUNT: usize>(colors: [Rgb; COUNT], id: i32) -> Rgb {
    const { assert!(COUNT > 0, "there is nothing to pick from") };
    colors[hash(id, 0, 0) as usize % COUNT]
}
