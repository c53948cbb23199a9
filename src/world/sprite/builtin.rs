//! The built-in sprites, drawn with characters or computed when one is first shown.
//!
//! They have few texels, a dark outline, and light from the upper left, so that they can be told
//! apart at a height of ten pixels. A drawing is text, so that changes to it can be reviewed,
//! unlike those of a picture file.

mod figure;
mod finds;
mod fixtures;
mod frame;
mod furniture;
mod guard;
mod model;
mod player;
mod portal;
mod stores;
mod traveller;
mod treasure;
mod weapons;

use std::num::NonZeroU32;

use super::{Anchor, Facings, FrameTime, Sprite, SpriteHeight};
use crate::color::Rgb;
use crate::world::{GuardKind, Lamp, Light, Reach, Texture};
pub use frame::{CheckpointFrame, GuardFrame, LeverFrame, PlayerFrame, SpikesFrame};
pub use traveller::PlayerColor;
pub(crate) use traveller::player;

/// The names that maps may use for ornaments. Games also use sprites of guards, of finds and of what
/// flies, which [`named`] knows.
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
/// Its height, in cells.
pub(crate) const PLAYER_HEIGHT: f64 = 0.68;

/// The built-in sprite of that name; `None` if there is none.
pub fn named(name: &str) -> Option<Sprite> {
    let design = match name {
        "bolt" => weapons::bolt(),
        "checkpoint" => fixtures::checkpoint(),
        "coins" => finds::coins(),
        "crown" => finds::crown(),
        "cup" => finds::cup(),
        "dart" => weapons::dart(),
        "darts" => weapons::darts(),
        "flask" => weapons::flask(),
        "flasks" => weapons::flasks(),
        "heart" => finds::heart(),
        "lever" => fixtures::lever(),
        "note" => finds::note(),
        "pebble" => finds::pebble(),
        "pebbles" => finds::pebbles(),
        "smoke" => weapons::smoke(),
        "spikes" => fixtures::spikes(),
        "star" => weapons::star(),
        "banner" => stores::banner(),
        "books" => stores::books(),
        "brazier" => stores::brazier(),
        "chest" => stores::chest(),
        "crate" => stores::crate_of_boards(),
        "barrel" => furniture::barrel(),
        "bones" => treasure::bones(),
        "column" => furniture::column(),
        "lamp" => furniture::lamp(),
        "plant" => furniture::plant(),
        "statue" => figure::statue(),
        "table" => furniture::table(),
        "torch" => furniture::torch(),
        EXIT => portal::portal(),
        KEY => treasure::key(),
        PLAYER => player::player(),
        _ => guard::guard(GuardKind::ALL.into_iter().find(|kind| kind.name() == name)?),
    };
    design.sprite()
}

/// The definition of a sprite.
struct Design {
    pictures: Vec<Texture>,
    facings: Facings,
    /// The time of each frame.
    seconds: f64,
    /// The number of frames that time goes through; `None` for all.
    animated: Option<usize>,
    anchor: Anchor,
    /// In cells.
    height: f64,
    blocks: bool,
    /// What it adds to the light in its cell, from 0 to 1.
    shines: f64,
}

impl Design {
    /// The sprite; `None` if the pictures are not as many as their facings need.
    fn sprite(self) -> Option<Sprite> {
        let Self { pictures, facings, seconds, animated, anchor, height, blocks, shines } = self;
        let mut sprite = Sprite::new(pictures, facings)?.with_frame_time(FrameTime::new(seconds)?);
        if let Some(animated) = animated {
            sprite = sprite.with_animated_frames(animated);
        }
        sprite.anchor = anchor;
        sprite.height = SpriteHeight::new(height)?;
        sprite.blocks = blocks;
        sprite.lamp = Light::new(shines)
            .filter(|&light| light != Light::NONE)
            .map(|light| Lamp { light, reach: Reach::default() });
        Some(sprite)
    }

    /// Pictures with one facing that stand on the floor and do not block.
    fn standing(height: f64, pictures: Vec<Texture>) -> Self {
        let (facings, anchor) = (Facings::One, Anchor::Floor);
        let (animated, blocks, shines) = (None, false, 0.0);
        Self { pictures, facings, seconds: 0.2, animated, anchor, height, blocks, shines }
    }
}

/// The colours of characters; all other characters are transparent.
type Palette = [(char, Rgb)];

