//! A coffered ceiling: plaster beams around a sunken panel with a rosette.

use super::SIDE;
use super::block::Block;
use super::noise::Noise;
use super::shade::shade;
use crate::color::Rgb;

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
