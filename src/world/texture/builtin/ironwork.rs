//! Ironwork: grates, and the frames in which doors slide.

use super::noise::Noise;
use super::shade::shade;
use super::{SIDE, wrapped};
use crate::color::Rgb;

const IRON: Rgb = Rgb::new(0x86, 0x88, 0x8c);
const RUST: Noise = Noise::new(17, 16, 8);

/// Upright bars in a frame, with a band across.
pub(crate) fn grate(x: i32, y: i32) -> Option<Rgb> {
    const BAR: i32 = 16;
    const BAR_HALF: i32 = 3;
    const FRAME: i32 = 5;
    const BAND: i32 = 30;

    let rust = RUST.at(x, y, 14);
    let from_edge = y.min(SIDE - 1 - y);
    let (across_band, across_bar) = (y - BAND, x % BAR - BAR / 2);
    let light = if from_edge < FRAME {
        round(from_edge - FRAME / 2, FRAME / 2) - 30
    } else if (-BAR_HALF..=BAR_HALF).contains(&across_band) {
        let is_rivet = across_bar.abs() <= 1 && across_band.abs() <= 1;
        round(across_band, BAR_HALF) - 30 + if is_rivet { 110 } else { 0 }
    } else if (-BAR_HALF..=BAR_HALF).contains(&across_bar) {
        round(across_bar, BAR_HALF)
    } else {
        return None;
    };
    Some(shade(IRON, light + rust))
}

/// The light on a round bar at a distance from its middle, lit from the upper left.
fn round(from_middle: i32, half: i32) -> i32 {
    36 - (from_middle + half / 2).abs() * 120 / (2 * half)
}

/// An iron frame with an upright slot in the middle for the leaf of a door.
pub(crate) fn jamb(x: i32, y: i32) -> Rgb {
    const SLOT_HALF: i32 = 6;
    const LIP: i32 = 4;
    const BRACE: i32 = 32;
    const DARK: Rgb = Rgb::new(0x24, 0x26, 0x2c);

    let from_slot = wrapped(x - SIDE / 2);
    let depth = from_slot.abs() - SLOT_HALF;
    if depth < 0 {
        return DARK;
    }
    let light = match (depth, y % BRACE - BRACE / 2) {
        (..LIP, _) => 55 * from_slot.signum(),
        (_, 0) => -90,
        (_, 1) => 50,
        _ => 0,
    };
    shade(IRON, light + RUST.at(x, y, 14))
}
