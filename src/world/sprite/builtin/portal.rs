//! The exit.

use super::{Design, painted};
use crate::color::Rgb;

/// An arch of stone with green light rising in it.
pub(crate) fn portal() -> Design {
    const FRAMES: i32 = 4;
    let pictures = (0..FRAMES).map(|frame| {
        painted(WIDTH as u32, HEIGHT as u32, move |x, y| texel(x, y, frame * BAND * 2 / FRAMES))
    });
    Design { seconds: 0.15, shines: 0.3, ..Design::standing(0.9, pictures.collect()) }
}

const WIDTH: i32 = 24;
const HEIGHT: i32 = 36;
/// The width of the stones of the arch.
const STONE: i32 = 4;
/// The height of a band of light.
const BAND: i32 = 6;

fn texel(x: i32, y: i32, risen: i32) -> Option<Rgb> {
    const OUTSIDE: i32 = WIDTH / 2;
    // Distances from the middle of the arch, in half texels: a circle above the middle, upright
    // below.
    let (across, above) = (2 * x + 1 - WIDTH, (2 * (OUTSIDE - y) - 1).max(0));
    let squared = across * across + above * above;
    let is_within = |radius: i32| squared < 4 * radius * radius;
    if !is_within(OUTSIDE) {
        return None;
    }
    if is_within(OUTSIDE - STONE) {
        // Bands bend upwards in the middle.
        let phase = (y + risen + across * across / 24).rem_euclid(2 * BAND) - BAND;
        let glow = BAND - phase.abs();
        let core = (2 * (OUTSIDE - STONE) - across.abs()) / 2;
        let light = glow * 12 + core * 10;
        let channel = |base: i32, share: i32| (base + light * share / 8).clamp(0, 255) as u8;
        return Some(Rgb::new(channel(8, 3), channel(88, 8), channel(56, 5)));
    }
    let is_edge = !is_within(OUTSIDE - 1) || is_within(OUTSIDE - STONE + 1);
    let is_joint = (y + i32::from(across > 0) * 3) % 7 == 0;
    Some(match (is_edge, is_joint, across > 0) {
        (true, ..) => Rgb::new(0x3c, 0x40, 0x48),
        (_, true, _) => Rgb::new(0x60, 0x64, 0x6c),
        (.., false) => Rgb::new(0xa8, 0xac, 0xb4),
        (.., true) => Rgb::new(0x88, 0x8c, 0x94),
    })
}
