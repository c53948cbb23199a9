//! The sky, which is drawn in place of a ceiling and beyond the edge of the map.

use std::f64::consts::TAU;
use std::ops::Range;

use glam::DVec2;

use super::target::Target;
use crate::cast::MirrorTransform;
use crate::color::Rgb;
use crate::visibility::{DrawList, FrameContext, Pass, Projection};
use crate::world::{Sky, SkyGradient, Texture};

/// The sky as seen by a camera.
pub(crate) enum SkyView<'a> {
    Gradient {
        /// The colour of each row above the horizon.
        rows: &'a [Rgb],
        /// The colour at the horizon.
        horizon: Rgb,
    },
    Panorama {
        projection: &'a Projection,
        texture: &'a Texture,
        lod: usize,
        columns: &'a [SkyColumn],
    },
}

/// The mapping of a column of pixels to a panorama.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SkyColumn {
    /// The distance from the panorama's left edge, in units of 2⁻⁶⁴ of its width.
    across: u64,
    /// The height of a pixel on the panorama, as a fraction of the panorama's height, for each unit
    /// of the pixel's slope.
    up_for_slope: f64,
}

/// The memory of the sky, reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct SkyMemory {
    rows: Vec<Rgb>,
    columns: Vec<SkyColumn>,
}

/// The number 1, in units of 2⁻⁶⁴ and in units of 2⁻³².
const WHOLE: f64 = 18_446_744_073_709_551_616.0;
const WHOLE_IN_32_BITS: f64 = 4_294_967_296.0;

impl<'a> SkyView<'a> {
    /// The sky of `scene`. The colours of a gradient are computed only if `list` shows it.
    pub(crate) fn new(scene: FrameContext<'a>, list: &DrawList, memory: &'a mut SkyMemory) -> Self {
        let directions = &list.directions;
        let FrameContext { world, projection, plan, .. } = scene;
        let SkyMemory { rows, columns } = memory;
        match world.sky() {
            Sky::Gradient(SkyGradient { zenith, horizon }) => {
                rows.clear();
                let shown = 0..if list.shows_sky() { projection.first_row_of_ground() } else { 0 };
                rows.extend(shown.map(|row| gradient(zenith, horizon, projection.slope(row))));
                Self::Gradient { rows, horizon }
            }
            Sky::Panorama(id) => {
                let texture = world.texture(id);
                // At the horizon, a texel is as high as it is wide.
                let texels_per_radian = f64::from(texture.width()) / TAU;
                let area = projection.pixel_angles() * texels_per_radian;
                let lod = plan.filter.lod(area.x * area.y);
                let height = f64::from(texture.height()) / texels_per_radian;
                columns.clear();
                let directions = (0..projection.columns()).map(|x| directions.of(x));
                columns.extend(directions.map(|direction| SkyColumn::new(direction, height)));
                Self::Panorama { projection, texture, lod, columns }
            }
        }
    }

    /// Draws the sky in `columns` of `row`, as seen in the mirrors of `image`.
    pub(crate) fn draw(
        &self,
        row: u32,
        columns: Range<usize>,
        image: MirrorTransform,
        target: &mut Target<'_>,
    ) {
        let across = columns.clone();
        match *self {
            Self::Gradient { rows, horizon } => {
                let color = rows.get(row as usize).copied().unwrap_or(horizon);
                target.span_mut(Pass::Sky, row, columns).fill(color);
            }
            Self::Panorama { projection, texture, lod, columns: places } => {
                let level = texture.level(lod);
                target.count_texels(Pass::Sky, columns.len());
                let slope = projection.slope(row);
                let pixels = target.span_mut(Pass::Sky, row, columns);
                let texel = |column: &SkyColumn, across: u64| {
                    // A conversion to 64 bits would take four times the instructions.
                    let down = (1.0 - slope * column.up_for_slope) * WHOLE_IN_32_BITS;
                    level.at_short_fraction((across >> u32::BITS) as u32, down as u32)
                };
                let [factor, offset] = reflected(image);
                for (pixel, column) in pixels.iter_mut().zip(&places[across]) {
                    let across = column.across.wrapping_mul(factor).wrapping_add(offset);
                    *pixel = texel(column, across);
                }
            }
        }
    }
}

impl SkyColumn {
    /// The mapping of a ray along `direction` to a cylinder of radius 1 and this `height`.
    fn new(direction: DVec2, height: f64) -> Self {
        let turn = libm::atan2(direction.y, direction.x) / TAU;
        let turn = if turn < 0.0 { turn + 1.0 } else { turn };
        Self { across: (turn * WHOLE) as u64, up_for_slope: 1.0 / (direction.length() * height) }
    }
}

/// The factor and the offset of distances from the left edge in the mirrors of `image`. Angles are measured from
/// the east, so a mirror that faces north or south negates them.
fn reflected(image: MirrorTransform) -> [u64; 2] {
    const HALF: u64 = 1 << 63;
    let direction = image.direction_to_map(DVec2::ONE);
    let factor = if direction.x * direction.y < 0.0 { u64::MAX } else { 1 };
    [factor, if direction.x < 0.0 { HALF } else { 0 }]
}

/// The colour of a gradient at this slope. It changes quickly at the horizon and slowly above.
fn gradient(zenith: Rgb, horizon: Rgb, slope: f64) -> Rgb {
    let up = (slope / SLOPE_OF_ZENITH).clamp(0.0, 1.0);
    let share = (up * (2.0 - up) * 256.0) as u32;
    horizon.blended(256 - share, zenith, share)
}

/// The least slope at which a gradient has the colour of the zenith.
const SLOPE_OF_ZENITH: f64 = 0.5;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gradient_runs_from_horizon_to_zenith() {
        let colors =
            [-1.0, 0.0, 0.5, f64::INFINITY].map(|slope| gradient(Rgb::BLACK, Rgb::WHITE, slope));
        assert_eq!(colors, [Rgb::WHITE, Rgb::WHITE, Rgb::BLACK, Rgb::BLACK]);
        let middle = gradient(Rgb::BLACK, Rgb::WHITE, 0.1);
        assert!((100..200).contains(&middle.red()), "{middle}");
    }
}
