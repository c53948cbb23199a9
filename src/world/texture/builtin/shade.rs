//! Light and shadow.

use super::noise::hash;
use crate::color::Rgb;

/// The colour of full light: a warm white.
const LIGHT: Rgb = Rgb::new(0xff, 0xf4, 0xdc);
/// The colour of full shadow: a cool black.
const SHADOW: Rgb = Rgb::new(0x10, 0x0e, 0x18);

/// Full light; negative for full shadow.
pub(crate) const FULL: i32 = 256;

/// The step between lights, so that a surface has few colours and large areas of one.
const STEP: i32 = 6;

/// `color` in `light`: black at `-FULL`, unchanged at 0, brightest at `FULL`.
pub(crate) fn shade(color: Rgb, light: i32) -> Rgb {
    let light = (light / STEP * STEP).clamp(-FULL, FULL);
    mix(color, if light < 0 { SHADOW } else { LIGHT }, light.abs())
}

/// A mixture of `from` and `share` parts of `to`, out of [`FULL`].
pub(crate) fn mix(from: Rgb, to: Rgb, share: i32) -> Rgb {
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

/// One of `colors`, selected by `id`.
pub(crate) fn pick<const COUNT: usize>(colors: [Rgb; COUNT], id: i32) -> Rgb {
    const { assert!(COUNT > 0, "there is nothing to pick from") };
    colors[hash(id, 0, 0) as usize % COUNT]
}
