//! Summary: properties of a world as a whole.
//!
//! Rendering and collision use them to leave out what a world does not have. They depend on the
//! kinds of tile and sprite, of which there are few, and not on the cells.

use super::{Anchor, Ceiling, Heights, Sprite, Thing, Tile, TileKind, World};

impl World {
    /// Whether all floors are at 0, and all ceilings, walls and shapes reach 1, so that every ray
    /// ends at the first of them.
    pub fn is_level(&self) -> bool {
        self.tiles.iter().all(Tile::has_level_heights)
    }

    /// Whether any tile is a mirror that shows an image.
    pub fn has_mirrors(&self) -> bool {
        self.tiles.iter().any(Tile::reflects)
    }

    /// Whether any tile is a shape.
    pub(crate) fn has_shapes(&self) -> bool {
        self.tiles.iter().any(|tile| matches!(tile.kind, TileKind::Shape(_)))
    }

    /// Whether everything solid is a wall, which shows one side and hides what is behind it.
    pub(crate) fn is_of_walls(&self) -> bool {
        let is_plain = |tile: &Tile| matches!(tile.kind, TileKind::Open | TileKind::Wall(_));
        self.tiles.iter().all(is_plain)
    }

    /// Whether lamps add light anywhere.
    pub(crate) fn has_lamplight(&self) -> bool {
        !self.lamplight.is_dark()
    }

    /// The width of the widest sprite, in cells; 0 if there is none.
    pub(crate) fn widest_sprite(&self) -> f64 {
        self.sprites.iter().map(Sprite::width).fold(0.0, f64::max)
    }

    /// Whether the sky is above any cell but walls.
    pub(crate) fn has_open_sky(&self) -> bool {
        let is_open =
            |tile: &Tile| tile.ceiling == Ceiling::Sky && !matches!(tile.kind, TileKind::Wall(_));
        self.tiles.iter().any(is_open)
    }

    /// A height that no thing reaches above, wherever it stands or hangs; −∞ if there are no sprites.
    pub(crate) fn limit_of_things(&self) -> f64 {
        let tallest = |anchor: Anchor| {
            let sprites = self.sprites.iter().filter(|sprite| sprite.anchor == anchor);
            sprites.map(|sprite| sprite.height.cells()).fold(f64::NEG_INFINITY, f64::max)
        };
        let (standing, hanging) = (tallest(Anchor::Floor), tallest(Anchor::Ceiling));
        let holds_things =
            |tile: &&Tile| matches!(tile.kind, TileKind::Open | TileKind::Doorway(_));
        let top_in = |Tile { heights, .. }: &Tile| {
            let ceiling = if hanging > 0.0 { heights.ceiling() } else { f64::NEG_INFINITY };
            ceiling.max(heights.floor() + standing)
        };
        self.tiles.iter().filter(holds_things).map(top_in).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The things that reach above `height`.
    pub(crate) fn things_above(&self, height: f64) -> impl Iterator<Item = &Thing> {
        self.things().iter().filter(move |thing| self.is_above(thing, height))
    }

    /// Whether `thing` reaches above `height`.
    pub(crate) fn is_above(&self, thing: &Thing, height: f64) -> bool {
        let sprite = self.sprite(thing.sprite);
        sprite.base(self.room_in(thing.cell)) + sprite.height.cells() > height
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

    /// Whether it is a mirror that shows an image: an opaque tint hides all of it.
    pub(crate) fn reflects(&self) -> bool {
        matches!(self.kind, TileKind::Mirror(tint) if !tint.is_opaque())
    }

    /// Whether a ray through it goes neither above nor below anything, and is not reflected.
    pub(crate) fn is_level(&self) -> bool {
        self.has_level_heights() && !self.reflects()
    }
}
