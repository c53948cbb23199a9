//! Masonry: brick, stone, mossy stone, sandstone, flagstones.

use super::block::{Bond, Course};
use super::noise::Patch;
use super::noise::{Noise, hash};
use super::shade::{mix, pick, shade};
use crate::color::Rgb;

/// Stretchers in running bond, three to a course, in pale mortar.
pub(crate) fn brick(x: i32, y: i32) -> Rgb {
    const BOND: Bond = Bond::new(&[
        Course { height: 11, start: 0, widths: &[21, 22, 21] },
        Course { height: 11, start: 11, widths: &[21, 21, 22] },
        Course { height: 10, start: 0, widths: &[21, 22, 21] },
        Course { height: 11, start: 10, widths: &[22, 21, 21] },
        Course { height: 11, start: 0, widths: &[21, 22, 21] },
        Course { height: 10, start: 11, widths: &[21, 21, 22] },
    ]);
    const FIRED: [Rgb; 5] = [
        Rgb::new(0xa8, 0x4a, 0x34),
        Rgb::new(0x9a, 0x42, 0x30),
        Rgb::new(0xb4, 0x58, 0x3c),
        Rgb::new(0x86, 0x3a, 0x30),
        Rgb::new(0xa2, 0x50, 0x3a),
    ];
    const MORTAR: Rgb = Rgb::new(0xb6, 0xa6, 0x92);
    const GRAIN: Noise = Noise::new(1, 8, 4);

    let brick = BOND.block(x, y);
    if brick.rim() == 0 {
        let under_a_brick = brick.y == 0;
        return shade(MORTAR, if under_a_brick { -70 } else { -20 } + GRAIN.at(x, y, 20));
    }
    shade(pick(FIRED, brick.id), brick.bevel(14) + GRAIN.at(x, y, 12))
}

/// Dressed blocks of several sizes with dark joints.
pub(crate) fn stone(x: i32, y: i32) -> Rgb {
    const BOND: Bond = Bond::new(&[
        Course { height: 22, start: 0, widths: &[36, 28] },
        Course { height: 19, start: 18, widths: &[24, 40] },
        Course { height: 23, start: 52, widths: &[36, 28] },
    ]);
    const HEWN: [Rgb; 3] =
        [Rgb::new(0x82, 0x88, 0x94), Rgb::new(0x6e, 0x74, 0x82), Rgb::new(0x94, 0x96, 0x9c)];
    const JOINT: Rgb = Rgb::new(0x26, 0x28, 0x32);
    const CHIPS: Noise = Noise::new(2, 4, 4);
    const FACE: Noise = Noise::new(3, 16, 8);

    let block = BOND.block(x, y);
    let worn = i32::from(CHIPS.at(x, y, 100) > 55);
    let rim = block.rim() - worn;
    if rim < 1 {
        return JOINT;
    }
    let edge = match rim {
        1 => block.slope() * 16,
        2 => block.slope() * 8,
        _ => 0,
    };
    let from_above = 18 - 36 * block.y / block.height;
    shade(pick(HEWN, block.id), edge + from_above + FACE.at(x, y, 16))
}

/// The wall of [`stone`], with moss.
pub(crate) fn moss(x: i32, y: i32) -> Rgb {
    const GREEN: Rgb = Rgb::new(0x52, 0x7a, 0x30);
    const CUSHIONS: Noise = Noise::new(4, 16, 16);
    const FRINGE: Noise = Noise::new(5, 4, 8);
    const DAMP: Rgb = Rgb::new(0x4c, 0x5c, 0x40);

    let cover = |x, y| CUSHIONS.at(x, y, 100) + FRINGE.at(x, y, 45);
    let here = cover(x, y);
    if here < 0 {
        return mix(stone(x, y), DAMP, 90);
    }
    let swell = here - cover(x - 1, y - 1);
    shade(GREEN, swell * 2 + here / 3 - 20)
}

/// High and low courses in turn, with visible layers.
pub(crate) fn sandstone(x: i32, y: i32) -> Rgb {
    const BOND: Bond = Bond::new(&[
        Course { height: 20, start: 0, widths: &[40, 24] },
        Course { height: 12, start: 20, widths: &[32, 32] },
        Course { height: 20, start: 8, widths: &[24, 40] },
        Course { height: 12, start: 52, widths: &[32, 32] },
    ]);
    const CUT: [Rgb; 3] =
        [Rgb::new(0xcc, 0xa6, 0x68), Rgb::new(0xc2, 0x9a, 0x5c), Rgb::new(0xd6, 0xb2, 0x78)];
    const JOINT: Rgb = Rgb::new(0x7a, 0x58, 0x34);
    const LAYERS: Noise = Noise::new(6, 32, 4);

    let block = BOND.block(x, y);
    if block.rim() == 0 {
        return JOINT;
    }
    shade(pick(CUT, block.id), block.bevel(12) + LAYERS.at(x + block.id * 5, y, 34))
}

/// Flat irregular stones, fitted together.
pub(crate) fn flagstone(x: i32, y: i32) -> Rgb {
    const POINTS: [(i32, i32); 9] =
        [(14, 6), (39, 3), (57, 14), (26, 26), (48, 31), (5, 30), (15, 47), (37, 51), (60, 49)];
    const SLATE: [Rgb; 4] = [
        Rgb::new(0x96, 0x86, 0x72),
        Rgb::new(0x82, 0x76, 0x68),
        Rgb::new(0xaa, 0x98, 0x7e),
        Rgb::new(0x74, 0x6c, 0x68),
    ];
    const JOINT: Rgb = Rgb::new(0x40, 0x38, 0x32);
    const FACE: Noise = Noise::new(7, 16, 16);

    let patch = Patch::around(POINTS.into_iter(), x, y);
    if patch.rim < 20 {
        return JOINT;
    }
    let edge = if patch.rim < 40 { -(patch.x + patch.y).signum() * 30 } else { 0 };
    let cleft = (hash(patch.id, 1, 7) % 24) as i32 - 12;
    shade(pick(SLATE, patch.id), edge + cleft + FACE.at(x, y, 14))
}
