//! Bundles: neighbouring columns whose rays have crossed the same lines, and the values that all rays of a
//! frame share.

use std::ops::Range;

use super::tile_gaps::{GapId, Place, TileGaps};
use crate::cast::{CommonOrder, Course};
use crate::visibility::Scene;
use crate::visibility::projection::Rise;
use crate::visibility::runs::ImageId;
use crate::world::sprite::builtin;
use crate::world::{Camera, Tile};

/// Rays that are followed in one gap, one for each of some neighbouring columns.
#[derive(Clone, Debug)]
pub(crate) struct Bundle {
    pub(crate) course: Course,
    pub(crate) place: Place,
    pub(crate) gap: GapId,
    pub(crate) image: ImageId,
    pub(crate) columns: Range<u32>,
    /// The index of the clip of the first column. Those of the others follow.
    pub(crate) first_clip: usize,
    /// The number of clips in use when the bundle was stored.
    pub(crate) clips_in_use: usize,
    /// Whether the rays have met what stands in the cell.
    pub(crate) has_met_standing: bool,
}

/// The ray of a column, as far as it differs from the others of its bundle.
#[derive(Clone, Debug)]
pub(crate) struct Clip {
    /// The clip range: the rows that no nearer surface covers. It is empty where the ray has ended.
    pub(crate) rows: Range<u32>,
    /// The distance at which this part of the ray begins.
    pub(crate) from: f64,
    /// The distance at which the ray begins; infinite once it has ended.
    pub(crate) start: f64,
}

impl Bundle {
    /// The index of the clip of `column`.
    #[inline]
    pub(crate) fn clip(&self, column: u32) -> usize {
        self.first_clip + (column - self.columns.start) as usize
    }

    /// The indices of the clips of all columns.
    pub(crate) fn clips(&self) -> Range<usize> {
        self.first_clip..self.first_clip + self.columns.len()
    }

    /// The columns, as indices.
    #[inline]
    pub(crate) fn indices(&self) -> Range<usize> {
        self.columns.start as usize..self.columns.end as usize
    }

    /// The bundle of these of its `columns`.
    pub(crate) fn part(&self, columns: Range<u32>) -> Self {
        Self { first_clip: self.clip(columns.start), columns, ..self.clone() }
    }
}

/// The most reflections of a ray. The mirror after the last one shows only its tint.
pub(crate) const MAX_BOUNCES: u32 = 8;

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
        let most_bounces = if world.has_mirrors() { MAX_BOUNCES } else { 0 };
        let order = CommonOrder::new(world.grid(), scene.projection.origin(), most_bounces);
        Self { scene, gaps, top, has_things, order }
    }

    pub(crate) fn tile(&self, place: Place) -> Option<&'a Tile> {
        let (_, id) = place?;
        self.scene.world.tiles().get(usize::from(id.0))
    }
}

#[cfg(test)]
mod tests;
