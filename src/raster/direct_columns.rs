//! Direct columns: the wall columns of small pictures, drawn without a batch.
//!
//! A small picture fits in the cache. Pixels far apart therefore cost no more than neighbours, and
//! a batch would take longer to prepare than to draw. Each column is drawn straight from its
//! texture, four rows at a time, at 6.5 instructions a pixel. Rejected: four columns at a time (7
//! instructions a pixel). If these columns differ in height, the rest has to be drawn column by
//! column.

use std::mem;
use std::ops::Range;

use super::band::Band;
use crate::color::Rgb;
use crate::visibility::{FaceColumn, FaceTexels, FrameContext, Lighting};
use crate::world::texture::MipLevel;

/// The most rows and the most pixels of a band for which direct columns are faster.
const MAX_ROWS: usize = 256;
const MAX_PIXELS: usize = 1 << 17;
/// The size in bytes of a level-1 data cache, and of each of its ways, on most processors.
const CACHE: usize = 1 << 15;
const WAY: usize = 1 << 12;

/// Whether direct columns are faster than a batch for `band`.
pub(crate) fn are_for(scene: FrameContext<'_>, band: &Band<'_>) -> bool {
    let (rows, width) = (band.rows().len(), band.width());
    let is_small = rows <= MAX_ROWS && rows * width <= MAX_PIXELS;
    is_small && is_column_cached(rows, width) && scene.projection.is_horizon_near()
}

/// Whether the cache still contains a column of `rows` pixels when the next column is drawn, in a
/// picture of this `width`. If the width is a multiple of a large power of two, the rows of the
/// picture compete for a few sets of the cache.
fn is_column_cached(rows: usize, width: usize) -> bool {
    let bytes_of_row = width * size_of::<Rgb>();
    let bytes_between_sets = WAY.min(1 << bytes_of_row.trailing_zeros());
    rows * bytes_between_sets <= CACHE
}

/// Whether there is a loop for columns with this number of texels: a power of two, up to 256. Other
/// columns are faster in a batch.
#[inline]
pub(crate) fn have(texels: usize) -> bool {
    texels.is_power_of_two() && texels <= 256
}

/// Neighbouring columns of pixels that show one level of a face in one lighting. The first of them
/// is column `x`.
pub(crate) struct DirectColumns<'a, L> {
    pub(crate) level: &'a MipLevel,
    pub(crate) texels: FaceTexels,
    pub(crate) lighting: L,
    pub(crate) x: u32,
    pub(crate) columns: &'a [FaceColumn],
}

impl<L: Lighting> DirectColumns<'_, L> {
    /// Draws the columns on `band`. There must be a loop for their number of texels.
    pub(crate) fn draw(&self, band: &mut Band<'_>) {
        let (lit, texels) = (self, self.lighting.texels(self.level));
        match self.level.height() {
            256 => lit.draw_texels::<256, 8>(texels, band),
            128 => lit.draw_texels::<128, 7>(texels, band),
            64 => lit.draw_texels::<64, 6>(texels, band),
            32 => lit.draw_texels::<32, 5>(texels, band),
            16 => lit.draw_texels::<16, 4>(texels, band),
            8 => lit.draw_texels::<8, 3>(texels, band),
            4 => lit.draw_texels::<4, 2>(texels, band),
            2 => lit.draw_texels::<2, 1>(texels, band),
            _ => {
                let rows = band.rows();
                for (x, column) in (self.x..).zip(self.columns) {
                    lit.draw_rows(texels, (x, column), column.rows.within(&rows), band);
                }
            }
        }
    }

    /// Draws columns of `N` texels. `N` is 2 to the power of `BITS`.
    #[inline(never)]
    fn draw_texels<const N: usize, const BITS: u32>(&self, texels: &[Rgb], band: &mut Band<'_>) {
        let (of_columns, _) = texels.as_chunks::<N>();
        let (width, all_rows) = (band.width(), band.rows());
        let mut shaded = [Rgb::BLACK; N];
        for (x, column) in (self.x..).zip(self.columns) {
            let rows = column.rows.within(&all_rows);
            let Some(of_column) = of_columns.get(self.level.column_index(column.u)) else {
                continue;
            };
            if rows.is_empty() {
                continue;
            }
            let stepper = self.texels.at(column.t);
            let position = stepper.in_uppermost::<BITS>(rows.start);
            let pixels = band.pixels_from(x, rows.clone());
            if L::HAS_TEXELS {
                draw_pixels::<N, BITS>(of_column, position, pixels, width);
            } else {
                let shown = stepper.texels_of(&rows);
                shaded[shown.clone()].copy_from_slice(&of_column[shown.clone()]);
                self.lighting.apply_to_all(&mut shaded[shown]);
                draw_pixels::<N, BITS>(&shaded, position, pixels, width);
            }
            // Rounding may move the first and the last row one texel too far.
            if !stepper.has_ends_of(&rows) {
                for row in [rows.start, rows.end - 1] {
                    self.draw_rows(texels, (x, column), row..row + 1, band);
                }
            }
        }
    }

    /// Draws these `rows` of a column.
    #[cold]
    #[inline(never)]
    fn draw_rows(
        &self,
        texels: &[Rgb],
        (x, column): (u32, &FaceColumn),
        rows: Range<u32>,
        band: &mut Band<'_>,
    ) {
        let height = self.level.height() as usize;
        let texels = &texels[self.level.column_index(column.u) * height..][..height];
        let (stepper, first) = (self.texels.at(column.t), rows.start);
        for (pixel, row) in band.column_mut(x, rows).zip(first..) {
            let texel = texels[stepper.at(row)];
            *pixel = if L::HAS_TEXELS { texel } else { self.lighting.apply(texel) };
        }
    }
}

