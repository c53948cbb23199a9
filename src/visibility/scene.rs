//! The scene: the inputs of a frame.

use super::{FramePlan, Projection};
use crate::world::texture::{MipLevel, Texture};
use crate::world::{Camera, TextureId, World};

/// A world, the camera that views it, and the projection and plan of the frame.
#[derive(Clone, Copy)]
pub(crate) struct Scene<'a> {
    pub(crate) world: &'a World,
    pub(crate) camera: &'a Camera,
    /// The time at which sprites are shown, in seconds.
    pub(crate) seconds: f64,
    pub(crate) projection: &'a Projection,
    pub(crate) plan: &'a FramePlan,
}

impl<'a> Scene<'a> {
    /// The level of detail of `texture` for a face at distance `t`, which the ray approaches by `slope`
    /// cells per unit of `t`.
    #[inline]
    pub(crate) fn lod_on_face(self, texture: &Texture, t: f64, slope: f64) -> usize {
        let area = self.projection.pixel_area_on_wall(t, slope);
        self.plan.filter.lod(area * texture.area())
    }

    /// The mip level of the texture `id` for such a face.
    #[inline]
    pub(crate) fn level_on_face(self, id: TextureId, t: f64, slope: f64) -> &'a MipLevel {
        let texture = self.world.texture(id);
        texture.level(self.lod_on_face(texture, t, slope))
    }
}