/// The picture that lines of characters draw, all of one length.
fn drawn(lines: &[&'static str], palette: &'static Palette) -> Texture {
    character_picture(lines, palette, false)
}

/// The mirror image of a drawing.
fn mirrored(lines: &[&'static str], palette: &'static Palette) -> Texture {
    character_picture(lines, palette, true)
}

fn character_picture(
    lines: &[&'static str],
    palette: &'static Palette,
    is_mirrored: bool,
) -> Texture {
    let (width, height) = (lines[0].chars().count(), lines.len());
    let lines = lines.to_vec();
    painted_by(width as u32, height as u32, move || {
        let rows: Vec<Vec<char>> = lines.iter().map(|line| line.chars().collect()).collect();
        move |x, y| {
            let (x, row) = (x as usize, &rows[y as usize]);
            let character = row.get(if is_mirrored { row.len() - 1 - x } else { x })?;
            palette.iter().find(|(known, _)| known == character).map(|&(_, color)| color)
        }
    })
}

/// The picture whose texel at `(x, y)` is `paint(x, y)`, transparent where that is `None`.
fn painted(
    width: u32,
    height: u32,
    paint: impl Fn(i32, i32) -> Option<Rgb> + Clone + Send + Sync + 'static,
) -> Texture {
    painted_by(width, height, move || paint.clone())
}

/// The picture as [`painted`] by the function that `painter` returns when a texel is first read.
fn painted_by<P: Fn(i32, i32) -> Option<Rgb>>(
    width: u32,
    height: u32,
    painter: impl Fn() -> P + Send + Sync + 'static,
) -> Texture {
    const CLEAR: (Rgb, u8) = (Rgb::BLACK, 0);
    let side = |side| NonZeroU32::new(side).unwrap_or(NonZeroU32::MIN);
    Texture::on_demand(side(width), side(height), true, move || {
        let paint = painter();
        move |x, y| paint(x as i32, y as i32).map_or(CLEAR, |color| (color, u8::MAX))
    })
}

/// The colour of outlines.
const INK: Rgb = Rgb::new(0x1c, 0x18, 0x20);

#[cfg(test)]
mod tests {
    use super::*;

    /// The sprites that only a game uses, but for guards.
    const OF_GAMES: [&str; 19] = [
        EXIT,
        KEY,
        "bolt",
        "checkpoint",
        "coins",
        "crown",
        "cup",
        "dart",
        "darts",
        "flask",
        "flasks",
        "heart",
        "lever",
        "note",
        "pebble",
        "pebbles",
        "smoke",
        "spikes",
        "star",
    ];

    fn all() -> impl Iterator<Item = (&'static str, Sprite)> {
        let names = NAMES.iter().copied().chain(OF_GAMES);
        names.map(|name| (name, named(name).unwrap_or_else(|| panic!("{name} is drawn"))))
    }

    #[test]
    fn every_picture_shows_something_and_leaves_something_clear() {
        for (name, sprite) in all() {
            for picture in sprite.pictures.iter() {
                let texels = (0..picture.width())
                    .flat_map(|x| (0..picture.height()).map(move |y| picture.texel(x, y).1));
                let shown = texels.filter(|&alpha| alpha > 0).count() as u32;
                let area = picture.width() * picture.height();
                assert!((area / 8..area).contains(&shown), "{name}: {shown} of {area}");
            }
        }
        assert_eq!(named("dragon"), None);
    }

    #[test]
    fn frames_that_a_game_selects_are_not_animated() {
        let frames = |name| {
            let sprite = named(name).unwrap();
            (sprite.animated_frames(), sprite.frames())
        };
        assert_eq!((frames("lamp"), frames("torch")), ((2, 3), (3, 4)));
        assert_eq!((frames("checkpoint"), frames("lever")), ((1, 2), (1, 2)));
        assert_eq!((frames("spikes"), frames("smoke")), ((1, 3), (4, 4)));
    }

    #[test]
    fn all_pictures_of_a_sprite_are_of_one_size_and_differ() {
        for (name, sprite) in all() {
            let first = &sprite.pictures[0];
            for (index, picture) in sprite.pictures.iter().enumerate() {
                let size = (picture.width(), picture.height());
                assert_eq!(size, (first.width(), first.height()), "{name}");
                assert!(!sprite.pictures[..index].contains(picture), "{name}: {index}");
            }
        }
    }
}
