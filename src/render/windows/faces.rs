//! The pass for what stands upright: walls, the sides of floors and of what hangs from above, doors.

use std::ops::Range;

use super::Scene;
use crate::cast::Side;
use crate::render::Frame;
use crate::render::plan::WallLoop;
use crate::render::shade::{Faded, OfSide, Shade};
use crate::render::tally::{Pass, Tally};
use crate::world::{Light, Paint, Rgb, Texture};

/// A face as wide as a pixel, as far as it is seen.
#[derive(Clone, Debug)]
pub(super) struct Face {
    pub(super) column: u32,
    pub(super) rows: Range<u32>,
    pub(super) side: Side,
    pub(super) t: f64,
    pub(super) u: f64,
    pub(super) paint: Paint,
    pub(super) light: Light,
    pub(super) stretch: Stretch,
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
    frame: &mut Frame,
    tally: &mut T,
) {
    for face in faces {
        if plan.faded {
            let shade = Faded::of_wall(face.side, face.light, scene.world.fog(), face.t);
            face.draw(scene, shade, frame, tally);
        } else {
            face.draw(scene, OfSide(face.side), frame, tally);
        }
    }
}

impl Face {
    fn draw<S: Shade, T: Tally>(
        &self,
        scene: Scene<'_>,
        shade: S,
        frame: &mut Frame,
        tally: &mut T,
    ) {
        let rows = self.rows.clone();
        tally.pixels(Pass::Walls, rows.len());
        let pixels = frame.column_mut(self.column, rows.clone());
        match self.paint {
            Paint::Color(color) => {
                let color = shade.apply(color);
                pixels.for_each(|pixel| *pixel = color);
            }
            Paint::Texture(id) => {
                tally.texels(Pass::Walls, rows.len());
                let texels = self.texels(scene, scene.world.texture(id));
                let Stretch { bottom, top } = self.stretch;
                let down = scene.projection.texels_down_the_face(self.t, texels.len(), bottom, top);
                for (row, pixel) in rows.zip(pixels) {
                    *pixel = shade.apply(texels[down.at(row)]);
                }
            }
        }
    }

    /// The column of the texture that shows, from a level that suits the distance.
    fn texels<'t>(&self, scene: Scene<'_>, texture: &'t Texture) -> &'t [Rgb] {
        let texels = f64::from(texture.width()) * f64::from(texture.height());
        let direction = scene.projection.direction_of(self.column);
        let across = match self.side {
            Side::X => direction.x,
            Side::Y => direction.y,
        };
        let area = scene.projection.pixel_area_on_wall(self.t, across);
        texture.level(scene.filter.halvings(area * texels)).column(self.u)
    }
}
