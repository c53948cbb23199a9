//! Direct columns: the wall columns of small pictures, drawn without a batch.
//!
//! A small picture is in the cache as a whole, so that pixels far apart cost no more than neighbours, and
//! a batch would take longer to prepare than to draw. Each column is drawn straight from its texture,
//! four rows at a time, which take 6.5 instructions a pixel. Rejected: four columns at a time. They take
//! 7, and if the columns differ in height, the rest has to be drawn column by column.

use std::mem;
use std::ops::Range;

use super::band::Band;
use crate::color::Rgb;
use crate::visibility::{Lighting, Scene, TextureStepper};
use crate::world::texture::MipLevel;

/// The most rows of a band, and the most pixels, for which direct columns take less time.
const MAX_ROWS: usize = 256;
const MAX_PIXELS: usize = 1 << 17;
/// The bytes of a level-1 data cache, and of each of its ways, as most processors have them.
const CACHE: usize = 1 << 15;
const WAY: usize = 1 << 12;

/// Whether the columns of `band` are better drawn directly.
pub(crate) fn are_for(scene: Scene<'_>, band: &Band<'_>) -> bool {
    let (rows, width) = (band.rows().len(), band.width());
    let is_small = rows <= MAX_ROWS && rows * width <= MAX_PIXELS;
    is_small && is_column_cached(rows, width) && scene.projection.is_horizon_near()
}

/// Whether the next column of `rows` pixels finds this one in the cache, in a picture of this `width`. The rows
/// of a picture whose width is a multiple of a large power of two compete for a few sets of the cache.
fn is_column_cached(rows: usize, width: usize) -> bool {
    let bytes_of_row = width * size_of::<Rgb>();
    let bytes_between_sets = WAY.min(1 << bytes_of_row.trailing_zeros());
    rows * bytes_between_sets <= CACHE
}

/// Whether there is a loop for columns of this number of texels: a power of two, up to 256. Others are
/// drawn faster in a batch.
#[inline]
pub(crate) fn have(texels: usize) -> bool {
    texels.is_power_of_two() && texels <= 256
}

/// A column of pixels, which is not empty, of a face. All its rows but the first and the last are on the face.
#[derive(Clone, Debug)]
pub(crate) struct DirectColumn {
    pub(crate) x: u32,
    pub(crate) rows: Range<u32>,
    pub(crate) u: f64,
    pub(crate) stepper: TextureStepper,
}

/// Draws `columns` of `level` in this `lighting`. There must be a loop for them.
#[inline]
pub(crate) fn draw<L: Lighting>(
    level: &MipLevel,
    lighting: L,
    columns: impl Iterator<Item = DirectColumn>,
    band: &mut Band<'_>,
) {
    let (texels, lighting) = lighting.lit_texels(level);
    let lit = LitLevel { level, texels, lighting };
    match level.height() {
        256 => lit.draw::<256, 8>(columns, band),
        128 => lit.draw::<128, 7>(columns, band),
        64 => lit.draw::<64, 6>(columns, band),
        32 => lit.draw::<32, 5>(columns, band),
        16 => lit.draw::<16, 4>(columns, band),
        8 => lit.draw::<8, 3>(columns, band),
        4 => lit.draw::<4, 2>(columns, band),
        2 => lit.draw::<2, 1>(columns, band),
        _ => columns.for_each(|column| lit.draw_rows(column, band)),
    }
}

/// A level, its texels, and the lighting that is left to be applied to them.
struct LitLevel<'a, L> {
    level: &'a MipLevel,
    texels: &'a [Rgb],
    lighting: L,
}

impl<L: Lighting> LitLevel<'_, L> {
    /// Draws `columns` of `N` texels, two to the power of `BITS`.
    #[inline(never)]
    fn draw<const N: usize, const BITS: u32>(
        &self,
        columns: impl Iterator<Item = DirectColumn>,
        band: &mut Band<'_>,
    ) {
        let (of_columns, _) = self.texels.as_chunks::<N>();
        let width = band.width();
        for DirectColumn { x, rows, u, stepper } in columns {
            let Some(texels) = of_columns.get(self.level.column_index(u)) else { continue };
            let position = stepper.in_uppermost::<BITS>(rows.start);
            let pixels = band.pixels_from(x, rows.clone());
            draw_pixels::<_, N, BITS>(texels, position, self.lighting, pixels, width);
            // Rounding may put the first row and the last one a texel too far.
            for row in [rows.start, rows.end - 1] {
                if !stepper.is_on_face(row) {
                    let column = DirectColumn { x, rows: row..row + 1, u, stepper };
                    self.draw_rows(column, band);
                }
            }
        }
    }

    /// Draws `column`. A reference would force each column into memory.
    #[cold]
    #[inline(never)]
    fn draw_rows(&self, column: DirectColumn, band: &mut Band<'_>) {
        let DirectColumn { x, rows, u, stepper } = column;
        let height = self.level.height() as usize;
        let texels = &self.texels[self.level.column_index(u) * height..][..height];
        let first = rows.start;
        for (pixel, row) in band.column_mut(x, rows).zip(first..) {
            *pixel = self.lighting.apply(texels[stepper.at(row)]);
        }
    }
}

/// Draws `texels`, of which there are `N`, two to the power of `BITS`, on the first of `pixels` and every
/// `width`th one after it. The uppermost bits of a position are the index of its texel, so that a lookup needs
/// no bounds check. The loop is in a function of its own, which has all registers.
#[inline(never)]
fn draw_pixels<L: Lighting, const N: usize, const BITS: u32>(
    texels: &[Rgb; N],
    (mut position, step): (u64, u64),
    lighting: L,
    pixels: &mut [Rgb],
    width: usize,
) {
    let at = |position: u64| lighting.apply(texels[(position >> (u64::BITS - BITS)) as usize % N]);
    let mut rest = pixels;
    let [second, third, fourth, four_rows] = [1, 2, 3, 4].map(|rows| rows * width);
    // Tested once, none is tested in the loop.
    if second >= four_rows || third >= four_rows || fourth >= four_rows {
        return;
    }
    // Multiples do not wait for each other, as sums do.
    let steps = [1, 2, 3, 4].map(|rows| step.wrapping_mul(rows));
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
    use std::iter;
    use std::num::NonZeroU32;

    use proptest::prelude::*;

    use super::*;
    use crate::cast::Side;
    use crate::render::Frame;
    use crate::visibility::{FrameSize, PixelAspect, Projection, SideLit};
    use crate::world::{Camera, FieldOfView, Heading, Pitch, Texture};

    const HEIGHT: u32 = 90;

    /// A column of a wall: its distance, its texture coordinate, and the power of two of its texels; or `None`.
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
        ) {
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
                let (rows, level) = (projection.wall_rows(t), textures[bits].level(0));
                let wall = projection.wall_texels(level.height() as usize);
                let stepper = projection.texels_down_the_wall(t, wall);
                let lighting = SideLit(side);
                for row in rows.clone() {
                    shown[row as usize][x] = lighting.apply(level.column(u)[stepper.at(row)]);
                }
                if !rows.is_empty() {
                    let column = DirectColumn { x: x as u32, rows, u, stepper };
                    draw(level, lighting, iter::once(column), &mut band);
                }
            }
            prop_assert!(frame.rows().eq(shown));
        }
    }
}
