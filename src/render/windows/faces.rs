//! The pass for what stands upright: walls, the sides of floors and of what hangs from above, doors.

use std::ops::Range;

use glam::DVec2;

use super::Scene;
use crate::cast::Side;
use crate::render::band::Band;
use crate::render::plan::WallLoop;
use crate::render::shade::{Faded, OfSide, Shade};
use crate::render::tally::{Pass, Tally};
use crate::world::{Light, Paint};

/// A face as wide as a pixel, as far as it is seen.
#[derive(Clone, Debug)]
pub(super) struct Face {
    pub(super) column: u32,
    pub(super) rows: Range<u32>,
    pub(super) facing: Facing,
    /// How much of the ray leads straight at it, for each unit of `t`.
    pub(super) slope: f64,
    pub(super) t: f64,
    pub(super) u: f64,
    pub(super) paint: Paint,
    pub(super) light: Light,
    pub(super) stretch: Stretch,
}

/// Which way a face looks.
#[derive(Clone, Copy, Debug)]
pub(super) enum Facing {
    /// Along an axis.
    Side(Side),
    /// Along a vector of length 1, or the opposite way.
    Normal(DVec2),
}

/// From which height to which something reaches.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    pub(super) bottom: f64,
    pub(super) top: f64,
}

/// Draws all of `faces`.
pub(super) fn draw<T: Tally>(
    scene: Scene<'_>,
    plan: WallLoop,
    faces: &[Face],
    band: &mut Band<'_>,
    tally: &mut T,
) {
    for face in faces {
        match face.facing {
            Facing::Side(side) if !plan.faded => face.draw(scene, OfSide(side), band, tally),
            _ => face.draw(scene, face.facing.shade(scene, face.light, face.t), band, tally),
        }
    }
}

impl Facing {
    /// What becomes of the colours of what looks this way.
    pub(super) fn shade(self, scene: Scene<'_>, light: Light, t: f64) -> Faded {
        let fog = scene.world.fog();
        match self {
            Self::Side(side) => Faded::of_wall(side, light, fog, t),
            Self::Normal(normal) => Faded::of_surface(normal, light, fog, t),
        }
    }
}

impl Face {
    fn draw<S: Shade, T: Tally>(
        &self,
        scene: Scene<'_>,
        shade: S,
        band: &mut Band<'_>,
        tally: &mut T,
    ) {
        let rows = self.rows.clone();
        tally.pixels(Pass::Walls, rows.len());
        let pixels = band.column_mut(self.column, rows.clone());
        match self.paint {
            Paint::Color(color) => {
                let color = shade.apply(color);
                pixels.for_each(|pixel| *pixel = color);
            }
            Paint::Texture(id) => {
                tally.texels(Pass::Walls, rows.len());
                let level = scene.level_on(scene.world.texture(id), self.t, self.slope);
                let texels = level.column(self.u);
                let Stretch { bottom, top } = self.stretch;
                let down = scene.projection.texels_down_the_face(self.t, texels.len(), bottom, top);
                for (row, pixel) in rows.zip(pixels) {
                    *pixel = shade.apply(texels[down.at(row)]);
                }
            }
        }
    }
}
