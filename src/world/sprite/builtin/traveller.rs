//! Players as others see them: a traveller with a broad hat and a cape, in eight colours.
//!
//! A picture is computed once for a process, in one colour, of which those of all players are
//! variants. Computing it for each game was refused: a host begins games all the time.

use std::sync::OnceLock;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::guard::{arms, legs};
use super::model::skeleton::{Build, Joints, Pose};
use super::model::{self, Model, Paint, Size, glowing, matt};
use super::{Design, Facings, PlayerFrame, painted};
use crate::color::Rgb;
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
    /// All colours, in the order in which they are easiest to tell apart.
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

    /// The colour with that name.
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

/// The sprite of a player of that colour.
pub(crate) fn player(color: PlayerColor) -> Option<Sprite> {
    static SPRITES: OnceLock<Vec<Option<Sprite>>> = OnceLock::new();
    let sprites = SPRITES.get_or_init(|| {
        let in_color = |color| (0..undyed().len()).map(|index| dyed(index, color)).collect();
        PlayerColor::ALL.map(|color| design(in_color(color)).sprite()).to_vec()
    });
    sprites.get(color as usize)?.clone()
}

/// The pictures before they are dyed.
fn undyed() -> &'static [Texture] {
    static PICTURES: OnceLock<Vec<Texture>> = OnceLock::new();
    PICTURES.get_or_init(|| model::pictures(PlayerFrame::ALL, model, SIZE))
}

/// The height of a player's pictures, in cells, and their size in texels.
const HEIGHT: f64 = 0.76;
const SIZE: Size = Size { width: 42, height: 28 };

fn design(pictures: Vec<Texture>) -> Design {
    let standing = Design::standing(HEIGHT, pictures);
    Design { facings: Facings::Eight, animated: Some(1), ..standing }
}

/// The paint of what is dyed: no other paint, lit or not, is without green.
const DYE: u8 = 0xd8;
const CLOTH: Paint = matt(DYE, 0, DYE);
const DARK_CLOTH: Paint = matt(DYE / 2 + 0x20, 0, DYE / 2 + 0x20);
const SHIRT: Paint = matt(0xf0, 0xe8, 0xd8);
const TROUSERS: Paint = matt(0x68, 0x58, 0x50);
const BOOTS: Paint = matt(0x54, 0x40, 0x34);
const BELT: Paint = matt(0x50, 0x38, 0x20);
const BUCKLE: Paint = matt(0xf0, 0xd0, 0x60);
const SKIN: Paint = matt(0xf0, 0xc0, 0x98);
const HAIR: Paint = matt(0x58, 0x3c, 0x2c);
const EYES: Paint = glowing(0x20, 0x1c, 0x24);
const CLUB: Paint = matt(0xa0, 0x70, 0x44);

const BUILD: Build = Build { legs: 7.4, trunk: 7.2, neck: 3.4, shoulder: 3.8, hip: 1.8, arms: 9.2 };

/// The picture with this index, with the dye of that colour.
fn dyed(index: usize, color: PlayerColor) -> Texture {
    let [red, green, blue] = color.rgb().channels().map(u32::from);
    let picture = &undyed()[index];
    painted(picture.width(), picture.height(), move |x, y| {
        let (texel, alpha) = picture.texel(x as u32, y as u32);
        let [across, none, down] = texel.channels().map(u32::from);
        let share = |channel: u32, of: u32| (channel * of / u32::from(DYE)).min(255) as u8;
        let is_dyed = none == 0 && across > 0;
        let color = if is_dyed {
            let middle = across.midpoint(down);
            Rgb::new(share(red, across), share(green, middle), share(blue, down))
        } else {
            texel
        };
        (alpha > 0).then_some(color)
    })
}

/// The model of a frame.
fn model(frame: PlayerFrame) -> Model {
    let joints = Joints::new(&BUILD, &pose(frame));
    let mut model = Model::default();
    legs(&mut model, &joints, [2.0, 1.6], TROUSERS, BOOTS);
    trunk(&mut model, &joints);
    arms(&mut model, &joints, [1.8, 1.5], CLOTH, SKIN);
    head(&mut model, &joints);
    club(&mut model, &joints, frame);
    model
}

