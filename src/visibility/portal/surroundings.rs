//! The values that all rays of a frame share.

use super::tile_gaps::TileGaps;
use crate::cast::CommonOrder;
use crate::visibility::Scene;
use crate::visibility::projection::Rise;
use crate::world::sprite::builtin;
use crate::world::{Camera, Cell, Tile, TileId};

/// The most reflections of a ray. The mirror after the last one shows only its tint.
pub(crate) const MOST_BOUNCES: u32 = 8;

/// The location of a ray: in a cell, or off the map.
pub(crate) type Place = Option<(Cell, TileId)>;

/// The values that all rays of a frame share.
pub(crate) struct Surroundings<'a> {
    pub(crate) scene: Scene<'a>,
    pub(crate) gaps: &'a TileGaps,
    /// The rise above which there is only sky.
    pub(crate) top: Rise,
    /// Whether there is any thing or figure, or the player in a mirror.
    pub(crate) has_things: bool,
    pub(crate) order: CommonOrder,
}

impl<'a> Surroundings<'a> {
    pub(crate) fn new(scene: Scene<'a>, gaps: &'a TileGaps) -> Self {
        let world = scene.world;
        let has_figures = !world.figures().is_empty();
        let has_things = !world.things().is_empty() || has_figures || world.has_mirrors();
        let mut top = world.tiles().iter().map(Tile::top).fold(world.top_of_figures(), f64::max);
        if !world.things().is_empty() {
            top = top.max(world.limit_of_things());
        }
        if world.has_mirrors() {
            let feet = scene.projection.eye() - Camera::STANDING;
            top = top.max(feet + builtin::PLAYER_HEIGHT);
        }
        let top = scene.projection.rise_to(top);
        let most_bounces = if world.has_mirrors() { MOST_BOUNCES } else { 0 };
        let order = CommonOrder::new(world.grid(), scene.projection.origin(), most_bounces);
        Self { scene, gaps, top, has_things, order }
    }

    pub(crate) fn tile(&self, place: Place) -> Option<&'a Tile> {
        let (_, id) = place?;
        self.scene.world.tiles().get(usize::from(id.0))
    }
}
