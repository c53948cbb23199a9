//! Riveted metal plates.

use super::block::Block;
use super::noise::Noise;
use super::shade::shade;
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
