//! Direct columns: the wall columns of small pictures, drawn without a batch.
//!
//! A small picture is in the cache as a whole, so that pixels far apart cost no more than neighbours,
//! and a batch would take longer to prepare than to draw. Four neighbouring columns at a time are drawn
//! straight from their texture, which has its columns lit as well. One column at a time was refused:
//! at 320×200 pixels its loop takes 9.6 instructions a pixel, and that of four columns 7.

use std::ops::Range;

use super::band::Band;
use crate::color::Rgb;
use crate::visibility::{Scene, TextureStepper};

/// The most rows of a band, and the most pixels, for which direct columns take less time.
const MOST_ROWS: usize = 256;
const MOST_PIXELS: usize = 1 << 17;

/// The number of columns that are drawn together.
const LANES: usize = 4;

/// Whether the columns of `band` are better drawn directly.
pub(super) fn are_for(scene: Scene<'_>, band: &Band<'_>) -> bool {
    let rows = band.rows().len();
    let is_small = rows <= MOST_ROWS && rows * band.width() <= MOST_PIXELS;
    is_small && scene.projection.is_horizon_near()
}

/// Columns that wait for their neighbours: fewer than [`LANES`].
#[derive(Clone, Debug, Default)]
pub(super) struct DirectColumns<'a> {
    waiting: [DirectColumn<'a>; LANES],
    count: usize,
}

/// A column of pixels, which is not empty, and the lit texels of its wall from top to bottom.
#[derive(Clone, Debug, Default)]
pub(super) struct DirectColumn<'a> {
    pub(super) x: u32,
    pub(super) rows: Range<u32>,
    pub(super) texels: &'a [Rgb],
    pub(super) stepper: TextureStepper,
}

impl<'a> DirectColumns<'a> {
    /// Whether there is a loop for columns of as many texels: a power of two, up to 256. Others are drawn
    /// faster in a batch.
    #[inline]
    pub(super) fn are_for(texels: &[Rgb]) -> bool {
        texels.len().is_power_of_two() && texels.len() <= 256
    }

    /// Draws `column`, now or with its neighbours.
    #[inline]
    pub(super) fn push(&mut self, column: DirectColumn<'a>, band: &mut Band<'_>) {
        let Self { waiting, count } = self;
        if let Some(before) = count.checked_sub(1).and_then(|last| waiting.get(last)) {
            let is_alike = before.texels.len() == column.texels.len() && before.x + 1 == column.x;
            if !is_alike {
                self.draw(band);
            }
        }
        self.waiting[self.count % LANES] = column;
        self.count += 1;
        if self.count == LANES {
            self.count = 0;
            draw_together(&self.waiting, band);
        }
    }

    /// Draws the columns that wait.
    pub(super) fn draw(&mut self, band: &mut Band<'_>) {
        for column in &self.waiting[..self.count] {
            column.draw(column.rows.clone(), band);
        }
        self.count = 0;
    }
}

