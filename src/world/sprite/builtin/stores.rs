//! What stores, halls and studies hold: crates, chests, banners, braziers and books.

use super::furniture::FIRE;
use super::{Anchor, Design, INK, Palette, drawn};
use crate::color::Rgb;

/// A crate of boards with a diagonal brace.
pub(crate) fn crate_of_boards() -> Design {
    const LINES: [&str; 20] = [
        ".kkkkkkkkkkkkkkkkkk.",
        "kWWWWWWWWWWWWWWWWWwk",
        "kWkkkkkkkkkkkkkkkkwk",
        "kWkWWWwkWWwkWWwkYYwk",
        "kWkWWWwkWWwkWWkYYkwk",
        "kWkWWWwkWWwkWkYYkkwk",
        "kWkWWWwkWWwkkYYkwkwk",
        "kWkWWWwkWWwkYYkwwkwk",
        "kWkWWWwkWWkYYkwwwkwk",
        "kWkWWWwkWkYYkkwwwkwk",
        "kWkWWWwkkYYkwkwwwkwk",
        "kWkWWWwkYYkwwkwwwkwk",
        "kWkWWWkYYkkwwkwwwkwk",
        "kWkWWkYYkwkwwkwwwkwk",
        "kWkWkYYkwwkwwkwwwkwk",
        "kWkkYYkwwwkwwkwwwkwk",
        "kWkYYkwwwwkwwkwwwkwk",
        "kWkkkkkkkkkkkkkkkkwk",
        "kwwwwwwwwwwwwwwwwwwk",
        ".kkkkkkkkkkkkkkkkkk.",
    ];
    Design { blocks: true, ..Design::standing(0.55, vec![drawn(&LINES, WOOD)]) }
}

/// A chest with iron bands and a lock.
pub(crate) fn chest() -> Design {
    const LINES: [&str; 15] = [
        "...kkkkkkkkkkkkkk...",
        "..kWIIWWWWWWWWIIwk..",
        ".kWWIIWWWWWWWWIIwwk.",
        "kWWWIIWWWWWWWWIIwwwk",
        "kWWWIIWWWWWWWWIIwwwk",
        "kWWWIiWWWWWWWWIiwwwk",
        "kkkkkkkkkYYkkkkkkkkk",
        "kIIIIIIIkYYkIIIIIIIk",
        "kkkkkkkkkYYkkkkkkkkk",
        "kWWWIiWWkkkkWWIiwwwk",
        "kWWWIiWWWWWWWWIiwwwk",
        "kWWWIiWWWWWWWWIiwwwk",
        "kWWWIiWWWWWWWWIiwwwk",
        "kwwwIiwwwwwwwwIiwwwk",
        ".kkkkkkkkkkkkkkkkkk.",
    ];
    Design { blocks: true, ..Design::standing(0.38, vec![drawn(&LINES, WOOD)]) }
}

const WOOD: &Palette = &[
    ('k', Rgb::new(0x30, 0x1c, 0x14)),
    ('W', Rgb::new(0xb4, 0x78, 0x40)),
    ('w', Rgb::new(0x84, 0x50, 0x2c)),
    ('I', Rgb::new(0xa0, 0xa4, 0xac)),
    ('i', Rgb::new(0x68, 0x6c, 0x78)),
    ('Y', Rgb::new(0xe8, 0xb8, 0x50)),
];

/// A red banner with a golden emblem, which hangs from the ceiling.
pub(crate) fn banner() -> Design {
    const LINES: [&str; 24] = [
        "kkkkkkkkkkkkkkkk",
        "kYYYYYYYYYYYYYyk",
        "kkkkkkkkkkkkkkkk",
        ".kRRRRRRRrrrrrk.",
        ".kRRRRRRRrrrrrk.",
        ".kRYRRRRRrrrYrk.",
        ".kRYYRRYYrrYYrk.",
        ".kRRYRRYYrrYrrk.",
        ".kRRYYRYYrYYrrk.",
        ".kRRRYYYYYYrrrk.",
        ".kRRRRYYYYrrrrk.",
        ".kRRRRRYYrrrrrk.",
        ".kRRRRYYYYrrrrk.",
        ".kRRRRYYYYrrrrk.",
        ".kRRRRRYYrrrrrk.",
        ".kRRRRRRRrrrrrk.",
        ".kRRRRRRRrrrrrk.",
        ".kYYYYYYYyyyyyk.",
        ".kRRRRRRRrrrrrk.",
        "..kRRRRRRrrrrk..",
        "...kRRRRRrrrk...",
        "....kRRRRrrk....",
        ".....kRRRrk.....",
        "......kkkk......",
    ];
    const COLORS: &Palette = &[
        ('k', INK),
        ('R', Rgb::new(0xb8, 0x28, 0x30)),
        ('r', Rgb::new(0x84, 0x1c, 0x2c)),
        ('Y', Rgb::new(0xf0, 0xc0, 0x48)),
        ('y', Rgb::new(0xb8, 0x88, 0x2c)),
    ];
    let design = Design::standing(0.7, vec![drawn(&LINES, COLORS)]);
    Design { anchor: Anchor::Ceiling, ..design }
}

