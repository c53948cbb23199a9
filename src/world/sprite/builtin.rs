//! The built-in sprites: sheets of `maps/art`.
//!
//! They have few texels, a dark outline, and light from the upper left, so that players can tell
//! them apart at a height of ten pixels.

mod frame;
mod player;

use super::{Anchor, Facings, FrameTime, Sprite, SpriteHeight};
use crate::color::Rgb;
use crate::world::art::{Art, art};
use crate::world::{Lamp, Light, Reach};
pub use frame::{CheckpointFrame, GuardFrame, LeverFrame, PlayerFrame, SpikesFrame};
pub use player::PlayerColor;
pub(crate) use player::{marked_player, player};

/// The names that maps may use for ornaments. Games also use the sprites of guards, items and
/// projectiles, which [`named`] knows.
pub const NAMES: &[&str] = &[
    "banner", "barrel", "bones", "books", "brazier", "chest", "column", "crate", "lamp", "plant",
    "statue", "table", "torch",
];

/// The sprite of an exit.
pub const EXIT: &str = "portal";
/// The sprite of a key.
pub const KEY: &str = "key";
/// The sprite of the player, seen in mirrors.
pub const PLAYER: &str = "player";
/// The height of the player's sprite, in cells.
pub(crate) const PLAYER_HEIGHT: f64 = 0.68;

/// The built-in sprite with this name; `None` if there is none.
pub fn named(name: &str) -> Option<Sprite> {
    DESIGNS.iter().find(|design| design.art.name == name)?.recolored(|color| color)
}

/// The sheets of all sprites.
pub(crate) fn sheets() -> impl Iterator<Item = Art> {
    DESIGNS.iter().chain([&TRAVELLER]).map(|design| design.art)
}

/// All built-in sprites except the players.
const DESIGNS: &[Design] = &[
    Design::figure(art!("archer"), 0.82, 8),
    Design { anchor: Anchor::Ceiling, ..Design::standing(art!("banner"), 0.7) },
    Design { blocks: true, ..Design::standing(art!("barrel"), 0.58) },
    Design { facings: Facings::Four, ..Design::standing(art!("bolt"), 0.14) },
    Design::standing(art!("bones"), 0.26),
    Design::standing(art!("books"), 0.2),
    Design {
        frames: 4,
        animated: 3,
        seconds: 0.15,
        blocks: true,
        shines: 0.7,
        ..Design::standing(art!("brazier"), 0.6)
    },
    Design { frames: 2, animated: 1, ..Design::standing(art!("checkpoint"), 0.8) },
    Design { blocks: true, ..Design::standing(art!("chest"), 0.38) },
    Design::standing(art!("coins"), 0.15),
    Design { blocks: true, ..Design::standing(art!("column"), 1.0) },
    Design { blocks: true, ..Design::standing(art!("crate"), 0.55) },
    Design::standing(art!("crown"), 0.3),
    Design::standing(art!("cup"), 0.26),
    Design { facings: Facings::Four, ..Design::standing(art!("dart"), 0.08) },
    Design::standing(art!("darts"), 0.24),
    Design::standing(art!("flask"), 0.15),
    Design::standing(art!("flasks"), 0.24),
    Design::standing(art!("heart"), 0.26),
    Design::figure(art!("hound"), 0.48, 8),
    Design { frames: 4, animated: 4, seconds: 0.35, ..Design::standing(art!("key"), 0.3) },
    Design {
        frames: 3,
        animated: 2,
        seconds: 0.25,
        anchor: Anchor::Ceiling,
        shines: 0.7,
        ..Design::standing(art!("lamp"), 0.42)
    },
    Design { shines: 0.7, ..Design::figure(art!("lantern"), 0.9, 8) },
    Design { frames: 2, animated: 1, ..Design::standing(art!("lever"), 0.5) },
    Design::figure(art!("listener"), 0.9, 8),
    Design::standing(art!("note"), 0.3),
    Design::standing(art!("pebble"), 0.1),
    Design::standing(art!("pebbles"), 0.16),
    Design::standing(art!("plant"), 0.6),
    Design { facings: Facings::Four, ..Design::standing(art!("player"), 0.68) },
    Design {
        frames: 4,
        animated: 4,
        seconds: 0.15,
        shines: 0.3,
        ..Design::standing(art!("portal"), 0.9)
    },
    Design { frames: 4, animated: 4, seconds: 0.25, ..Design::standing(art!("smoke"), 0.9) },
    Design { frames: 3, animated: 1, ..Design::standing(art!("spikes"), 0.5) },
    Design { frames: 2, animated: 2, seconds: 0.3, ..Design::standing(art!("star"), 0.2) },
    Design { facings: Facings::Four, blocks: true, ..Design::standing(art!("statue"), 0.85) },
    Design { blocks: true, ..Design::standing(art!("table"), 0.42) },
    Design {
        frames: 4,
        animated: 3,
        seconds: 0.15,
        shines: 0.6,
        ..Design::standing(art!("torch"), 0.72)
    },
    Design::figure(art!("warden"), 1.0, 8),
];

/// A player as others see them, with cloth in the dye's colour.
const TRAVELLER: Design = Design::figure(art!("traveller"), 0.76, 6);

/// A sheet, and the way in which a world shows it.
struct Design {
    art: Art,
    frames: u32,
    facings: Facings,
    /// The time of each frame.
    seconds: f64,
    /// The number of frames in the animation.
    animated: usize,
    anchor: Anchor,
    /// The height, in cells.
    height: f64,
    blocks: bool,
    /// The light that it adds in its cell, from 0 to 1.
    shines: f64,
}

impl Design {
    /// A sheet of one picture that stands on the floor and does not block.
    const fn standing(art: Art, height: f64) -> Self {
        Self {
            art,
            frames: 1,
            facings: Facings::One,
            seconds: 0.2,
            animated: 1,
            anchor: Anchor::Floor,
            height,
            blocks: false,
            shines: 0.0,
        }
    }

    /// A sheet of a body from eight sides, with this number of poses.
    const fn figure(art: Art, height: f64, poses: u32) -> Self {
        Self { frames: poses, facings: Facings::Eight, ..Self::standing(art, height) }
    }

    /// The sprite with recoloured pictures. `color` returns the replacement for each colour.
    fn recolored(
        &self,
        color: impl Fn(Rgb) -> Rgb + Copy + Send + Sync + 'static,
    ) -> Option<Sprite> {
        let pictures = self.art.pictures(self.frames, self.facings.count(), color);
        let mut sprite = Sprite::new(pictures, self.facings)?
            .with_frame_time(FrameTime::new(self.seconds)?)
            .with_animated_frames(self.animated);
        sprite.anchor = self.anchor;
        sprite.height = SpriteHeight::new(self.height)?;
        sprite.blocks = self.blocks;
        sprite.lamp = Light::new(self.shines)
            .filter(|&light| light != Light::NONE)
            .map(|light| Lamp { light, reach: Reach::default() });
        Some(sprite)
    }
}

#[cfg(test)]
mod tests;
