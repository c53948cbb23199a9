//! Columns of faces, drawn straight from their textures.
//!
//! Four rows of a column are drawn at a time, at 6.5 instructions a pixel. The pixels of a column are far
//! apart in memory, so a large picture is drawn in groups of [rows](rows_at_once) that stay in the cache
//! until the next column. Rejected: shading the texels of a hundred columns first and drawing eight columns
//! at a time. This was no faster in any picture, and took 400 lines.

use std::mem;
use std::ops::Range;

use super::band::Band;
use crate::color::Rgb;
use crate::visibility::{FaceColumn, FaceTexels, Lighting};
use crate::world::texture::MipLevel;

/// The size in bytes of a level-1 data cache, and of each of its ways, on most processors.
const CACHE: usize = 1 << 15;
const WAY: usize = 1 << 12;

/// The number of rows of which the cache still contains the pixels of a column when the next column is
/// drawn, in a picture of this `width`. If the width is a multiple of a large power of two, the rows of the
/// picture compete for a few sets of the cache.
pub(crate) fn rows_at_once(width: usize) -> usize {
    let bytes_of_row = width * size_of::<Rgb>();
    let bytes_between_sets = WAY.min(1 << bytes_of_row.trailing_zeros());
    CACHE / bytes_between_sets
}

/// Neighbouring columns of pixels that show one level of a face in one lighting.
pub(crate) struct TextureColumns<'a> {
    level: &'a MipLevel,
    /// The texels of the level, and the lighting that still has to be applied to them.
    texels: &'a [Rgb],
    lighting: Option<Lighting>,
    of_face: FaceTexels,
    /// The first column, and the values of it and the others.
    x: usize,
    columns: &'a [FaceColumn],
}