fn pose(frame: PlayerFrame) -> Pose {
    let stand = Pose {
        hands: [[1.0, -5.4, -7.0], [1.5, 5.4, -6.8]],
        feet: [[0.0, -0.4, 0.0], [0.0, 0.4, 0.0]],
        holds: [0.8, 0.1, -0.5],
        ..Pose::UPRIGHT
    };
    match frame {
        PlayerFrame::Stand => stand,
        PlayerFrame::WalkLeft => Pose {
            hands: [[-3.5, -5.0, -6.5], [4.5, 5.0, -6.0]],
            lean: 6.0,
            ..stand.in_stride(3.8)
        },
        PlayerFrame::WalkRight => Pose {
            hands: [[4.5, -5.0, -6.0], [-3.5, 5.0, -6.5]],
            lean: 6.0,
            ..stand.in_stride(-3.8)
        },
        PlayerFrame::Strike => Pose {
            hips: [0.5, 0.0, -0.8],
            lean: 22.0,
            nod: -12.0,
            twist: -18.0,
            hands: [[-2.0, -5.5, -5.0], [7.0, 2.5, 1.0]],
            feet: [[-3.5, -1.2, 0.0], [4.0, 1.2, 0.0]],
            holds: [0.9, 0.0, 0.7],
            ..stand
        },
        PlayerFrame::Duck => Pose {
            hips: [-1.5, 0.0, -3.6],
            lean: 34.0,
            nod: -26.0,
            hands: [[4.5, -4.0, -6.0], [4.5, 4.5, -5.5]],
            feet: [[2.5, -1.2, 0.0], [-2.0, 1.2, 0.0]],
            ..stand
        },
        PlayerFrame::Down => Pose {
            hips: [2.0, 0.0, -4.8],
            tilt: 90.0,
            hands: [[1.0, -8.5, -2.0], [0.0, 8.0, -4.0]],
            feet: [[0.0, -1.6, 0.0], [0.5, 2.0, 0.5]],
            holds: [0.0, 1.0, -0.2],
            ..stand
        },
    }
}

fn trunk(model: &mut Model, joints: &Joints) {
    let Joints { hips, chest, legs, .. } = *joints;
    for [hip, knee, _] in legs {
        // The tunic covers the thighs.
        model.limb([hip, hip + (knee - hip) * 0.9], [2.4, 2.7], CLOTH);
    }
    model.limb([hips.translation, chest.translation], [2.8, 2.7], CLOTH);
    model.ellipsoid(chest, [0.0, 0.0, -1.4], [2.8, 4.2, 2.6], CLOTH);
    model.ellipsoid(chest, [1.9, 0.0, -0.4], [1.2, 1.5, 1.6], SHIRT);
    model.ellipsoid(hips, [0.1, 0.0, 1.4], [3.0, 3.2, 0.9], BELT);
    model.ellipsoid(hips, [2.9, 0.0, 1.4], [0.6, 1.0, 0.9], BUCKLE);
    model.ellipsoid(chest, [-1.9, 0.0, -3.2], [1.9, 4.2, 4.8], DARK_CLOTH);
    model.ellipsoid(hips, [-2.2, 0.0, -1.2], [1.8, 4.0, 4.0], DARK_CLOTH);
}

/// The head, under a hat with a broad brim and a band.
fn head(model: &mut Model, joints: &Joints) {
    let head = joints.head;
    model.ellipsoid(head, [0.0, 0.0, -0.2], [2.5, 2.4, 2.5], SKIN);
    model.ellipsoid(head, [-0.8, 0.0, 0.0], [2.3, 2.6, 2.6], HAIR);
    for side in [-1.0, 1.0] {
        model.ellipsoid(head, [2.3, side, 0.1], [0.6, 0.5, 0.6], EYES);
    }
    model.ellipsoid(head, [0.0, 0.0, 1.5], [4.6, 4.4, 0.8], CLOTH);
    let crown = [1.8, 3.6].map(|z| head.transform_point3(DVec3::new(-0.3, 0.0, z)));
    model.limb(crown, [2.5, 1.9], CLOTH);
    model.ellipsoid(head, [-0.2, 0.0, 2.4], [2.7, 2.7, 0.7], SHIRT);
}

fn club(model: &mut Model, joints: &Joints, frame: PlayerFrame) {
    let hand = joints.arms[1][2];
    let length = if frame == PlayerFrame::Strike { 5.0 } else { 4.0 };
    let end = hand + joints.holds * length;
    let end = end.with_z(end.z.clamp(1.4, 25.0));
    model.limb([hand, end], [0.8, 1.5], CLUB);
}

#[cfg(test)]
mod tests;
