//! Wall levels: a texture at one level of detail, kept from one wall column to the next.
//!
//! Most columns show the same level as the one before. Looking it up for each of them takes as long as a
//! dozen pixels.

use crate::visibility::{Scene, WallTexels};
use crate::world::TextureId;
use crate::world::texture::{MipLevel, Texture};

/// A texture at one level of detail.
#[derive(Clone, Copy, Debug)]
pub(super) struct WallLevel<'a> {
    id: TextureId,
    texture: &'a Texture,
    lod: usize,
    pub(super) level: &'a MipLevel,
    /// The texels of a wall that one texture of the level covers.
    pub(super) texels: WallTexels,
}

impl<'a> WallLevel<'a> {
    /// The level of the texture `id` for a face at distance `t`, which the ray approaches by `slope` cells
    /// per unit of `t`. `latest` is that of the column before.
    #[inline]
    pub(super) fn on_face(
        scene: Scene<'a>,
        id: TextureId,
        (t, slope): (f64, f64),
        latest: &mut Option<Self>,
    ) -> Self {
        let known = (*latest).filter(|known| known.id == id);
        let texture = known.map_or_else(|| scene.world.texture(id), |known| known.texture);
        let lod = scene.lod_on_face(texture, t, slope);
        match known {
            Some(known) if known.lod == lod => known,
            _ => *latest.insert(Self::new(scene, id, lod)),
        }
    }

    #[inline(never)]
    fn new(scene: Scene<'a>, id: TextureId, lod: usize) -> Self {
        let texture = scene.world.texture(id);
        let level = texture.level(lod);
        let texels = scene.projection.wall_texels(level.height() as usize);
        Self { id, texture, lod, level, texels }
    }
}
