//! What is fixed in a level and shows its state: checkpoints, levers and spikes.

use super::{Design, INK, Palette, drawn, mirrored, painted};
use crate::color::Rgb;
use crate::world::Texture;

/// A banner on a pole. It is grey before the player has reached it, and blue and gold after that.
pub(crate) fn checkpoint() -> Design {
    const LINES: [&str; 26] = [
        ".......kk.......",
        "......kYYk......",
        "......kYyk......",
        "kkkkkkkYykkkkkkk",
        "kYYYYYYYyyyyyyyk",
        "kkkkkkkkkkkkkkkk",
        ".kBBBBBBBbbbbbk.",
        ".kBBBBBBBbbbbbk.",
        ".kBBBBkkBbbbbbk.",
        ".kBBBkYwkbbbbbk.",
        ".kBBkYYwwkbbbbk.",
        ".kBkYYYwwwkbbbk.",
        ".kBBkYYwwkbbbbk.",
        ".kBBBkYwkbbbbbk.",
        ".kBBBBkkBbbbbbk.",
        ".kBBBBBBBbbbbbk.",
        ".kBBBBBBBbbbbbk.",
        ".kBBBkkBbkbbbbk.",
        ".kBBk.kYyk.kbbk.",
        ".kBk..kYyk..kbk.",
        ".kk...kYyk...kk.",
        "......kYyk......",
        "......kYyk......",
        "......kYyk......",
        "....kkkYykkk....",
        "....kkkkkkkk....",
    ];
    const GREY: &Palette = &[
        ('k', INK),
        ('B', Rgb::new(0x80, 0x80, 0x84)),
        ('b', Rgb::new(0x60, 0x60, 0x68)),
        ('Y', Rgb::new(0x74, 0x68, 0x5c)),
        ('y', Rgb::new(0x54, 0x4c, 0x48)),
        ('w', Rgb::new(0x98, 0x98, 0x98)),
    ];
    const LIT: &Palette = &[
        ('k', INK),
        ('B', Rgb::new(0x30, 0x78, 0xf0)),
        ('b', Rgb::new(0x20, 0x50, 0xb8)),
        ('Y', Rgb::new(0xff, 0xd8, 0x50)),
        ('y', Rgb::new(0xc8, 0x94, 0x2c)),
        ('w', Rgb::new(0xff, 0xfc, 0xe0)),
    ];
    let pictures = vec![drawn(&LINES, GREY), drawn(&LINES, LIT)];
    Design { animated: Some(1), ..Design::standing(0.8, pictures) }
}

/// A lever in a block of stone, to the left while its switch is off, to the right while it is on.
pub(crate) fn lever() -> Design {
    const LINES: [&str; 18] = [
        ".kkk..............",
        "kRRRk.............",
        "kRrrk.............",
        "kRrrk.............",
        ".kkIk.............",
        "...kIk............",
        "...kIIk...........",
        "....kIik..........",
        "....kIIik.........",
        ".....kIik.........",
        "......kIik........",
        "..kkkkkIIikkkkk...",
        ".kSSSSkkIikSSSsk..",
        ".kSSSSSkkkSSSssk..",
        ".kSSSSSSSSSSSssk..",
        "kkkkkkkkkkkkkkkkk.",
        "kSSSSSSSSSSSSsssk.",
        "kkkkkkkkkkkkkkkkk.",
    ];
    const OFF: &Palette = &[
        ('k', INK),
        ('S', STONE),
        ('s', SHADE),
        ('I', Rgb::new(0xa4, 0xac, 0xb8)),
        ('i', Rgb::new(0x6c, 0x74, 0x80)),
        ('R', Rgb::new(0xe0, 0x3c, 0x30)),
        ('r', Rgb::new(0xa0, 0x20, 0x20)),
    ];
    const ON: &Palette = &[
        ('k', INK),
        ('S', STONE),
        ('s', SHADE),
        ('I', Rgb::new(0xa4, 0xac, 0xb8)),
        ('i', Rgb::new(0x6c, 0x74, 0x80)),
        ('R', Rgb::new(0x58, 0xe8, 0x50)),
        ('r', Rgb::new(0x28, 0xa0, 0x38)),
    ];
    let pictures = vec![drawn(&LINES, OFF), mirrored(&LINES, ON)];
    Design { animated: Some(1), ..Design::standing(0.5, pictures) }
}

const STONE: Rgb = Rgb::new(0x98, 0x94, 0x8c);
const SHADE: Rgb = Rgb::new(0x6c, 0x68, 0x64);

/// Spikes: their holes, their tips, and all of them.
pub(crate) fn spikes() -> Design {
    let pictures = [0, 7, 18].map(spikes_out_by).to_vec();
    Design { animated: Some(1), ..Design::standing(0.5, pictures) }
}

/// Five spikes that are this many texels out of a slab.
fn spikes_out_by(out: i32) -> Texture {
    const WIDTH: i32 = 30;
    const HEIGHT: i32 = 22;
    const SPACING: i32 = 6;
    /// The upper edge of the slab.
    const SLAB: i32 = HEIGHT - 4;
    painted(WIDTH as u32, HEIGHT as u32, move |x, y| {
        let across = x % SPACING - SPACING / 2;
        // A spike is wider below its tip.
        let from_tip = y - (SLAB + 1 - out);
        let half = i32::from(from_tip >= 4);
        let is_spike = out > 0 && from_tip >= 0 && y <= SLAB + 1;
        if is_spike && (-half..=half).contains(&across) {
            let is_tip = from_tip < 4;
            return Some(match across {
                _ if is_tip => Rgb::WHITE,
                ..0 => Rgb::new(0xd8, 0xdc, 0xe4),
                0 => Rgb::new(0xa4, 0xac, 0xb8),
                _ => Rgb::new(0x70, 0x78, 0x88),
            });
        }
        if is_spike && (-half - 1..=half + 1).contains(&across) {
            return Some(INK);
        }
        let is_hole = y == SLAB + 1 && across.abs() < 2;
        match y {
            SLAB..HEIGHT if is_hole => Some(INK),
            SLAB | 21 => Some(Rgb::new(0x40, 0x2c, 0x28)),
            SLAB..HEIGHT => Some(Rgb::new(0x8c, 0x54, 0x38)),
            _ => None,
        }
    })
}
