//! The texels of upright faces.

use super::Projection;
use crate::visibility::texture_stepper::{FaceTexels, TextureStepper, WallTexels, ceil};

impl Projection {
    /// The texels of a wall with `count` from top to bottom.
    pub(crate) fn wall_texels(&self, count: usize) -> WallTexels {
        WallTexels::new(count, 1.0 - self.eye)
    }

    /// The texels of a wall at distance `t`.
    #[inline]
    pub(crate) fn texels_down_the_wall(&self, t: f64, texels: WallTexels) -> TextureStepper {
        TextureStepper::of_wall(self.horizon_of_texels, t / self.focal_length, texels)
    }

    /// The texels of a face from the height `bottom` to `top`: `count` for each cell of height, from one integer
    /// height to the next.
    pub(crate) fn face_texels(&self, count: usize, (bottom, top): (f64, f64)) -> FaceTexels {
        // On old processors `f64::ceil` is a call.
        let above = ceil(top) as f64;
        FaceTexels::new(count, (above - top, above - bottom), above - self.eye)
    }

    /// The texels of a face at distance `t`.
    #[inline]
    pub(crate) fn texels_down_the_face(&self, t: f64, texels: FaceTexels) -> TextureStepper {
        TextureStepper::new(self.horizon_of_texels, t / self.focal_length, texels)
    }
}
