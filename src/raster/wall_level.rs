//! Wall levels: a texture at one level of detail, kept from one wall column to the next.
//!
//! Most columns show the same level as the one before. Looking it up for each of them takes as long as a
//! dozen pixels.

use super::sampling::Sampling;
use crate::visibility::{Scene, WallTexels};
use crate::world::TextureId;
use crate::world::texture::{MipLevel, Texture};

/// A texture at one level of detail.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WallLevel<'a, M: Sampling> {
    id: TextureId,
    texture: &'a Texture,
    lod: M::Lod,
    pub(crate) level: &'a MipLevel,
    /// The texels of a wall that one texture of the level covers.
    pub(crate) texels: WallTexels,
}

impl<'a, M: Sampling> WallLevel<'a, M> {
    /// The level of the texture `id` for a face at distance `t`, which the ray approaches by `slope` cells
    /// per unit of `t`. `latest` is that of the column before.
    #[inline]
    pub(crate) fn on_face(
        scene: Scene<'a>,
        id: TextureId,
        (t, slope): (f64, f64),
        latest: &mut Option<Self>,
    ) -> Self {
        let known = (*latest).filter(|known| known.id == id);
        let texture = known.map_or_else(|| scene.world.texture(id), |known| known.texture);
        let lod = M::lod_on_face(scene, texture, t, slope);
        match known {
            Some(known) if known.lod == lod => known,
            _ => *latest.insert(Self::new(scene, id, lod)),
        }
    }

    /// The level `lod` of the texture `id`.
    #[inline(never)]
    pub(crate) fn new(scene: Scene<'a>, id: TextureId, lod: M::Lod) -> Self {
        let texture = scene.world.texture(id);
        let level = M::level_on_face(texture, lod);
        let texels = scene.projection.wall_texels(level.height() as usize);
        Self { id, texture, lod, level, texels }
    }
}
