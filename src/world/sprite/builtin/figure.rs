//! Figures, which have a front and a back.

use super::{Design, INK, Palette, drawn, mirrored};
use crate::color::Rgb;
use crate::world::sprite::Facings;

/// A statue of a knight with a shield and a spear.
pub(crate) fn statue() -> Design {
    // From the front, then from the side of the shield, and so on around it.
    let pictures = vec![
        drawn(&FRONT, COLORS),
        mirrored(&SHIELD_SIDE, COLORS),
        drawn(&BACK, COLORS),
        mirrored(&SPEAR_SIDE, COLORS),
    ];
    Design { facings: Facings::Four, blocks: true, ..Design::standing(0.85, pictures) }
}

const FRONT: [&str; 26] = [
    "................k...",
    "......kkkkkk....kk..",
    ".....kSSSSssk..kSSk.",
    ".....kSSSSssk...kk..",
    ".....kkkSkkkk...k...",
    ".....kSSSSssk...k...",
    "......kSSssk....k...",
    "...kkkkSSsskkk..k...",
    "..kSSSSSSSsssskkk...",
    ".kkkkkkkSSSsssSSk...",
    "kRRRwRRkSSSsskSSk...",
    "kRRwwwRkSSSsskkkk...",
    "kRRRwRRkSSSssk..k...",
    "kRRRwRRkkkkkkk..k...",
    ".kRRwRkkSSSssk..k...",
    "..kRRkkSSSSsssk.k...",
    "...kkkkSSSSsssk.k...",
    "....kSSSSkkssssk....",
    "....kSSSk..kssk.....",
    "....kSSSk..kssk.....",
    "....kSSSk..kssk.....",
    "....kSSSk..kssk.....",
    "...kkSSSkkkksskk....",
    "..kBBBBBBBBbbbbbk...",
    ".kBBBBBBBBBbbbbbbk..",
    ".kkkkkkkkkkkkkkkkk..",
];

const BACK: [&str; 26] = [
    "...k................",
    "..kk....kkkkkk......",
    ".kSSk..kSSSSssk.....",
    "..kk...kSSSSssk.....",
    "...k...kSSSSssk.....",
    "...k...kSSSSssk.....",
    "...k....kSSssk......",
    "...k..kkkSSsskkkk...",
    "...kkkSSSSSSSssssk..",
    "...kSSSSSSSSssskkkk.",
    "...kSSkSSSSSsskkRRk.",
    "...kkkkSSSSSsskkRRRk",
    "...k..kSSSSSsskkRRRk",
    "...k..kkkkkkkkkkRRk.",
    "...k..kSSSSSssk.kk..",
    "...k.kSSSSSSsssk....",
    "...k.kSSSSSSsssk....",
    "....kSSSSSkkssssk...",
    ".....kSSSk..kssk....",
    ".....kSSSk..kssk....",
    ".....kSSSk..kssk....",
    ".....kSSSk..kssk....",
    "....kkSSSkkkksskk...",
    "...kBBBBBBBBbbbbbk..",
    "..kBBBBBBBBBbbbbbbk.",
    "..kkkkkkkkkkkkkkkkk.",
];

const SHIELD_SIDE: [&str; 26] = [
    "....................",
    ".......kkkkk........",
    "......kSSSssk.......",
    "......kSSSssk.......",
    ".....kkkSSssk.......",
    "......kSSSssk.......",
    ".......kSssk........",
    "......kkSsskk.......",
    ".....kSSSSsssk......",
    "...kkkkkkkSssk......",
    "..kRRRwRRkSssk......",
    "..kRRwwwRkSssk......",
    "..kRRRwRRkSssk......",
    "..kRRRwRRkkkkk......",
    "...kRRwRkSsssk......",
    "....kRRkSSsssk......",
    ".....kkkSSsssk......",
    ".......kSSsssk......",
    ".......kSSssk.......",
    ".......kSSssk.......",
    ".......kSSssk.......",
    ".......kSSssk.......",
    "......kkSSsskk......",
    "...kBBBBBBBbbbbbk...",
    "..kBBBBBBBBbbbbbbk..",
    "..kkkkkkkkkkkkkkkk..",
];

const SPEAR_SIDE: [&str; 26] = [
    "...k................",
    "..kk...kkkkk........",
    ".kSSk.kSSSssk.......",
    "..kk..kSSSssk.......",
    "...k..kSSSskkk......",
    "...k..kSSSssk.......",
    "...k...kSssk........",
    "...k..kkSsskk.......",
    "...k.kSSSSsssk......",
    "...kkSSSSSsssk......",
    "...kSSSSSSsssk......",
    "...kkkkSSSsssk......",
    "...k..kSSSsssk......",
    "...k..kkkkkkkk......",
    "...k..kSSsssk.......",
    "...k.kSSSssssk......",
    "...k.kSSSssssk......",
    "......kSSsssk.......",
    ".......kSSssk.......",
    ".......kSSssk.......",
    ".......kSSssk.......",
    ".......kSSssk.......",
    "......kkSSsskk......",
    "...kBBBBBBBbbbbbk...",
    "..kBBBBBBBBbbbbbbk..",
    "..kkkkkkkkkkkkkkkk..",
];

const COLORS: &Palette = &[
    ('k', INK),
    ('S', Rgb::new(0xb8, 0xbc, 0xc4)),
    ('s', Rgb::new(0x80, 0x84, 0x90)),
    ('R', Rgb::new(0xa8, 0x34, 0x30)),
    ('w', Rgb::new(0xe8, 0xe0, 0xd0)),
    ('B', Rgb::new(0x90, 0x8c, 0x84)),
    ('b', Rgb::new(0x64, 0x60, 0x5c)),
];