/// Draws `texels` on the first of `pixels` and on every `width`th pixel after it. `N` is 2 to the
/// power of `BITS`. The uppermost bits of a position are the index of its texel, so a lookup needs
/// no bounds check. The loop is in a separate function, where it can use all registers.
#[inline(never)]
fn draw_pixels<const N: usize, const BITS: u32>(
    texels: &[Rgb; N],
    (mut position, step): (u64, u64),
    pixels: &mut [Rgb],
    width: usize,
) {
    let at = |position: u64| texels[(position >> (u64::BITS - BITS)) as usize % N];
    let [second, third, fourth, four_rows] = [1, 2, 3, 4].map(|rows| rows * width);
    // This test removes the bounds checks from the loop.
    if second >= four_rows || third >= four_rows || fourth >= four_rows {
        return;
    }
    // Multiples do not depend on each other; sums would.
    let steps = [1, 2, 3, 4].map(|rows| step.wrapping_mul(rows));
    let mut rest = pixels;
    while rest.len() >= four_rows {
        let (pixels, below) = mem::take(&mut rest).split_at_mut(four_rows);
        pixels[0] = at(position);
        pixels[second] = at(position.wrapping_add(steps[0]));
        pixels[third] = at(position.wrapping_add(steps[1]));
        pixels[fourth] = at(position.wrapping_add(steps[2]));
        position = position.wrapping_add(steps[3]);
        rest = below;
    }
    while let [pixel, ..] = rest {
        *pixel = at(position);
        position = position.wrapping_add(step);
        rest = mem::take(&mut rest).get_mut(width..).unwrap_or_default();
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroU32;

    use proptest::prelude::*;

    use super::*;
    use crate::cast::Side;
    use crate::render::Frame;
    use crate::visibility::{Faded, FrameSize, PixelAspect, Projection, Rows, SideLit};
    use crate::world::{Camera, FieldOfView, Heading, Light, Pitch, Texture};

    const HEIGHT: u32 = 90;

    /// A column of a wall, or `None`: its distance, its texture coordinate, and the binary
    /// logarithm of its number of texels.
    fn column() -> impl Strategy<Value = Option<(f64, f64, usize)>> {
        let bits = prop_oneof![1 => 0_usize..9, 4 => Just(6)];
        prop::option::weighted(0.95, (0.01..20.0, 0.0..1.0, bits))
    }

    fn texture(bits: u32) -> Texture {
        let [width, height] = [8, 1 << bits].map(|side| NonZeroU32::new(side).unwrap());
        Texture::from_fn(width, height, |x, y| Rgb::new(1, x as u8, y as u8))
    }

    proptest! {
        #[test]
        fn columns_show_their_texels(
            columns in prop::collection::vec(column(), 1..200),
            degrees in -30.0..30.0,
            side in prop::sample::select(&[Side::X, Side::Y][..]),
            is_faded in any::<bool>(),
        ) {
            let light = Light::new(0.7).unwrap();
            let textures: Vec<_> = (0..9).map(texture).collect();
            let size = FrameSize::new(columns.len() as u32, HEIGHT).unwrap();
            let east = Heading::from_degrees(0.0).unwrap();
            let camera = Camera::new((0.0, 0.0).into(), east, FieldOfView::default()).unwrap();
            let camera = camera.with_pitch(Pitch::from_degrees(degrees).unwrap());
            let projection = Projection::new(&camera, size, PixelAspect::SQUARE);
            let mut frame = Frame::new(size, PixelAspect::SQUARE);
            let mut shown = vec![vec![Rgb::BLACK; columns.len()]; HEIGHT as usize];
            let mut band = frame.whole();
            for (x, column) in columns.iter().enumerate() {
                let Some((t, u, bits)) = *column else { continue };
                let [start, end] = [1.0, 0.0].map(|height| projection.row_of_height(height, t));
                let (rows, level) = (Rows { start, end }, textures[bits].level(0));
                let texels = projection.face_texels(level.height() as usize, (0.0, 1.0));
                let stepper = texels.at(t);
                for row in start..end {
                    let texel = level.column(u)[stepper.at(row)];
                    shown[row as usize][x] = if is_faded {
                        Faded::of_wall(side, light, None, t).apply(texel)
                    } else {
                        SideLit(side).apply(texel)
                    };
                }
                let (x, columns) = (x as u32, &[FaceColumn { rows, t, u }]);
                if is_faded {
                    let lighting = Faded::of_wall(side, light, None, t);
                    DirectColumns { level, texels, lighting, x, columns }.draw(&mut band);
                } else {
                    let lighting = SideLit(side);
                    DirectColumns { level, texels, lighting, x, columns }.draw(&mut band);
                }
            }
            prop_assert!(frame.rows().eq(shown));
        }
    }
}
