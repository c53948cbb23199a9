//! What players find and take: treasure, healing and notes.

use super::{Design, INK, Palette, drawn};
use crate::color::Rgb;

/// A few coins.
pub(crate) fn coins() -> Design {
    const LINES: [&str; 8] = [
        "......kkkk......",
        ".....kYwYYk.....",
        ".....kyyyyk.....",
        ".kkkkkYwYYkkkkk.",
        "kYwYYkyyyykYwYYk",
        "kyyyykYwYYkyyyyk",
        "kYYYYkyyyykYYYYk",
        ".kkkkkkkkkkkkkk.",
    ];
    Design::standing(0.15, vec![drawn(&LINES, GOLD)])
}

/// A cup with two handles.
pub(crate) fn cup() -> Design {
    const LINES: [&str; 16] = [
        "..kkkkkkkkkk..",
        ".kYYwwYYYYyyk.",
        "kkYyyyyyyyykkk",
        "kYkYwwYYYyykYk",
        "kYkYwYYYYyykyk",
        "kYkYwYrrYyykyk",
        ".kYkwYrrYykyk.",
        "..kkYwYYyykk..",
        "....kYYyyk....",
        ".....kYyk.....",
        "......kk......",
        ".....kYyk.....",
        ".....kYyk.....",
        "...kkkYykkk...",
        "..kYwYYYyyyk..",
        "..kkkkkkkkkk..",
    ];
    Design::standing(0.26, vec![drawn(&LINES, GOLD)])
}

/// A crown with jewels.
pub(crate) fn crown() -> Design {
    const LINES: [&str; 15] = [
        ".........kk.........",
        "........krrk........",
        ".kk.....krrk.....kk.",
        "kbbk.....kk.....kbbk",
        "kbbk....kYyk....kbbk",
        ".kk....kYwYyk....kk.",
        ".kYk...kYwYyk...kyk.",
        ".kYYk.kYYwYYyk.kyyk.",
        ".kYwYkYYwwYYYykYyyk.",
        ".kYwYYYYwYYYYYYYyyk.",
        ".kYwYYYwwYYYYYyyyyk.",
        ".kkkkkkkkkkkkkkkkkk.",
        ".kYwYrrYwYbbYYYrryk.",
        ".kYwYrrYwYbbYYYrryk.",
        "..kkkkkkkkkkkkkkkk..",
    ];
    Design::standing(0.3, vec![drawn(&LINES, GOLD)])
}

const GOLD: &Palette = &[
    ('k', Rgb::new(0x48, 0x2c, 0x08)),
    ('Y', Rgb::new(0xfc, 0xc8, 0x38)),
    ('y', Rgb::new(0xc4, 0x88, 0x1c)),
    ('w', Rgb::new(0xff, 0xfc, 0xdc)),
    ('r', Rgb::new(0xe8, 0x30, 0x40)),
    ('b', Rgb::new(0x48, 0x88, 0xf0)),
];

/// A heart.
pub(crate) fn heart() -> Design {
    const LINES: [&str; 13] = [
        "..kkk....kkk..",
        ".kRRRk..kRRrk.",
        "kRwwRRkkRRRrrk",
        "kRwwRRRRRRRrrk",
        "kRwRRRRRRRRrrk",
        "kRRRRRRRRRRrrk",
        ".kRRRRRRRRrrk.",
        ".kRRRRRRRRrrk.",
        "..kRRRRRRrrk..",
        "...kRRRRrrk...",
        "....kRRrrk....",
        ".....kRrk.....",
        "......kk......",
    ];
    const COLORS: &Palette = &[
        ('k', Rgb::new(0x40, 0x0c, 0x18)),
        ('R', Rgb::new(0xec, 0x34, 0x48)),
        ('r', Rgb::new(0xac, 0x18, 0x38)),
        ('w', Rgb::new(0xff, 0xd8, 0xd8)),
    ];
    Design::standing(0.26, vec![drawn(&LINES, COLORS)])
}

/// A sheet of paper with lines of writing.
pub(crate) fn note() -> Design {
    const LINES: [&str; 16] = [
        ".kkkkkkkkkkk..",
        "kPPPPPPPPPPpk.",
        "kPkkPkkkPkPpk.",
        "kPPPPPPPPPPpk.",
        ".kPkkkPkkPPpk.",
        ".kPPPPPPPPPpk.",
        ".kPkkPkkkkPppk",
        ".kPPPPPPPPPppk",
        ".kPkkkkPkkPppk",
        ".kPPPPPPPPPppk",
        "kPPkkPkPPrrrk.",
        "kPPPPPPPPrrrk.",
        "kPPPPPPPPrrrk.",
        "kpppppppppppk.",
        ".kpppppppppk..",
        "..kkkkkkkkk...",
    ];
    const COLORS: &Palette = &[
        ('k', Rgb::new(0x50, 0x40, 0x30)),
        ('P', Rgb::new(0xf4, 0xe8, 0xc4)),
        ('p', Rgb::new(0xcc, 0xb4, 0x84)),
        ('r', Rgb::new(0xc0, 0x28, 0x28)),
    ];
    Design::standing(0.3, vec![drawn(&LINES, COLORS)])
}

/// Three pebbles.
pub(crate) fn pebbles() -> Design {
    const LINES: [&str; 8] = [
        ".....kkkkk......",
        "....kSSSssk.....",
        "....kSSsssk.....",
        ".kkkkSsssskkkkk.",
        "kSSSskkkkkSSSssk",
        "kSSsssk.kSSSsssk",
        "kssssskkkSssssk.",
        ".kkkkk...kkkkk..",
    ];
    Design::standing(0.16, vec![drawn(&LINES, STONE)])
}

/// A pebble that flies.
pub(crate) fn pebble() -> Design {
    const LINES: [&str; 6] = [
        "..kkk..", //
        ".kSSsk.", "kSSSssk", "kSSsssk", ".kssssk", "..kkkk.",
    ];
    Design::standing(0.1, vec![drawn(&LINES, STONE)])
}

const STONE: &Palette =
    &[('k', INK), ('S', Rgb::new(0xd4, 0xd0, 0xc8)), ('s', Rgb::new(0x94, 0x90, 0x90))];
