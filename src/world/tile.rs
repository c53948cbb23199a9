//! Tiles: the kinds of cell, and the look of their surfaces.

use super::{Ceiling, Covering, Door, Heights, Light, Shape, TileEffect};
use crate::color::Rgb;

/// One kind of tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tile {
    /// The character that draws it in a map.
    pub character: char,
    /// The kind of tile.
    pub kind: TileKind,
    /// The floor: its own, or the map's.
    pub floor: Covering,
    /// The ceiling: its own, or the map's.
    pub ceiling: Ceiling,
    /// For open floor, the light on it and on the walls around it; for a wall, the light on its
    /// sides. `None` if the map does not say: full light for open floor, and for a wall the light
    /// of the floor before it.
    pub light: Option<Light>,
    /// The heights of its floor, its ceiling and its roof.
    pub heights: Heights,
    /// The surface of the sides below its floor, seen from a lower floor; of a wall, its sides and
    /// its top.
    pub riser: Paint,
    /// The surface of the sides above its ceiling, seen from below a higher ceiling; and of its
    /// roof.
    pub lintel: Paint,
    /// What happens to those who stand on it.
    pub effect: Option<TileEffect>,
}

/// A kind of tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TileKind {
    /// Floor.
    Open,
    /// A door that is fully open: floor between two jambs.
    Doorway(Door),
    /// A solid block up to the height of its floor.
    Wall(Paint),
    /// A door that is not fully open. It stands between two solid cells, with open floor before and
    /// behind it.
    Door(Door),
    /// A solid cube with a texture that has holes.
    Mask(TextureId),
    /// A solid cube of tinted glass.
    Glass(Glass),
    /// A solid block like a wall, whose sides reflect under a tint.
    Mirror(Glass),
    /// A wall that does not fill the cell, and may be lower than its ceiling. Casters and movement
    /// that do not support shapes treat the cell as solid.
    Shape(Shape),
}

/// The tint of glass or of a mirror.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Glass {
    /// The colour of the tint.
    pub color: Rgb,
    /// How much of the tint shows instead of what is behind, or reflected: from 0 for none to 255
    /// for all.
    pub opacity: u8,
}

impl Glass {
    /// Whether the tint shows nowhere.
    pub(crate) fn is_clear(self) -> bool {
        self.opacity == 0
    }

    /// Whether the tint hides what is behind, or reflected.
    pub(crate) fn is_opaque(self) -> bool {
        self.opacity == u8::MAX
    }
}

/// The look of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paint {
    /// One colour.
    Color(Rgb),
    /// A texture.
    Texture(TextureId),
}

/// A texture: an index into the world's list of textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TextureId(pub u16);