/// A pile of books.
pub(crate) fn books() -> Design {
    const LINES: [&str; 12] = [
        "....kkkkkkkkk...",
        "...kGGGGGGGGgk..",
        "..kkGGGGGGGGgk..",
        "..kPPPPPPPPPkk..",
        ".kkkkkkkkkkkkk..",
        ".kBBBBYYBBBBbbk.",
        ".kBBBBYYBBBBbbk.",
        ".kkPPPPPPPPPPPk.",
        "kkkkkkkkkkkkkkkk",
        "kRRRYRRRRRRYRrrk",
        "kRRRYRRRRRRYRrrk",
        ".kkkkkkkkkkkkkk.",
    ];
    const COLORS: &Palette = &[
        ('k', INK),
        ('G', Rgb::new(0x50, 0x98, 0x60)),
        ('g', Rgb::new(0x30, 0x68, 0x44)),
        ('B', Rgb::new(0x48, 0x70, 0xb8)),
        ('b', Rgb::new(0x30, 0x4c, 0x84)),
        ('R', Rgb::new(0xb0, 0x40, 0x34)),
        ('r', Rgb::new(0x7c, 0x2c, 0x28)),
        ('Y', Rgb::new(0xe0, 0xb8, 0x58)),
        ('P', Rgb::new(0xec, 0xe0, 0xc4)),
    ];
    Design::standing(0.2, vec![drawn(&LINES, COLORS)])
}

/// A bowl of embers on three legs, whose flames flicker. The last frame is without them.
pub(crate) fn brazier() -> Design {
    const FLAMES: [[&str; 8]; 4] = [
        [
            "......r.........",
            "......ro..r.....",
            "...r.roo.ro.....",
            "...oroyo.oor....",
            "..rooyyyooyo....",
            "..oyyywyyoyor...",
            "..oyywwwyyyyo...",
            "..ryywwwwyyor...",
        ],
        [
            "..........r.....",
            ".....r...or.....",
            ".....or..oo.....",
            "...r.oorroyo....",
            "...ooyyooyyo.r..",
            "..ryyywyyyyooo..",
            "..oyywwwwyyyyo..",
            "..oyywwwwwyyor..",
        ],
        [
            "....r...........",
            "....r...r.......",
            "...oo..ro..r....",
            "...oyr.oyoro....",
            "..royyooyyoo....",
            "..oyyyyywyyor...",
            ".royywwwwwyyo...",
            "..oyywwwwyyyr...",
        ],
        [
            "................",
            "................",
            "................",
            "................",
            "................",
            "................",
            "......d..d......",
            "...ddgddgddd....",
        ],
    ];
    const BOWL: [&str; 12] = [
        "kkkkkkkkkkkkkkkk",
        "kmmmmmmmmmmmmmmk",
        ".kmmmmmmmmmmmmk.",
        ".kkmmmmmmmmmmkk.",
        "..kkkmmmmmmkkk..",
        "..km.kkkkkk.mk..",
        "..km...kk...mk..",
        "..km...km...mk..",
        ".kmk...km...kmk.",
        ".km....km....mk.",
        ".km....km....mk.",
        "kkk...kkkk...kkk",
    ];
    let picture = |flames: &[&'static str; 8]| drawn(&[&flames[..], &BOWL].concat(), FIRE);
    let pictures = FLAMES.iter().map(picture).collect();
    let design = Design { seconds: 0.15, animated: Some(3), ..Design::standing(0.6, pictures) };
    Design { blocks: true, shines: 0.7, ..design }
}
