//! The scene: the inputs of a frame.

use super::{FramePlan, Projection};
use crate::world::texture::MipLevel;
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
    /// The mip level of the texture `id` for a face at distance `t`, which the ray approaches by
    /// `slope` cells per unit of `t`.
    #[inline]
    pub(crate) fn level_on_face(self, id: TextureId, t: f64, slope: f64) -> &'a MipLevel {
        let texture = self.world.texture(id);
        let area = self.projection.pixel_area_on_wall(t, slope);
        texture.level(self.plan.filter.lod(area * texture.area()))
    }
}
