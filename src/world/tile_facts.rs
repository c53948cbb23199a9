//! Tile facts: properties of all kinds of tile of a world together.
//!
//! Frames and steps need them again and again, and they never change: a tile that moves and a door that opens
//! become other kinds of the same world. They are therefore found once. Rejected: finding them for each frame.
//! Moving floors need hundreds of kinds of tile, and this took a fifth of a small frame.

use super::{Ceiling, Covering, Light, Paint, Tile, TileKind};

/// Properties of all kinds of tile of a world together.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
pub(crate) struct TileFacts {
    /// `true` if all floors are at 0, and all ceilings, walls and shapes reach 1.
    pub(crate) are_level: bool,
    /// `true` if any tile is a mirror that shows an image.
    pub(crate) reflect: bool,
    pub(crate) have_shapes: bool,
    pub(crate) have_doors: bool,
    /// `true` if any tile is a mask, glass or a mirror.
    pub(crate) have_see_through: bool,
    /// `true` if every solid tile is a wall.
    pub(crate) are_of_walls: bool,
    pub(crate) have_textured_walls: bool,
    /// `true` if any tile has a light of its own that is not full.
    pub(crate) are_dim: bool,
    /// `true` if the floors of open tiles may look different, and if the ceilings may.
    pub(crate) floors_differ: bool,
    pub(crate) ceilings_differ: bool,
    /// `true` if the sky is above all open tiles.
    pub(crate) are_roofless: bool,
    /// `true` if the sky is above any tile other than a wall.
    #[cfg(feature = "terminal")]
    pub(crate) have_open_sky: bool,
    /// The height above which every cell is empty.
    pub(crate) top: f64,
    /// The heights of the highest floor and the highest ceiling of tiles on which things stand; −∞ if there are
    /// none.
    pub(crate) highest_floor_of_things: f64,
    pub(crate) highest_ceiling_of_things: f64,
}

impl TileFacts {
    /// The facts of `tiles`. `floor` and `ceiling` are the map's own.
    pub(crate) fn new(tiles: &[Tile], floor: Covering, ceiling: Ceiling) -> Self {
        let any = |is_it: fn(&Tile) -> bool| tiles.iter().any(is_it);
        let is_block = |tile: &Tile| matches!(tile.kind, TileKind::Wall(_) | TileKind::Mirror(_));
        let is_dim = |tile: &Tile| tile.light.is_some_and(|light| light != Light::FULL);
        let open = || tiles.iter().filter(|tile| !is_block(tile));
        let highest = |height: fn(&Tile) -> f64| {
            let holds_things =
                |tile: &&Tile| matches!(tile.kind, TileKind::Open | TileKind::Doorway(_));
            tiles.iter().filter(holds_things).map(height).fold(f64::NEG_INFINITY, f64::max)
        };
        Self {
            are_level: tiles.iter().all(Tile::has_level_heights),
            reflect: any(Tile::reflects),
            have_shapes: any(|tile| matches!(tile.kind, TileKind::Shape(_))),
            have_doors: any(|tile| matches!(tile.kind, TileKind::Door(_) | TileKind::Doorway(_))),
            have_see_through: any(|tile| {
                matches!(tile.kind, TileKind::Mask(_) | TileKind::Glass(_) | TileKind::Mirror(_))
            }),
            are_of_walls: !any(|tile| !matches!(tile.kind, TileKind::Open | TileKind::Wall(_))),
            have_textured_walls: any(|tile| matches!(tile.kind, TileKind::Wall(Paint::Texture(_)))),
            are_dim: any(is_dim),
            floors_differ: open().any(|tile| is_dim(tile) || tile.floor != floor),
            ceilings_differ: open().any(|tile| is_dim(tile) || tile.ceiling != ceiling),
            are_roofless: open().all(|tile| tile.ceiling == Ceiling::Sky),
            #[cfg(feature = "terminal")]
            have_open_sky: any(|tile| {
                tile.ceiling == Ceiling::Sky && !matches!(tile.kind, TileKind::Wall(_))
            }),
            top: tiles.iter().map(Tile::top).fold(0.0, f64::max),
            highest_floor_of_things: highest(|tile| tile.heights.floor()),
            highest_ceiling_of_things: highest(|tile| tile.heights.ceiling()),
        }
    }
}
