//! Masked columns: faces with holes, as wide as a pixel.

use super::target::Target;
use super::wall_column::lighting_of;
use crate::cast::Side;
use crate::visibility::{Extent, Facing, Lighting, Pass, Scene, SeeThroughColumn, Surface};
use crate::world::TextureId;

/// Draws `column`, which has `texture`, over the pixels behind it.
pub(crate) fn draw(
    scene: Scene<'_>,
    column: &SeeThroughColumn,
    texture: TextureId,
    target: &mut Target<'_>,
) {
    let SeeThroughColumn { column: x, facing, slope, t, u, light, extent, .. } = *column;
    let rows = target.clip(&column.rows);
    target.count_pixels(Pass::SeeThrough, rows.len());
    target.count_texels(Pass::SeeThrough, rows.len());
    let level = scene.level_on_face(texture, t, slope);
    let texels = level.column(u);
    let Some(alphas) = level.alpha_column(u) else { return };
    let lighting = lighting_of(scene, facing, light, t);
    let stepper = match extent {
        Extent::Level => {
            let projection = scene.projection;
            projection.texels_down_the_wall(t, projection.wall_texels(texels.len()))
        }
        Extent::Heights { bottom, top } => {
            let projection = scene.projection;
            projection.texels_down_the_face(t, projection.face_texels(texels.len(), (bottom, top)))
        }
    };
    for (row, pixel) in rows.clone().zip(target.column_mut(x, rows.clone())) {
        let texel = stepper.at(row);
        *pixel = lighting.apply(texels[texel]).over(*pixel, alphas[texel]);
    }
    let surface = match facing {
        Facing::Side(side) => Surface::of_wall(side),
        Facing::Normal(_) => Surface::of_wall(Side::X),
    };
    let is_shown = |row| alphas[stepper.at(row)] > u8::MAX / 2;
    target.mark(x, rows.start, surface, rows.map(is_shown));
}