impl<'a> TextureColumns<'a> {
    pub(crate) fn new(
        (level, of_face): (&'a MipLevel, FaceTexels),
        lighting: Lighting,
        (x, columns): (usize, &'a [FaceColumn]),
    ) -> Self {
        let (texels, lighting) = match lighting.stored_texels(level) {
            Some(texels) => (texels, None),
            None => (level.texels(), Some(lighting)),
        };
        Self { level, texels, lighting, of_face, x, columns }
    }

    /// Draws `rows` of the columns on `band`.
    pub(crate) fn draw(&self, rows: &Range<u32>, is_horizon_near: bool, band: &mut Band<'_>) {
        match self.lighting {
            _ if !is_horizon_near => self.draw_exactly(rows, band),
            None => self.draw_stored::<true>(rows, band),
            Some(_) => self.draw_stored::<false>(rows, band),
        }
    }

    /// Draws `rows` of the columns. `IS_STORED` is true if no lighting has to be applied.
    fn draw_stored<const IS_STORED: bool>(&self, rows: &Range<u32>, band: &mut Band<'_>) {
        match self.level.height() {
            1024 => self.draw_texels::<IS_STORED, 1024, 10>(rows, band),
            512 => self.draw_texels::<IS_STORED, 512, 9>(rows, band),
            256 => self.draw_texels::<IS_STORED, 256, 8>(rows, band),
            128 => self.draw_texels::<IS_STORED, 128, 7>(rows, band),
            64 => self.draw_texels::<IS_STORED, 64, 6>(rows, band),
            32 => self.draw_texels::<IS_STORED, 32, 5>(rows, band),
            16 => self.draw_texels::<IS_STORED, 16, 4>(rows, band),
            8 => self.draw_texels::<IS_STORED, 8, 3>(rows, band),
            4 => self.draw_texels::<IS_STORED, 4, 2>(rows, band),
            2 => self.draw_texels::<IS_STORED, 2, 1>(rows, band),
            _ => self.draw_exactly(rows, band),
        }
    }

    /// Draws `rows` of columns with any number of texels, at any height above the horizon.
    fn draw_exactly(&self, rows: &Range<u32>, band: &mut Band<'_>) {
        for (x, column) in (self.x..).zip(self.columns) {
            self.draw_rows((x, column), column.rows.within(rows), band);
        }
    }

    /// Draws `all_rows` of columns of `N` texels. `N` is 2 to the power of `BITS`.
    #[inline(never)]
    fn draw_texels<const IS_STORED: bool, const N: usize, const BITS: u32>(
        &self,
        all_rows: &Range<u32>,
        band: &mut Band<'_>,
    ) {
        let (of_columns, _) = self.texels.as_chunks::<N>();
        let width = band.width();
        let mut shaded = ShadedColumn { texels: [Rgb::BLACK; N], index: usize::MAX, known: 0..0 };
        for (x, column) in (self.x..).zip(self.columns) {
            let rows = column.rows.within(all_rows);
            let index = self.level.column_index(column.u);
            let Some(of_column) = of_columns.get(index) else { continue };
            if rows.is_empty() {
                continue;
            }
            let stepper = self.of_face.at(column.t);
            let position = stepper.in_uppermost::<BITS>(rows.start);
            let pixels = band.pixels_from(x, rows.clone());
            let of_column = match self.lighting {
                Some(lighting) if !IS_STORED => {
                    shaded.shade(lighting, (index, of_column), stepper.texels_of(&rows))
                }
                _ => of_column,
            };
            draw_pixels::<N, BITS>(of_column, position, pixels, width);
            // Rounding may move the first and the last row one texel too far.
            if !stepper.has_ends_of(&rows) {
                for row in [rows.start, rows.end - 1] {
                    self.draw_rows((x, column), row..row + 1, band);
                }
            }
        }
    }

    /// Draws these `rows` of a column.
    #[cold]
    #[inline(never)]
    fn draw_rows(&self, (x, column): (usize, &FaceColumn), rows: Range<u32>, band: &mut Band<'_>) {
        let height = self.level.height() as usize;
        let texels = &self.texels[self.level.column_index(column.u) * height..][..height];
        let (stepper, first) = (self.of_face.at(column.t), rows.start);
        for (pixel, row) in band.column_mut(x, rows).zip(first..) {
            let texel = texels[stepper.at(row)];
            *pixel = self.lighting.map_or(texel, |lighting| lighting.apply(texel));
        }
    }
}

/// A column of a texture in one lighting.
struct ShadedColumn<const N: usize> {
    texels: [Rgb; N],
    /// The index of the column, and the range of its texels that are shaded.
    index: usize,
    known: Range<usize>,
}

impl<const N: usize> ShadedColumn<N> {
    /// The texels of the column `index`. At least the texels in `shown` are shaded.
    #[inline(never)]
    fn shade(
        &mut self,
        lighting: Lighting,
        (index, texels): (usize, &[Rgb; N]),
        shown: Range<usize>,
    ) -> &[Rgb; N] {
        let is_known = self.known.start <= shown.start && shown.end <= self.known.end;
        if self.index != index || !is_known {
            self.texels[shown.clone()].copy_from_slice(&texels[shown.clone()]);
            lighting.apply_to_all(&mut self.texels[shown.clone()]);
            (self.index, self.known) = (index, shown);
        }
        &self.texels
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
    use crate::visibility::{FrameSize, PixelAspect, Projection, Rows};
    use crate::world::{Camera, FieldOfView, Heading, Light, Pitch, Texture};

    const HEIGHT: u32 = 90;

    /// The distance of a column, its texture coordinate, and the bottom and the top of its face.
    type Column = (f64, f64, (f64, f64));

    fn column() -> impl Strategy<Value = Column> {
        let wall = Just((0.0, 1.0));
        let face = (-2.0..2.0_f64, 0.0..4.0_f64).prop_map(|(bottom, high)| (bottom, bottom + high));
        (0.01..20.0, 0.0..1.0, prop_oneof![wall, face])
    }

    proptest! {
        #[test]
        fn columns_show_their_texels(
            columns in prop::collection::vec(column(), 1..200),
            count in prop::sample::select(&[1_u32, 2, 3, 8, 48, 64, 256, 300, 1024][..]),
            degrees in -30.0..30.0,
            is_horizon_near: bool,
            side in prop::sample::select(&[Side::X, Side::Y][..]),
            is_faded: bool,
            rows_at_once in 1_usize..100,
        ) {
            let count = NonZeroU32::new(count).unwrap();
            let texture = Texture::from_fn(NonZeroU32::new(8).unwrap(), count, |x, y| {
                Rgb::new(x as u8, (y >> 8) as u8, y as u8)
            });
            let level = texture.level(0);
            let size = FrameSize::new(columns.len() as u32, HEIGHT).unwrap();
            let east = Heading::from_degrees(0.0).unwrap();
            let camera = Camera::new((0.0, 0.0).into(), east, FieldOfView::default()).unwrap();
            let camera = camera.with_pitch(Pitch::from_degrees(degrees).unwrap());
            let projection = Projection::new(&camera, size, PixelAspect::SQUARE);
            let light = if is_faded { Light::new(0.7).unwrap() } else { Light::FULL };
            let lighting = Lighting::of_wall(side, light, None, 1.0);
            let mut frame = Frame::new(size, PixelAspect::SQUARE);
            let mut expected = vec![vec![Rgb::BLACK; columns.len()]; HEIGHT as usize];
            let mut band = frame.whole();
            for (x, &(t, u, (bottom, top))) in columns.iter().enumerate() {
                let [start, end] = [top, bottom].map(|height| projection.row_of_height(height, t));
                let texels = projection.face_texels(count.get() as usize, (bottom, top));
                for row in start..end {
                    let texel = level.column(u)[texels.at(t).at(row)];
                    expected[row as usize][x] = lighting.apply(texel);
                }
                let (x, columns) = (x, &[FaceColumn { rows: Rows { start, end }, t, u }]);
                for first in (0..HEIGHT).step_by(rows_at_once) {
                    let rows = first..HEIGHT.min(first + rows_at_once as u32);
                    let columns = TextureColumns::new((level, texels), lighting, (x, columns));
                    columns.draw(&rows, is_horizon_near, &mut band);
                }
            }
            prop_assert!(frame.rows().eq(expected));
        }
    }
}
