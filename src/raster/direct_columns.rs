//! Direct columns: the wall columns of small pictures, drawn without a batch.
//!
//! A small picture is in the cache as a whole, so that pixels far apart cost no more than neighbours,
//! and a batch would take longer to prepare than to draw. Each column is drawn straight from its texture,
//! four rows at a time, which take 6.5 instructions a pixel. Four columns at a time were refused: they
//! take 7, and where the columns differ in height, the rest has to be drawn column by column.

use std::mem;
use std::ops::Range;

use super::band::Band;
use crate::color::Rgb;
use crate::visibility::{Lighting, Scene, TextureStepper};

/// The most rows of a band, and the most pixels, for which direct columns take less time.
const MOST_ROWS: usize = 256;
const MOST_PIXELS: usize = 1 << 17;

/// Whether the columns of `band` are better drawn directly.
pub(super) fn are_for(scene: Scene<'_>, band: &Band<'_>) -> bool {
    let rows = band.rows().len();
    let is_small = rows <= MOST_ROWS && rows * band.width() <= MOST_PIXELS;
    is_small && scene.projection.is_horizon_near()
}

/// A column of pixels, which is not empty, and the texels of its wall from top to bottom.
#[derive(Clone, Debug)]
pub(super) struct DirectColumn<'a> {
    pub(super) x: u32,
    pub(super) rows: Range<u32>,
    pub(super) texels: &'a [Rgb],
    pub(super) stepper: TextureStepper,
}

impl DirectColumn<'_> {
    /// Whether there is a loop for columns of this number of texels: a power of two, up to 256. Others are
    /// drawn faster in a batch.
    #[inline]
    pub(super) fn is_for(texels: usize) -> bool {
        texels.is_power_of_two() && texels <= 256
    }

    /// Draws the column in this `lighting`.
    #[expect(clippy::inline_always, reason = "a call would cost a fifth of it")]
    #[inline(always)]
    pub(super) fn draw<L: Lighting>(&self, lighting: L, band: &mut Band<'_>) {
        let Self { rows, texels, stepper, .. } = self;
        let pixels =
            Pixels { x: self.x as usize, width: band.width(), rows: band.rows_mut(rows.clone()) };
        let first = rows.start;
        match texels.len() {
            256 => pixels.draw::<_, 256, 8>(texels, stepper.in_uppermost::<8>(first), lighting),
            128 => pixels.draw::<_, 128, 7>(texels, stepper.in_uppermost::<7>(first), lighting),
            64 => pixels.draw::<_, 64, 6>(texels, stepper.in_uppermost::<6>(first), lighting),
            32 => pixels.draw::<_, 32, 5>(texels, stepper.in_uppermost::<5>(first), lighting),
            16 => pixels.draw::<_, 16, 4>(texels, stepper.in_uppermost::<4>(first), lighting),
            8 => pixels.draw::<_, 8, 3>(texels, stepper.in_uppermost::<3>(first), lighting),
            4 => pixels.draw::<_, 4, 2>(texels, stepper.in_uppermost::<2>(first), lighting),
            _ => self.clone().draw_rows(rows.clone(), lighting, band),
        }
        // Rounding may put the first row and the last one a texel too far.
        for row in [first, rows.end - 1] {
            if !stepper.is_on_wall(row) {
                self.clone().draw_rows(row..row + 1, lighting, band);
            }
        }
    }

    /// Draws the part of the column in `rows`. A reference would force the column into memory.
    #[cold]
    #[inline(never)]
    fn draw_rows<L: Lighting>(self, rows: Range<u32>, lighting: L, band: &mut Band<'_>) {
        let first = rows.start;
        for (pixel, row) in band.column_mut(self.x, rows).zip(first..) {
            *pixel = lighting.apply(self.texels[self.stepper.at(row)]);
        }
    }
}

/// The pixels of a column.
struct Pixels<'p> {
    x: usize,
    width: usize,
    /// The rows of the column, which are `width` pixels wide.
    rows: &'p mut [Rgb],
}

impl Pixels<'_> {
    /// Draws `texels`, of which there are `N`, two to the power of `BITS`. The uppermost bits of a position
    /// are the index of its texel, so that a lookup needs no bounds check. The loop is in a function of its
    /// own, which has all registers.
    #[inline(never)]
    fn draw<L: Lighting, const N: usize, const BITS: u32>(
        self,
        texels: &[Rgb],
        (mut position, step): (u64, u64),
        lighting: L,
    ) {
        let Some(texels) = texels.first_chunk::<N>() else { return };
        let mut next = || {
            let texel = texels[(position >> (u64::BITS - BITS)) as usize % N];
            position = position.wrapping_add(step);
            lighting.apply(texel)
        };
        let Self { x, width, rows: mut rest } = self;
        let [second, third, fourth] = [1, 2, 3].map(|rows| x + rows * width);
        let four_rows = 4 * width;
        // Tested once, none is tested in the loop.
        if fourth >= four_rows || third >= four_rows || second >= four_rows || x >= width {
            return;
        }
        while rest.len() >= four_rows {
            let (pixels, below) = mem::take(&mut rest).split_at_mut(four_rows);
            pixels[x] = next();
            pixels[second] = next();
            pixels[third] = next();
            pixels[fourth] = next();
            rest = below;
        }
        while rest.len() >= width {
            let (pixels, below) = mem::take(&mut rest).split_at_mut(width);
            pixels[x] = next();
            rest = below;
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::render::Frame;
    use crate::visibility::{FrameSize, FullyLit, PixelAspect, Projection};
    use crate::world::{Camera, FieldOfView, Heading, Pitch};

    const HEIGHT: u32 = 90;

    /// A column of a wall: its distance, and the power of two of its texels; or `None`.
    fn column() -> impl Strategy<Value = Option<(f64, u32)>> {
        prop::option::weighted(0.95, (0.01..20.0, prop_oneof![1 => 0_u32..9, 4 => Just(6)]))
    }

    proptest! {
        #[test]
        fn columns_show_their_texels(
            columns in prop::collection::vec(column(), 1..200),
            degrees in -30.0..30.0,
        ) {
            let texels: Vec<_> = (0..256).map(|texel| Rgb::new(1, 2, texel as u8)).collect();
            let size = FrameSize::new(columns.len() as u32, HEIGHT).unwrap();
            let east = Heading::from_degrees(0.0).unwrap();
            let camera = Camera::new((0.0, 0.0).into(), east, FieldOfView::default()).unwrap();
            let camera = camera.with_pitch(Pitch::from_degrees(degrees).unwrap());
            let projection = Projection::new(&camera, size, PixelAspect::SQUARE);
            let mut frame = Frame::new(size, PixelAspect::SQUARE);
            let mut shown = vec![vec![Rgb::BLACK; columns.len()]; HEIGHT as usize];
            let mut band = frame.whole();
            for (x, column) in columns.iter().enumerate() {
                let Some((t, bits)) = column else { continue };
                let (rows, texels) = (projection.wall_rows(*t), &texels[..1 << bits]);
                let wall = projection.wall_texels(texels.len());
                let stepper = projection.texels_down_the_wall(*t, wall);
                for row in rows.clone() {
                    shown[row as usize][x] = texels[stepper.at(row)];
                }
                if !rows.is_empty() {
                    DirectColumn { x: x as u32, rows, texels, stepper }.draw(FullyLit, &mut band);
                }
            }
            prop_assert!(frame.rows().eq(shown));
        }
    }
}
