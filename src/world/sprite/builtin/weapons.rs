//! Darts, flasks and what comes of them, and the archer's bolt.

use super::{Design, Facings, INK, Palette, drawn, mirrored, painted};
use crate::color::Rgb;
use crate::world::Texture;

/// Two crossed darts with red feathers.
pub(crate) fn darts() -> Design {
    const LINES: [&str; 14] = [
        "kkk........kkk",
        "kSSk......kSSk",
        "kSSSk....kSSSk",
        ".kSSSk..kSSSk.",
        "..kkWWkkWWkk..",
        "....kWWWWk....",
        ".....kWWk.....",
        "....kWWWWk....",
        "...kWWkkWWk...",
        ".kkWWk..kWWkk.",
        "kRRWk....kWRRk",
        "kRRRk....kRRRk",
        "kRRRk....kRRRk",
        ".kkk......kkk.",
    ];
    Design::standing(0.24, vec![drawn(&LINES, DART)])
}

/// A dart that flies.
pub(crate) fn dart() -> Design {
    const SIDE: [&str; 5] = [
        "kkk.............",
        "kRRkkkkkkkkkkkk.",
        "kRRWWWWWWWWSSSSk",
        "kRRkkkkkkkkkkkk.",
        "kkk.............",
    ];
    flying(0.08, &SIDE, STEEL)
}

/// The archer's bolt, which flies. Its point gleams, so that players see it come.
pub(crate) fn bolt() -> Design {
    const SIDE: [&str; 7] = [
        "kkkk................",
        "kwwwk..........kkkk.",
        ".kwwwkkkkkkkkkkkSSSk",
        "..kWWWWWWWWWWWWWwwSk",
        ".kwwwkkkkkkkkkkkSSSk",
        "kwwwk..........kkkk.",
        "kkkk................",
    ];
    flying(0.14, &SIDE, Rgb::WHITE)
}

