//! Facings of walls and ceilings: glazed tiles, plaster, marble, and a coffered ceiling.

use super::block::Block;
use super::noise::Noise;
use super::shade::{FULL, mix, shade};
use super::{SIDE, wrapped};
use crate::color::Rgb;

/// A chequerboard of glazed tiles.
pub(crate) fn tile(x: i32, y: i32) -> Rgb {
    const TILE: i32 = 16;
    const SEA: Rgb = Rgb::new(0x1e, 0x72, 0x7e);
    const CREAM: Rgb = Rgb::new(0xde, 0xd6, 0xbe);
    const GROUT: Rgb = Rgb::new(0x58, 0x60, 0x60);

    let tile = Block::in_squares(TILE, x, y);
    if tile.rim() == 0 {
        return GROUT;
    }
    let glaze = if (x / TILE + y / TILE) % 2 == 0 { SEA } else { CREAM };
    let glint = matches!((tile.x, tile.y), (3..=4, 3..=7) | (5..=7, 3..=4));
    shade(glaze, tile.bevel(16) + if glint { 90 } else { 0 })
}

/// Limewashed plaster with a crack in it, between a skirting board and a picture rail.
pub(crate) fn plaster(x: i32, y: i32) -> Rgb {
    const LIME: Rgb = Rgb::new(0xd2, 0xc2, 0xa2);
    const PAINT: Rgb = Rgb::new(0x6e, 0x4a, 0x3a);
    const RAIL: i32 = 4;
    const UNDER_RAIL: i32 = 8;
    const SKIRTING: i32 = 54;
    const TROWEL: Noise = Noise::new(11, 32, 16);

    match y {
        ..RAIL => shade(LIME, -24),
        RAIL..UNDER_RAIL => shade(PAINT, moulding(y - RAIL, UNDER_RAIL - RAIL)),
        UNDER_RAIL => shade(LIME, -70),
        SKIRTING.. => shade(PAINT, moulding(y - SKIRTING, SIDE - SKIRTING)),
        _ => shade(LIME, crack(x, y) + TROWEL.at(x, y, 24)),
    }
}

/// The light on a painted board, `y` texels below the upper edge of its `height`.
fn moulding(y: i32, height: i32) -> i32 {
    match y {
        0 => 70,
        1 => 24,
        _ if y == height - 1 => -70,
        _ => 0,
    }
}

/// The light on the crack in the plaster, and on its lower lip; 0 beside it.
fn crack(x: i32, y: i32) -> i32 {
    const WANDER: Noise = Noise::new(15, 4, 4);
    const DRIFT: Noise = Noise::new(16, 16, 16);
    const END: i32 = 36;

    let middle = 20 + y / 2 + WANDER.at(0, y, 3) + DRIFT.at(0, y, 4);
    match x - middle {
        _ if y >= END => 0,
        0 => -110,
        1 => 40,
        _ => 0,
    }
}

/// White slabs with grey veins, one slab for each wall.
pub(crate) fn marble(x: i32, y: i32) -> Rgb {
    const WHITE: Rgb = Rgb::new(0xd4, 0xd6, 0xda);
    const VEIN: Rgb = Rgb::new(0x5c, 0x66, 0x7a);
    const JOINT: Rgb = Rgb::new(0x8a, 0x8e, 0x98);
    const FOLDS: Noise = Noise::new(12, 16, 16);
    const CLOUDS: Noise = Noise::new(13, 32, 32);

    let slab = Block::in_squares(SIDE, x, y);
    if slab.rim() == 0 {
        return JOINT;
    }
    let folds = FOLDS.at(x, y, 14) + CLOUDS.at(x, y, 16);
    let broad = near(x + y + folds, 20, 5);
    let fine = near(2 * x - y + folds * 2, 50, 4) * 2 / 3;
    let cloud = near(x + y + folds, 26, 18) / 4;
    shade(mix(WHITE, VEIN, broad.max(fine).max(cloud)), slab.bevel(12) + CLOUDS.at(x, y, 6))
}

/// The nearness of `place` to `line`, around the texture: [`FULL`] on it, 0 at a distance of `reach`
/// or more.
fn near(place: i32, line: i32, reach: i32) -> i32 {
    const STEP: i32 = FULL / 8;
    let distance = wrapped(place - line).abs();
    (FULL - distance * FULL / reach).max(0) / STEP * STEP
}

const PLASTER: Rgb = Rgb::new(0xa9, 0xa0, 0x8c);
const GILT: Rgb = Rgb::new(0xc2, 0x9c, 0x54);
const GRAIN: Noise = Noise::new(31, 16, 16);

/// The distances of the parts of the coffer from the middle of the beam, in texels.
const MOULDING: i32 = 5;
const LEDGE: i32 = 9;
const FILLET: i32 = 13;
const PANEL: i32 = 15;

/// Half the widths of the rosette and of the bud in its middle, in half texels.
const ROSETTE: i32 = 17;
const BUD: i32 = 6;

/// A coffer as large as the texture; the beams are centred on its edges.
pub(crate) fn coffer(x: i32, y: i32) -> Rgb {
    let block = Block::in_squares(SIDE, x, y);
    // The lower and the right side of a sunken panel face the light.
    let toward_light = -block.slope();
    let grain = GRAIN.at(x, y, 8);
    match block.rim() {
        rim if rim < MOULDING - 1 => shade(PLASTER, 62 + grain),
        rim if rim < MOULDING => shade(PLASTER, 92),
        rim if rim < LEDGE => shade(PLASTER, toward_light * 26 - 14),
        rim if rim < FILLET => shade(PLASTER, grain - 22),
        rim if rim < PANEL => shade(GILT, toward_light * 22 - 10),
        _ => rosette(2 * x + 1 - SIDE, 2 * y + 1 - SIDE).unwrap_or(shade(PLASTER, grain - 66)),
    }
}

/// The rosette at these half texels right of and below its middle; `None` outside it.
fn rosette(x: i32, y: i32) -> Option<Rgb> {
    let (square, most) = (x * x + y * y, ROSETTE * ROSETTE);
    if square > most {
        return None;
    }
    // A dome: its upper left is lit.
    let dome = -(x + y) * 4;
    // The sign of the cosine of four times the angle: four petals, with gaps between them.
    let is_petal = x * x * x * x - 6 * x * x * y * y + y * y * y * y > 0;
    Some(match square {
        _ if square <= BUD * BUD => shade(GILT, 40 + dome),
        _ if is_petal => shade(PLASTER, 70 + dome),
        _ => shade(PLASTER, dome - 40),
    })
}
