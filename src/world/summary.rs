//! Summary: what is true of a world as a whole.
//!
//! Whoever draws a world, or walks in it, asks these to leave out what it has no need of. They go by
//! the kinds of tile and sprite, of which there are few, and never by the cells.

use super::{Heights, Sprite, Tile, TileKind, World};

impl World {
    /// Whether all floors are at 0, and all ceilings, walls and shapes a cell above that: every ray ends
    /// where it meets the first of those.
    pub fn is_level(&self) -> bool {
        self.tiles.iter().all(Tile::has_level_heights)
    }

    /// Whether any tile is a mirror.
    pub fn has_mirrors(&self) -> bool {
        self.tiles.iter().any(|tile| matches!(tile.kind, TileKind::Mirror(_)))
    }

    /// Whether any tile is a shape.
    pub(crate) fn has_shapes(&self) -> bool {
        self.tiles.iter().any(|tile| matches!(tile.kind, TileKind::Shape(_)))
    }

    /// Whether all that is solid is walls, which show one side each and hide what is behind.
    pub(crate) fn is_of_walls(&self) -> bool {
        let is_plain = |tile: &Tile| matches!(tile.kind, TileKind::Open | TileKind::Wall(_));
        self.tiles.iter().all(is_plain)
    }

    /// Whether lamps add anything anywhere.
    pub(crate) fn has_lamplight(&self) -> bool {
        !self.lamplight.is_dark()
    }

    /// How wide the widest sprite is, in cells; 0 where nothing stands anywhere.
    pub(crate) fn widest_sprite(&self) -> f64 {
        self.sprites.iter().map(Sprite::width).fold(0.0, f64::max)
    }

    /// How high the highest sprite is, in cells; 0 where nothing stands anywhere.
    pub(crate) fn tallest_sprite(&self) -> f64 {
        self.sprites.iter().map(|sprite| sprite.height.cells()).fold(0.0, f64::max)
    }
}

impl Tile {
    /// Whether its floor is at 0, and its ceiling, or the wall or shape that it is, a cell above that.
    fn has_level_heights(&self) -> bool {
        let level = match self.kind {
            TileKind::Wall(_) | TileKind::Mirror(_) => Heights::LEVEL_WALL,
            _ => Heights::LEVEL,
        };
        let is_as_high = match self.kind {
            TileKind::Shape(_) => self.top_of_what_stands() == Heights::LEVEL.ceiling(),
            _ => true,
        };
        self.heights == level && is_as_high
    }

    /// Whether a ray through it goes neither above nor below anything, and is not reflected.
    pub(crate) fn is_level(&self) -> bool {
        self.has_level_heights() && !matches!(self.kind, TileKind::Mirror(_))
    }
}
