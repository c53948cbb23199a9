//! Players as others see them: a traveller with a broad hat and a cape, in eight colours.
//!
//! One sheet shows all of them. Its cloth is painted with a dye, which each colour replaces. The
//! pictures are made once for a process, because a host starts games all the time.
//!
//! A marked player, such as the seeker in a game of hide and seek, glows in every light: white-hot
//! from head to foot, with an arrow above the head. White is no player's colour, and brightness and
//! shape also show without colours. Rejected: red-hot. From afar it looked like a red player.

use std::num::NonZeroU32;
use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

use super::TRAVELLER;
use crate::color::Rgb;
use crate::world::sprite::SpriteHeight;
use crate::world::{Sprite, Texture};

/// The colour of a player's hat, cape and tunic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum PlayerColor {
    /// Red.
    Red,
    /// Sky blue.
    Sky,
    /// Yellow.
    Yellow,
    /// Violet.
    Violet,
    /// Green.
    Green,
    /// Pink.
    Pink,
    /// Orange.
    Orange,
    /// Dark blue.
    Blue,
}

impl PlayerColor {
    /// All colours, starting with the colours that are easiest to tell apart.
    pub const ALL: [Self; 8] = [
        Self::Red,
        Self::Sky,
        Self::Yellow,
        Self::Violet,
        Self::Green,
        Self::Pink,
        Self::Orange,
        Self::Blue,
    ];

    /// The name on the screen and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Red => "red",
            Self::Sky => "sky",
            Self::Yellow => "yellow",
            Self::Violet => "violet",
            Self::Green => "green",
            Self::Pink => "pink",
            Self::Orange => "orange",
            Self::Blue => "blue",
        }
    }

    /// The colour with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|color| color.name() == name)
    }

    /// The colour in full light.
    pub const fn rgb(self) -> Rgb {
        match self {
            Self::Red => Rgb::new(0xe0, 0x20, 0x28),
            Self::Sky => Rgb::new(0x40, 0xd8, 0xf0),
            Self::Yellow => Rgb::new(0xfc, 0xe8, 0x30),
            Self::Violet => Rgb::new(0xb0, 0x38, 0xe0),
            Self::Green => Rgb::new(0x28, 0xc0, 0x40),
            Self::Pink => Rgb::new(0xff, 0x98, 0xd0),
            Self::Orange => Rgb::new(0xff, 0x88, 0x10),
            Self::Blue => Rgb::new(0x20, 0x38, 0xd8),
        }
    }
}

/// The sprite of a player in this colour.
pub(crate) fn player(color: PlayerColor) -> Option<Sprite> {
    static SPRITES: OnceLock<[Option<Sprite>; PlayerColor::ALL.len()]> = OnceLock::new();
    let sprites = SPRITES.get_or_init(|| {
        PlayerColor::ALL.map(|color| TRAVELLER.recolored(move |texel| dyed(texel, color)))
    });
    sprites[color as usize].clone()
}

/// The colours of the arrow: its outline and its inside.
const ARROW: [Rgb; 2] = [Rgb::new(0xc0, 0x10, 0x10), Rgb::new(0xff, 0xf8, 0x90)];

/// The sprite of a marked player.
pub(crate) fn marked_player() -> Option<Sprite> {
    static SPRITE: OnceLock<Option<Sprite>> = OnceLock::new();
    let sprite = SPRITE.get_or_init(|| {
        let plain = TRAVELLER.recolored(white_hot)?;
        let rows = plain.pictures[0].height();
        // With the arrow, the figure is a little lower than a room.
        let above = rows * 2 / 7;
        let stretch = f64::from(rows + above) / f64::from(rows);
        let marked = |picture: &Texture| {
            let [width, rows] = [picture.width(), rows + above].map(NonZeroU32::new);
            let picture = picture.clone();
            Some(Texture::on_demand(width?, rows?, true, move || {
                let picture = picture.clone();
                move |x, y| match y.checked_sub(above) {
                    Some(y) => picture.texel(x, y),
                    None => arrow(x.abs_diff(picture.width() / 2), y, above),
                }
            }))
        };
        let pictures: Option<Vec<Texture>> = plain.pictures.iter().map(marked).collect();
        let height = SpriteHeight::new(plain.height.cells() * stretch)?;
        Some(Sprite { glows: true, height, pictures: pictures?.into(), ..plain })
    });
    sprite.clone()
}

/// Replaces a colour of the sheet by a colour of white-hot iron: red where the sheet is dark, and white
/// where it is as bright as cloth.
fn white_hot(texel: Rgb) -> Rgb {
    let share = |cooler: u32| (u32::from(texel.luma()) * 4).saturating_sub(cooler).min(255) as u8;
    Rgb::new(u8::MAX, share(40), share(56))
}

/// A texel of an arrow that points down and has `rows` rows, `aside` texels from its middle.
fn arrow(aside: u32, y: u32, rows: u32) -> (Rgb, u8) {
    let half = rows - y;
    let [outline, inside] = ARROW;
    match aside {
        _ if aside > half => (outline, 0),
        _ if aside == half || y == 0 => (outline, u8::MAX),
        _ => (inside, u8::MAX),
    }
}

/// The red and the blue value of dyed cloth in full light. Every other colour of the sheet has some
/// green.
const DYE: u8 = 0xd8;

/// Replaces the dye in a colour of the sheet by `color`.
fn dyed(texel: Rgb, color: PlayerColor) -> Rgb {
    let [across, none, down] = texel.channels().map(u32::from);
    if none > 0 || across == 0 {
        return texel;
    }
    let [red, green, blue] = color.rgb().channels().map(u32::from);
    let share = |channel: u32, of: u32| (channel * of / u32::from(DYE)).min(255) as u8;
    Rgb::new(share(red, across), share(green, across.midpoint(down)), share(blue, down))
}
