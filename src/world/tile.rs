//! Tiles: what a cell of the grid may be, and how its surfaces look.

use super::{Ceiling, Covering, Door, Heights, Light, Shape};
use crate::color::Rgb;

/// One kind of tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tile {
    /// The character that draws it in a map.
    pub character: char,
    /// What it is.
    pub kind: TileKind,
    /// What its floor is laid with: its own, or the map's.
    pub floor: Covering,
    /// What is overhead there: its own ceiling, or the map's.
    pub ceiling: Ceiling,
    /// Of open floor, how bright it is, and the walls that it is seen from; of a wall, how bright its
    /// own sides are. `None` where the map does not say: full for open floor, and for a wall as
    /// bright as the floor before it.
    pub light: Option<Light>,
    /// How high its floor, its ceiling and what hangs above that are.
    pub heights: Heights,
    /// How the sides look of what its floor lies on, where they are seen from a lower one; a wall's
    /// own sides, and its top.
    pub riser: Paint,
    /// How the sides look of what hangs above its ceiling, where they are seen from below a higher
    /// one; and its roof.
    pub lintel: Paint,
}

/// What a tile is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TileKind {
    /// Floor to walk on, and to see across.
    Open,
    /// Where a door is that is all open: floor between two jambs.
    Doorway(Door),
    /// A solid block, as high as its floor says: what is above it is open.
    Wall(Paint),
    /// A door that is closed, or not all open. It stands between two solid cells, open floor before
    /// and behind it.
    Door(Door),
    /// A solid cube whose sides have holes where the texture is clear.
    Mask(TextureId),
    /// A solid cube of tinted glass.
    Glass(Glass),
    /// A block as a wall's, with sides that reflect under a tint.
    Mirror(Glass),
    /// A wall that does not fill the cell, and may be lower than its ceiling. Rays and walkers that
    /// know no shapes take the cell for solid; the others pass it by.
    Shape(Shape),
}

/// Glass to look through, or into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Glass {
    /// Its tint.
    pub color: Rgb,
    /// How much of the tint is seen in place of what is behind, or reflected: from 0 for none to 255
    /// for all.
    pub opacity: u8,
}

/// How a surface looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paint {
    /// The same colour all over.
    Color(Rgb),
    /// A texture.
    Texture(TextureId),
}

/// Which texture: an index into the world's list of textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TextureId(pub u16);
