//! Keys and bones.

use super::{Design, INK, Palette, drawn};
use crate::color::Rgb;

/// A key that glints.
pub(crate) fn key() -> Design {
    const FRAMES: [[&str; 10]; 4] = [
        [
            "................",
            "..kkkk..........",
            ".kYYYYk.........",
            "kYYkkYYkkkkkkkk.",
            "kYk..kYYYYYYYYYk",
            "kyk..kyyyyyyyyyk",
            "kyykkyykkkykykk.",
            ".kyyyyk..kykyk..",
            "..kkkk...kkkkk..",
            "................",
        ],
        [
            "................",
            "..kkkk..........",
            ".kwwYYk.........",
            "kwwkkYYkkkkkkkk.",
            "kwk..kYYYYYYYYYk",
            "kyk..kyyyyyyyyyk",
            "kyykkyykkkykykk.",
            ".kyyyyk..kykyk..",
            "..kkkk...kkkkk..",
            "................",
        ],
        [
            "................",
            "..kkkk..........",
            ".kYYYYk.........",
            "kYYkkwwkkkkkkkk.",
            "kYk..kwwwYYYYYYk",
            "kyk..kwwyyyyyyyk",
            "kyykkyykkkykykk.",
            ".kyyyyk..kykyk..",
            "..kkkk...kkkkk..",
            "................",
        ],
        [
            "................",
            "..kkkk..........",
            ".kYYYYk.........",
            "kYYkkYYkkkkkkkk.",
            "kYk..kYYYYYwwwwk",
            "kyk..kyyyyywwwyk",
            "kyykkyykkkykykk.",
            ".kyyyyk..kykyk..",
            "..kkkk...kkkkk..",
            "................",
        ],
    ];
    const COLORS: &Palette = &[
        ('k', Rgb::new(0x48, 0x30, 0x08)),
        ('Y', Rgb::new(0xfc, 0xd0, 0x48)),
        ('y', Rgb::new(0xcc, 0x94, 0x20)),
        ('w', Rgb::new(0xff, 0xfc, 0xe4)),
    ];
    let pictures = FRAMES.iter().map(|frame| drawn(frame, COLORS)).collect();
    Design { seconds: 0.35, ..Design::standing(0.3, pictures) }
}

/// A skull on some bones.
pub(crate) fn bones() -> Design {
    const LINES: [&str; 12] = [
        "......kkkkkk......",
        ".....kBBBBBbk.....",
        "....kBBBBBBBbk....",
        "....kBkkBBkkbk....",
        "....kBkkBBkkbk....",
        "....kBBBkkBBbk....",
        ".kk..kBBBBBbk..kk.",
        "kBBkkkbBbBbkkkkBBk",
        "kBBBBBkkkkkkBBBBbk",
        ".kkkBBBBBBBBBbkkk.",
        "kBBBBBkkkkkkBBBBbk",
        ".kkkkk......kkkkk.",
    ];
    const COLORS: &Palette =
        &[('k', INK), ('B', Rgb::new(0xe8, 0xe0, 0xcc)), ('b', Rgb::new(0xb0, 0xa4, 0x8c))];
    Design::standing(0.26, vec![drawn(&LINES, COLORS)])
}
