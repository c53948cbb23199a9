//! Timber: planks, a panelled door, a picket fence.

use std::ops::Range;

use super::SIDE;
use super::block::{Area, Block};
use super::noise::Noise;
use super::shade::shade;
use crate::color::Rgb;

/// Upright planks, each nailed where it meets the next one.
pub(crate) fn wood(x: i32, y: i32) -> Rgb {
    const PLANK: i32 = 16;
    const SAWN: [Rgb; 4] = [
        Rgb::new(0x9a, 0x6a, 0x3c),
        Rgb::new(0x80, 0x54, 0x30),
        Rgb::new(0xae, 0x7e, 0x4c),
        Rgb::new(0x8e, 0x5e, 0x36),
    ];
    const GAP: Rgb = Rgb::new(0x34, 0x20, 0x16);
    const NAIL: Rgb = Rgb::new(0x2a, 0x24, 0x26);

    let plank = x / PLANK;
    let end = (plank * 27 + 12) % SIDE;
    let board = Block {
        x: x % PLANK,
        y: (y - end).rem_euclid(SIDE),
        width: PLANK,
        height: SIDE,
        id: plank,
    };
    if board.rim() == 0 {
        return GAP;
    }
    let from_end = board.y.min(SIDE - 1 - board.y);
    if from_end == 4 && (board.x == 4 || board.x == 11) {
        return NAIL;
    }
    shade(SAWN[plank as usize % SAWN.len()], board.bevel(10) + grain(x, y))
}

/// Light and dark streaks along upright timber.
fn grain(x: i32, y: i32) -> i32 {
    const SWAY: Noise = Noise::new(8, 16, 32);
    const STREAKS: Noise = Noise::new(9, 2, 64);
    STREAKS.at(x * 2 + SWAY.at(x, y, 6), y, 26) / 2
}

/// A door of four panels with a brass knob.
pub(crate) fn oak(x: i32, y: i32) -> Rgb {
    const OAK: Rgb = Rgb::new(0xa4, 0x6c, 0x32);
    const GAP: Rgb = Rgb::new(0x2c, 0x1a, 0x12);

    let door = Block { x, y, width: SIDE, height: SIDE, id: 0 };
    if door.rim() == 0 {
        return GAP;
    }
    if let Some(brass) = knob(x, y) {
        return brass;
    }
    match Block::among(&PANELS, x, y) {
        Some(panel) => shade(OAK, panel_light(panel) + grain(x, y)),
        None if RAILS.contains(&x) => shade(OAK, door.bevel(14) + grain(y, x) + 6),
        None => shade(OAK, door.bevel(14) + grain(x, y)),
    }
}

/// The columns between the upright timbers at the left and the right of the door.
const RAILS: Range<i32> = 9..SIDE - 9;

const PANELS: [Area; 4] = [
    Area { left: RAILS.start, top: 8, width: 20, height: 25 },
    Area { left: 35, top: 8, width: 20, height: 25 },
    Area { left: RAILS.start, top: 42, width: 20, height: 13 },
    Area { left: 35, top: 42, width: 20, height: 13 },
];

/// A panel is recessed, with a raised field in it.
fn panel_light(panel: Block) -> i32 {
    match panel.rim() {
        0 => -130,
        1 => -60 - panel.slope() * 14,
        2 => -60,
        3 | 4 => panel.slope() * 20,
        _ => 0,
    }
}

/// The brass knob and its shadow on the door; `None` elsewhere.
fn knob(x: i32, y: i32) -> Option<Rgb> {
    const BRASS: Rgb = Rgb::new(0xd8, 0xa8, 0x3c);
    const SHADOW: Rgb = Rgb::new(0x4a, 0x2e, 0x18);
    const PLACE: (i32, i32) = (57, 37);
    const RADIUS_SQUARED: i32 = 10;

    let (x, y) = (x - PLACE.0, y - PLACE.1);
    let inside = |x: i32, y: i32| x * x + y * y <= RADIUS_SQUARED;
    if inside(x, y) {
        Some(shade(BRASS, 30 - 26 * (x + y)))
    } else if inside(x - 1, y - 2) {
        Some(SHADOW)
    } else {
        None
    }
}

/// A fence of pointed pickets on two rails.
pub(crate) fn fence(x: i32, y: i32) -> Option<Rgb> {
    const PICKET: i32 = 16;
    const WIDTH: i32 = 10;
    const POINT: i32 = 12;
    const RAILS: [Range<i32>; 2] = [22..28, 48..54];
    const PAINT: Rgb = Rgb::new(0xb8, 0x9a, 0x6c);
    const RAIL_PAINT: Rgb = Rgb::new(0x8c, 0x70, 0x4a);

    let (picket_x, half) = (x % PICKET - (PICKET - WIDTH) / 2, WIDTH / 2);
    let from_middle = if picket_x < half { half - 1 - picket_x } else { picket_x - half };
    let top = POINT + from_middle * 2;
    if (0..WIDTH).contains(&picket_x) && y >= top {
        let edge = match picket_x {
            0 | 1 => 40,
            _ if picket_x >= WIDTH - 2 => -60,
            _ if y < top + 2 => 50,
            _ => 0,
        };
        return Some(shade(PAINT, edge + grain(x, y)));
    }
    let rail = RAILS.iter().find(|rail| rail.contains(&y))?;
    let edge = if y == rail.start { 30 } else { -30 * i32::from(y + 2 >= rail.end) };
    Some(shade(RAIL_PAINT, edge + grain(y, x)))
}
