//! Furniture and lamps.

use super::{Anchor, Design, INK, Palette, drawn, painted};
use crate::color::Rgb;

/// A lantern on a chain, whose flame flickers. The last frame is without the flame.
pub(crate) fn lamp() -> Design {
    const FRAMES: [[&str; 14]; 3] = [
        [
            ".....k......",
            ".....k......",
            ".....k......",
            "....kkkk....",
            "...kmmmmk...",
            "..kkkkkkkk..",
            "..kyoooryk..",
            "..kyowwoyk..",
            "..kyywwoyk..",
            "..kyowwyyk..",
            "..kyoooyyk..",
            "..kkkkkkkk..",
            "...kmmmmk...",
            "....kkkk....",
        ],
        [
            ".....k......",
            ".....k......",
            ".....k......",
            "....kkkk....",
            "...kmmmmk...",
            "..kkkkkkkk..",
            "..kyyooyyk..",
            "..kyywooyk..",
            "..kyowwyyk..",
            "..kyywwooyk.",
            "..kyyooyyk..",
            "..kkkkkkkk..",
            "...kmmmmk...",
            "....kkkk....",
        ],
        [
            ".....k......",
            ".....k......",
            ".....k......",
            "....kkkk....",
            "...kmmmmk...",
            "..kkkkkkkk..",
            "..kgggggdk..",
            "..kgggddgk..",
            "..kggddggk..",
            "..kgdkggdk..",
            "..kddkdddk..",
            "..kkkkkkkk..",
            "...kmmmmk...",
            "....kkkk....",
        ],
    ];
    let pictures = FRAMES.iter().map(|frame| drawn(frame, FIRE)).collect();
    let design = Design { animated: Some(2), ..Design::standing(0.42, pictures) };
    Design { anchor: Anchor::Ceiling, seconds: 0.25, shines: 0.7, ..design }
}

/// A torch on a stand. The last frame is without the flame.
pub(crate) fn torch() -> Design {
    const FRAMES: [[&str; 22]; 4] = [
        [
            "....r.....",
            "....ro....",
            "...roo....",
            "...oyor...",
            "..royyo...",
            "..oywyor..",
            "..oywwyo..",
            "..royyor..",
            "...oooo...",
            "..kkkkkk..",
            "..kmmmmk..",
            "...kmmk...",
            "....km....",
            "....km....",
            "....km....",
            "....km....",
            "....km....",
            "....km....",
            "....km....",
            "...kkmk...",
            "..kkmmkk..",
            ".kkkkkkkk.",
        ],
        [
            "..........",
            ".....r....",
            "...r.or...",
            "...rooo...",
            "...oyyor..",
            "..royywo..",
            "..oywwyo..",
            "..oyywor..",
            "...oooo...",
            "..kkkkkk..",
            "..kmmmmk..",
            "...kmmk...",
            "....km....",
            "....km....",
            "....km....",
            "....km....",
            "....km....",
            "....km....",
            "....km....",
            "...kkmk...",
            "..kkmmkk..",
            ".kkkkkkkk.",
        ],
        [
            "...r......",
            "...rr.....",
            "....or....",
            "..roor....",
            "..oyoo....",
            "..oywyor..",
            ".roywwyo..",
            "..oywyor..",
            "...oooo...",
            "..kkkkkk..",
            "..kmmmmk..",
            "...kmmk...",
            "....km....",
            "....km....",
            "....km....",
            "....km....",
            "....km....",
            "....km....",
            "....km....",
            "...kkmk...",
            "..kkmmkk..",
            ".kkkkkkkk.",
        ],
        [
            "..........",
            "..........",
            "..........",
            "..........",
            "..........",
            "..........",
            "..........",
            "....d.....",
            "..dddgd...",
            "..kkkkkk..",
            "..kmmmmk..",
            "...kmmk...",
            "....km....",
            "....km....",
            "....km....",
            "....km....",
            "....km....",
            "....km....",
            "....km....",
            "...kkmk...",
            "..kkmmkk..",
            ".kkkkkkkk.",
        ],
    ];
    let pictures = FRAMES.iter().map(|frame| drawn(frame, FIRE)).collect();
    Design { seconds: 0.15, animated: Some(3), shines: 0.6, ..Design::standing(0.72, pictures) }
}

pub(crate) const FIRE: &Palette = &[
    ('k', INK),
    ('m', Rgb::new(0x6c, 0x62, 0x58)),
    ('r', Rgb::new(0xd8, 0x50, 0x20)),
    ('o', Rgb::new(0xff, 0xa8, 0x30)),
    ('y', Rgb::new(0xff, 0xdc, 0x60)),
    ('w', Rgb::new(0xff, 0xfc, 0xe0)),
    ('g', Rgb::new(0x58, 0x5c, 0x64)),
    ('d', Rgb::new(0x3c, 0x3c, 0x44)),
];