/// Draws neighbouring columns with equal numbers of texels.
fn draw_together(columns: &[DirectColumn<'_>; LANES], band: &mut Band<'_>) {
    match columns[0].texels.len() {
        256 => draw_lanes::<256, 8>(columns, band),
        128 => draw_lanes::<128, 7>(columns, band),
        64 => draw_lanes::<64, 6>(columns, band),
        32 => draw_lanes::<32, 5>(columns, band),
        16 => draw_lanes::<16, 4>(columns, band),
        8 => draw_lanes::<8, 3>(columns, band),
        _ => columns.iter().for_each(|column| column.draw(column.rows.clone(), band)),
    }
}

/// Draws neighbouring columns with `N` texels each, two to the power of `BITS`.
///
/// The uppermost bits of a position are the index of its texel, so that a lookup needs no bounds check.
fn draw_lanes<const N: usize, const BITS: u32>(
    columns: &[DirectColumn<'_>; LANES],
    band: &mut Band<'_>,
) {
    let start = columns.iter().map(|column| column.rows.start).max().unwrap_or_default();
    let end = columns.iter().map(|column| column.rows.end).min().unwrap_or_default();
    let [Some(a), Some(b), Some(c), Some(d)] =
        columns.each_ref().map(|column| column.texels.first_chunk::<N>())
    else {
        return;
    };
    if start >= end {
        for column in columns {
            column.draw(column.rows.clone(), band);
        }
        return;
    }
    for column in columns {
        if column.rows.start < start {
            column.draw(column.rows.start..start, band);
        }
        if column.rows.end > end {
            column.draw(end..column.rows.end, band);
        }
    }
    let steppers = columns.each_ref().map(|column| column.stepper.in_uppermost::<BITS>(start));
    let (mut addresses, steps) = (steppers.map(|it| it.0), steppers.map(|it| it.1));
    let (x, width) = (columns[0].x as usize, band.width());
    let mut rest = band.rows_mut(start..end);
    while let Some((row, below)) = rest.split_at_mut_checked(width.max(LANES)) {
        let Some(pixels) = row.get_mut(x..).and_then(|row| row.first_chunk_mut::<LANES>()) else {
            return;
        };
        for (lane, texels) in [a, b, c, d].into_iter().enumerate() {
            pixels[lane] = texels[(addresses[lane] >> (u64::BITS - BITS)) as usize % N];
            addresses[lane] = addresses[lane].wrapping_add(steps[lane]);
        }
        rest = below;
    }
    for column in columns {
        column.correct(start, end, band);
    }
}

impl DirectColumn<'_> {
    /// Draws the part of the column in `rows`.
    fn draw(&self, rows: Range<u32>, band: &mut Band<'_>) {
        let first = rows.start;
        for (pixel, row) in band.column_mut(self.x, rows).zip(first..) {
            *pixel = self.texels[self.stepper.at(row)];
        }
    }

    /// Corrects the first row and the last one of `start..end`, which rounding may put one texel too
    /// far.
    #[inline]
    fn correct(&self, start: u32, end: u32, band: &mut Band<'_>) {
        for row in [start, end - 1] {
            if !self.stepper.is_on_wall(row) {
                self.draw(row..row + 1, band);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::render::Frame;
    use crate::visibility::{FrameSize, PixelAspect, Projection};
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
            repeats in 1_usize..20,
            degrees in -30.0..30.0,
        ) {
            let texels: Vec<_> = (0..256).map(|texel| Rgb::new(1, 2, texel as u8)).collect();
            let columns: Vec<_> =
                columns.iter().flat_map(|column| vec![column; repeats]).take(200).collect();
            let size = FrameSize::new(columns.len() as u32, HEIGHT).unwrap();
            let east = Heading::from_degrees(0.0).unwrap();
            let camera = Camera::new((0.0, 0.0).into(), east, FieldOfView::default()).unwrap();
            let camera = camera.with_pitch(Pitch::from_degrees(degrees).unwrap());
            let projection = Projection::new(&camera, size, PixelAspect::SQUARE);
            let mut frame = Frame::new(size, PixelAspect::SQUARE);
            let mut shown = vec![vec![Rgb::BLACK; columns.len()]; HEIGHT as usize];
            let mut band = frame.whole();
            let mut direct = DirectColumns::default();
            for (x, column) in columns.iter().enumerate() {
                let Some((t, bits)) = column else { continue };
                let (rows, texels) = (projection.wall_rows(*t), &texels[..1 << bits]);
                let stepper = projection.texels_down_the_wall(*t, texels.len());
                for row in rows.clone() {
                    shown[row as usize][x] = texels[stepper.at(row)];
                }
                if !rows.is_empty() {
                    direct.push(DirectColumn { x: x as u32, rows, texels, stepper }, &mut band);
                }
            }
            direct.draw(&mut band);
            prop_assert!(frame.rows().eq(shown));
        }
    }
}
