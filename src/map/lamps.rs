//! Lamplight: which cells each lamp lights.
//!
//! A cell is lit if the straight line from the middle of the lamp's cell to its own middle passes
//! only through open floor, masks and glass. Doors count as closed.

mod glow;

use crate::world::{Cell, Grid, Lamplight, Light, Sprite, Thing, Tile, TileId, TileKind};
use glow::Glow;

/// What the lamps among `things` add to the light of each cell; nothing if all cells are fully lit
/// anyway.
pub(crate) fn lamplight(
    grid: &Grid,
    tiles: &[Tile],
    sprites: &[Sprite],
    things: &[Thing],
) -> Lamplight {
    let is_lamp = |thing: &&Thing| sprites[usize::from(thing.sprite.0)].lamp.is_some();
    let mut lamps = things.iter().filter(is_lamp).peekable();
    let is_dim = |tile: &Tile| tile.light.is_some_and(|light| light != Light::FULL);
    if lamps.peek().is_none() || !tiles.iter().any(is_dim) {
        return Lamplight::default();
    }
    let glows: Vec<Option<Glow>> =
        sprites.iter().map(|sprite| sprite.lamp.as_ref().map(Glow::of)).collect();
    let is_clear: Vec<bool> = tiles.iter().map(|tile| lets_through(tile.kind)).collect();
    let is_clear = |tile: TileId| is_clear[usize::from(tile.0)];
    let mut lamplight = grid.lamplight();
    for &Thing { cell, sprite, .. } in lamps {
        if let Some(glow) = &glows[usize::from(sprite.0)] {
            glow.shine(grid, cell, is_clear, |cell: Cell, light| lamplight.add(cell, light));
        }
    }
    lamplight
}

fn lets_through(kind: TileKind) -> bool {
    use TileKind::{Doorway, Glass, Mask, Open};
    matches!(kind, Open | Doorway(_) | Mask(_) | Glass(_))
}