/// A plant with broad leaves in a pot.
pub(crate) fn plant() -> Design {
    const LINES: [&str; 20] = [
        ".......k........",
        "..kk..kGk..kk...",
        ".kGGkkGGkkkGGk..",
        ".kgGGkGgkGGGgk..",
        "..kgGGGgGGGgkk..",
        "kk.kgGGGGGgkGGk.",
        "kGkkkgGGGgkGGGk.",
        "kGGGGkgGgkGGgkk.",
        ".kgGGGkGkGGgk...",
        "..kkgGGGGGgkkk..",
        "kkkkkgGGGgkGGGk.",
        "kGGGGkgGgkGGGgk.",
        ".kgGGGkgkGGgkk..",
        "..kkkgkkkkkk....",
        "...kkkkkkkkkk...",
        "...kRRRRrrrrk...",
        "....kRRRrrrk....",
        "....kRRRrrrk....",
        ".....kRRrrk.....",
        ".....kkkkkk.....",
    ];
    const COLORS: &Palette = &[
        ('k', Rgb::new(0x14, 0x24, 0x18)),
        ('G', Rgb::new(0x5c, 0xb8, 0x48)),
        ('g', Rgb::new(0x34, 0x7c, 0x38)),
        ('R', Rgb::new(0xc8, 0x70, 0x44)),
        ('r', Rgb::new(0x94, 0x4c, 0x30)),
    ];
    Design::standing(0.6, vec![drawn(&LINES, COLORS)])
}

/// A barrel with three hoops.
pub(crate) fn barrel() -> Design {
    const WIDTH: i32 = 22;
    const HEIGHT: i32 = 26;
    const LID: i32 = 4;
    let picture = painted(WIDTH as u32, HEIGHT as u32, |x, y| {
        // Staves bulge by two texels in the middle.
        let from_middle = (2 * y - HEIGHT).abs();
        let half = 2 * 11 - 1 - from_middle * from_middle / 170;
        let across = 2 * x + 1 - WIDTH;
        if across.abs() > half {
            return None;
        }
        let light = 36 - (across + 8).abs() * 4;
        let is_edge = across.abs() > half - 2 || y == 0 || y == HEIGHT - 1;
        let is_hoop = [LID + 1, 12, 13, 21].contains(&y);
        let is_gap = (across + 23) % 8 < 2 && y > LID;
        Some(match () {
            () if is_edge => INK,
            () if is_hoop => lit(Rgb::new(0x70, 0x74, 0x7c), light),
            () if y <= LID => lit(Rgb::new(0xb4, 0x7c, 0x44), 10),
            () if is_gap => lit(Rgb::new(0x58, 0x34, 0x1c), light),
            () => lit(Rgb::new(0x9c, 0x60, 0x30), light),
        })
    });
    Design { blocks: true, ..Design::standing(0.58, vec![picture]) }
}

/// A fluted column from the floor to the ceiling.
pub(crate) fn column() -> Design {
    const WIDTH: i32 = 24;
    const HEIGHT: i32 = 64;
    const STONE: Rgb = Rgb::new(0xb8, 0xb4, 0xac);
    let picture = painted(WIDTH as u32, HEIGHT as u32, |x, y| {
        let from_end = y.min(HEIGHT - 1 - y);
        let half = match from_end {
            0..=3 => 12,
            4..=5 => 11,
            6..=7 => 10,
            _ => 8,
        };
        let across = 2 * x + 1 - WIDTH;
        if across.abs() >= 2 * half {
            return None;
        }
        let is_edge = across.abs() >= 2 * half - 2 || [0, 3, 5].contains(&from_end);
        let flute = if from_end > 7 && (across + 24) % 8 >= 6 { -34 } else { 0 };
        let light = 40 - (across + 6).abs() * 6 + flute;
        Some(if is_edge { lit(STONE, light - 60) } else { lit(STONE, light) })
    });
    Design { blocks: true, ..Design::standing(1.0, vec![picture]) }
}

/// A table, seen from the front.
pub(crate) fn table() -> Design {
    const LINES: [&str; 12] = [
        "..kkkkkkkkkkkkkkkkkkkk..",
        ".kWWWWWWWWWWWWWWWWWWWWk.",
        "kWWWWWWWWWWWWWWWWWWWWWWk",
        "kwwwwwwwwwwwwwwwwwwwwwwk",
        "kkkkkkkkkkkkkkkkkkkkkkkk",
        "..kwwk.kwwwwwwwwk.kwwk..",
        "..kwwk..kkkkkkkk..kwwk..",
        "..kwwk............kwwk..",
        "..kwwk............kwwk..",
        "..kwwk............kwwk..",
        "..kwwk............kwwk..",
        "..kkkk............kkkk..",
    ];
    const COLORS: &Palette = &[
        ('k', Rgb::new(0x30, 0x1c, 0x14)),
        ('W', Rgb::new(0xc4, 0x90, 0x54)),
        ('w', Rgb::new(0x8c, 0x5c, 0x34)),
    ];
    Design { blocks: true, ..Design::standing(0.42, vec![drawn(&LINES, COLORS)]) }
}

/// `color` made brighter or darker by this many 128ths of itself.
fn lit(color: Rgb, light: i32) -> Rgb {
    let channel = |channel: u8| (i32::from(channel) * (128 + light) / 128).clamp(0, 255) as u8;
    let [red, green, blue] = color.channels().map(channel);
    Rgb::new(red, green, blue)
}