/// A missile of that height that flies with its point, of colour `point`, in front. `side` shows it
/// from its right.
fn flying(height: f64, side: &[&'static str], point: Rgb) -> Design {
    let (columns, rows) = (side[0].len() as i32, side.len() as i32);
    let end = |color| {
        painted(columns as u32, rows as u32, move |x, y| {
            let (across, above) = (2 * x + 1 - columns, 2 * y + 1 - rows);
            let squared = across * across + above * above;
            let is_within = |radius: i32| squared < radius * radius;
            is_within(rows).then_some(if is_within(rows - 2) { color } else { INK })
        })
    };
    let pictures = vec![end(point), drawn(side, DART), end(FEATHER), mirrored(side, DART)];
    Design { facings: Facings::Four, ..Design::standing(height, pictures) }
}

const STEEL: Rgb = Rgb::new(0xe0, 0xe8, 0xf0);
const FEATHER: Rgb = Rgb::new(0xe0, 0x30, 0x30);
const DART: &Palette = &[
    ('k', INK),
    ('S', STEEL),
    ('W', Rgb::new(0xb0, 0x7c, 0x44)),
    ('R', FEATHER),
    ('w', Rgb::new(0xf4, 0xf4, 0xec)),
];

/// Two flasks of smoke.
pub(crate) fn flasks() -> Design {
    const LINES: [&str; 14] = [
        "...kk...........",
        "..kCCk....kk....",
        "..kkkk...kCCk...",
        "..kGgk...kkkk...",
        "..kGgk...kGgk...",
        ".kGGggk..kGgk...",
        "kGwGgggkkGGggk..",
        "kGwVVvvkGwGgggk.",
        "kVwVVvvkGwVVvvk.",
        "kVVVVvvkVwVVvvk.",
        "kVVVvvvkVVVVvvk.",
        ".kVVvvkkVVVvvvk.",
        "..kkkk..kVVvvk..",
        ".........kkkk...",
    ];
    Design::standing(0.24, vec![drawn(&LINES, FLASK)])
}

/// A flask that flies.
pub(crate) fn flask() -> Design {
    const LINES: [&str; 9] = [
        "......kkk",
        ".....kCCk",
        "..kkkkCkk",
        ".kGGGkkk.",
        "kGwGGggk.",
        "kVwVVvvk.",
        "kVVVVvvk.",
        ".kVVvvk..",
        "..kkkk...",
    ];
    Design::standing(0.15, vec![drawn(&LINES, FLASK)])
}

const FLASK: &Palette = &[
    ('k', INK),
    ('C', Rgb::new(0xb8, 0x84, 0x50)),
    ('G', Rgb::new(0xc8, 0xe4, 0xe0)),
    ('g', Rgb::new(0x90, 0xb4, 0xb8)),
    ('V', Rgb::new(0xb0, 0x60, 0xd0)),
    ('v', Rgb::new(0x74, 0x38, 0x98)),
    ('w', Rgb::new(0xff, 0xff, 0xff)),
];

/// A cloud of smoke, with holes, that billows.
pub(crate) fn smoke() -> Design {
    let pictures = (0..FRAMES).map(smoke_picture).collect();
    Design { seconds: 0.25, ..Design::standing(0.9, pictures) }
}

const FRAMES: i32 = 4;
/// The side of the picture of smoke, in texels.
const CLOUD: i32 = 28;

fn smoke_picture(frame: i32) -> Texture {
    // Puffs: the middle, in texels, and the radius. Each rises and comes back.
    const PUFFS: [[i32; 3]; 9] = [
        [14, 14, 8],
        [7, 19, 6],
        [21, 18, 6],
        [9, 9, 5],
        [19, 8, 5],
        [14, 22, 5],
        [4, 13, 3],
        [24, 12, 3],
        [14, 4, 3],
    ];
    painted(CLOUD as u32, CLOUD as u32, move |x, y| {
        let depth_in = |(index, &[across, down, radius]): (usize, &[i32; 3])| {
            let moved = [0, 1, 2, 1][(frame as usize + index * 3) % FRAMES as usize];
            let (x, y) = (x - across, y - down + moved);
            let squared = x * x + y * y;
            // A puff is lighter at its upper left.
            (squared <= radius * radius).then_some(2 * radius * radius - squared - (x + y) * radius)
        };
        let thickest = PUFFS.iter().enumerate().filter_map(depth_in).max()?;
        // Holes wander through the edge of the cloud.
        let hole = ((x + y / 2 + frame * 2) % 7, (y + 28 - x / 3 + frame * 3) % 6);
        if thickest < 52 && hole.0 < 3 && hole.1 < 3 {
            return None;
        }
        Some(match thickest {
            ..12 => Rgb::new(0x68, 0x60, 0x74),
            12..48 => Rgb::new(0x90, 0x88, 0x9c),
            48..90 => Rgb::new(0xb4, 0xb0, 0xbc),
            _ => Rgb::new(0xd4, 0xd0, 0xd8),
        })
    })
}

/// Three stars above somebody who is stunned.
pub(crate) fn star() -> Design {
    const FRAMES: [[&str; 9]; 2] = [
        [
            "....k.............",
            "...kYk........k...",
            ".kkkYkkk.....kYk..",
            "kYYYwYYYk..kkkYkkk",
            ".kkYYYkk...kYYwYYk",
            "..kYkYk.kkk.kkYkk.",
            ".kYk.kYkkYk..kYk..",
            ".kk...kYYwYYk.k...",
            ".......kkYkk......",
        ],
        [
            "..........k.......",
            "...k.....kYk......",
            "..kYk..kkkYkkk....",
            "kkkYkkkYYYwYYYk.k.",
            "kYYwYYkkkYYYkk.kYk",
            ".kkYkk..kYkYkkkkYk",
            "..kYk..kYk.kYYYwYY",
            "...k...kk...kkkYkk",
            "..............kYk.",
        ],
    ];
    const COLORS: &Palette = &[
        ('k', Rgb::new(0x50, 0x38, 0x08)),
        ('Y', Rgb::new(0xff, 0xe0, 0x48)),
        ('w', Rgb::new(0xff, 0xff, 0xf0)),
    ];
    let pictures = FRAMES.iter().map(|frame| drawn(frame, COLORS)).collect();
    Design { seconds: 0.3, ..Design::standing(0.2, pictures) }
}
