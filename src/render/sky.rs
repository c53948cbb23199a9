//! The pass for the sky: in place of a ceiling, and beyond the edge of the map.

use std::f64::consts::TAU;

use glam::DVec2;

use super::band::Band;
use super::plan::SkyLoop;
use super::planes::spans;
use super::projection::Projection;
use super::tally::{Pass, Tally};
use super::{Column, Filter, Scene};
use crate::cast::Unfolding;
use crate::color::Rgb;
use crate::world::texture::Level;
use crate::world::{Sky, World};

/// The sky as one camera sees it.
pub(super) enum SkyView<'a> {
    Gradient { projection: &'a Projection, zenith: Rgb, horizon: Rgb },
    Panorama { projection: &'a Projection, level: &'a Level, columns: &'a [SkyColumn] },
}

/// Where a column of pixels looks on a panorama.
#[derive(Clone, Copy, Debug)]
pub(super) struct SkyColumn {
    /// From its left edge, in 2⁻⁶⁴ths of its width.
    across: u64,
    /// How far up a pixel is, as a share of its height, for each unit of the pixel's slope.
    up_for_slope: f64,
}

/// What 1 is in 2⁻⁶⁴ths.
const WHOLE: f64 = 18_446_744_073_709_551_616.0;

impl<'a> SkyView<'a> {
    /// The sky of `world`; `columns` is memory to work with.
    pub(super) fn new(
        world: &'a World,
        projection: &'a Projection,
        filter: Filter,
        columns: &'a mut Vec<SkyColumn>,
    ) -> Self {
        match world.sky() {
            Sky::Gradient { zenith, horizon } => Self::Gradient { projection, zenith, horizon },
            Sky::Panorama(id) => {
                let texture = world.texture(id);
                // Along the horizon a texel is as high as it is wide.
                let texels_per_radian = f64::from(texture.width()) / TAU;
                let area = projection.pixel_angles() * texels_per_radian;
                let level = texture.level(filter.halvings(area.x * area.y));
                let height = f64::from(texture.height()) / texels_per_radian;
                columns.clear();
                columns
                    .extend(projection.rays().map(|ray| SkyColumn::new(ray.direction(), height)));
                Self::Panorama { projection, level, columns }
            }
        }
    }

    /// Draws it into `pixels`, which are those from column `x` on of `row`.
    pub(super) fn draw<T: Tally>(&self, row: u32, x: usize, pixels: &mut [Rgb], tally: &mut T) {
        tally.pixels(Pass::Sky, pixels.len());
        match *self {
            Self::Gradient { projection, zenith, horizon } => {
                pixels.fill(gradient(zenith, horizon, projection.slope(row)));
            }
            Self::Panorama { projection, level, columns } => {
                tally.texels(Pass::Sky, pixels.len());
                let slope = projection.slope(row);
                for (pixel, column) in pixels.iter_mut().zip(&columns[x..]) {
                    let down = 1.0 - slope * column.up_for_slope;
                    *pixel = level.at_fraction(column.across, (down * WHOLE) as u64);
                }
            }
        }
    }

    /// As [`SkyView::draw`], seen in the mirrors behind which the map is unfolded by `unfolding`.
    pub(super) fn draw_reflected<T: Tally>(
        &self,
        unfolding: Unfolding,
        row: u32,
        x: usize,
        pixels: &mut [Rgb],
        tally: &mut T,
    ) {
        match *self {
            Self::Gradient { .. } => self.draw(row, x, pixels, tally),
            Self::Panorama { projection, level, columns } => {
                tally.pixels(Pass::Sky, pixels.len());
                tally.texels(Pass::Sky, pixels.len());
                let slope = projection.slope(row);
                for (pixel, column) in pixels.iter_mut().zip(&columns[x..]) {
                    let down = 1.0 - slope * column.up_for_slope;
                    let across = column.reflected_across(unfolding);
                    *pixel = level.at_fraction(across, (down * WHOLE) as u64);
                }
            }
        }
    }

    /// Draws it above all walls.
    pub(super) fn draw_overhead<T: Tally>(
        &self,
        plan: SkyLoop,
        scene: Scene<'_>,
        band: &mut Band<'_>,
        tally: &mut T,
    ) {
        let ground = scene.projection.first_row_of_ground();
        for row in band.clip(&(0..ground)) {
            let pixels = band.row_mut(row);
            match plan {
                // A fill of all takes less time than to look for what is hidden.
                SkyLoop::Gradient => self.draw(row, 0, pixels, tally),
                SkyLoop::Panorama => {
                    let shows = |column: &Column| row < column.rows.start || column.hit.is_none();
                    for span in spans(scene.columns, shows) {
                        self.draw(row, span.start, &mut pixels[span], tally);
                    }
                }
            }
        }
    }

    /// Draws it where rays left the map, over whatever ceiling there was until there.
    pub(super) fn draw_beyond_edge<T: Tally>(
        &self,
        scene: Scene<'_>,
        band: &mut Band<'_>,
        tally: &mut T,
    ) {
        let first_rows = scene
            .columns
            .iter()
            .filter(|column| column.hit.is_none())
            .map(|column| column.rows.start);
        let Some(first) = first_rows.min() else { return };
        for row in band.clip(&(first..scene.projection.first_row_of_ground())) {
            let pixels = band.row_mut(row);
            let shows = |column: &Column| column.hit.is_none() && column.rows.start <= row;
            for span in spans(scene.columns, shows) {
                self.draw(row, span.start, &mut pixels[span], tally);
            }
        }
    }
}

impl SkyColumn {
    /// Where a ray along `direction` looks on a cylinder of radius 1 that is `height` high.
    fn new(direction: DVec2, height: f64) -> Self {
        let turn = libm::atan2(direction.y, direction.x) / TAU;
        let turn = if turn < 0.0 { turn + 1.0 } else { turn };
        Self { across: (turn * WHOLE) as u64, up_for_slope: 1.0 / (direction.length() * height) }
    }

    /// Where it looks after the reflections that unfold the map by `unfolding`: a turn is taken from
    /// the east, so that a mirror that faces north or south negates it.
    fn reflected_across(&self, unfolding: Unfolding) -> u64 {
        const HALF: u64 = 1 << 63;
        let direction = unfolding.real_direction(DVec2::ONE);
        let across = if direction.y < 0.0 { self.across.wrapping_neg() } else { self.across };
        if direction.x < 0.0 { HALF.wrapping_sub(across) } else { across }
    }
}

/// The colour of a gradient at that slope: it changes quickly at the horizon and slowly higher up.
fn gradient(zenith: Rgb, horizon: Rgb, slope: f64) -> Rgb {
    let up = (slope / SLOPE_OF_ZENITH).clamp(0.0, 1.0);
    let share = (up * (2.0 - up) * 256.0) as u32;
    horizon.blended(256 - share, zenith, share)
}

/// From which slope on a gradient is all zenith.
const SLOPE_OF_ZENITH: f64 = 0.5;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gradient_goes_from_one_colour_to_the_other() {
        let colors =
            [-1.0, 0.0, 0.5, f64::INFINITY].map(|slope| gradient(Rgb::BLACK, Rgb::WHITE, slope));
        assert_eq!(colors, [Rgb::WHITE, Rgb::WHITE, Rgb::BLACK, Rgb::BLACK]);
        let middle = gradient(Rgb::BLACK, Rgb::WHITE, 0.1);
        assert!((100..200).contains(&middle.red()), "{middle}");
    }
}
