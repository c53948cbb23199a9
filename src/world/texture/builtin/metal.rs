//! Metal: riveted plates, grates, and the frames in which doors slide.

use super::block::Block;
use super::noise::Noise;
use super::shade::shade;
use super::{SIDE, wrapped};
use crate::color::Rgb;

/// Steel plates, a rivet in each corner.
pub(crate) fn metal(x: i32, y: i32) -> Rgb {
    const PLATE: i32 = 32;
    const STEEL: Rgb = Rgb::new(0x6c, 0x7a, 0x88);
    const SEAM: Rgb = Rgb::new(0x20, 0x26, 0x30);
    const TARNISH: Noise = Noise::new(10, 32, 16);

    let plate = Block::in_squares(PLATE, x, y);
    if plate.rim() == 0 {
        return SEAM;
    }
    let rolled = if (x / PLATE + y / PLATE) % 2 == 0 { 22 } else { -8 };
    let sheen = rolled - (plate.x + plate.y - PLATE).abs() * 44 / PLATE;
    let light = rivet(plate).unwrap_or(plate.bevel(16) + sheen);
    shade(STEEL, light + TARNISH.at(x, y, 10))
}

/// The light on the nearest rivet and in its shadow; `None` elsewhere.
fn rivet(plate: Block) -> Option<i32> {
    const FROM_EDGE: i32 = 6;
    const RADIUS_SQUARED: i32 = 5;
    let from = |place: i32, length: i32| {
        if place < length / 2 { place - FROM_EDGE } else { place - (length - 1 - FROM_EDGE) }
    };
    let (x, y) = (from(plate.x, plate.width), from(plate.y, plate.height));
    let inside = |x: i32, y: i32| x * x + y * y <= RADIUS_SQUARED;
    if inside(x, y) {
        Some(60 - 34 * (x + y))
    } else if inside(x - 1, y - 1) {
        Some(-110)
    } else {
        None
    }
}

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
