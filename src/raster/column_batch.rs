//! Column batches: neighbouring wall columns that are drawn together, row by row.
//!
//! The pixels of such a row are contiguous, so the processor predicts the accesses and prefetches
//! the memory. Rejected: drawing one column after the other. Each pixel is then far in memory from
//! the one above it, which took most of the time of a frame in large pictures.

use std::ops::Range;
use std::{iter, ptr};

use super::band::Band;
use super::direct_columns;
use super::direct_columns::DirectColumns;
use super::shaded_texels::{ShadedRange, ShadedTexels, TexelAddress};
use super::target::Target;
use crate::color::Rgb;
use crate::visibility::{Lighting, TextureStepper};

/// The most columns that are drawn together.
const MAX_COLUMNS: usize = 15 * LANES;
/// The number of rows that are drawn in one group of columns before the next group.
const ROWS_AT_ONCE: u32 = 8;

/// Memory for columns that are drawn together, reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct BatchMemory {
    shaded: ShadedTexels,
    columns: Vec<QueuedColumn>,
    lanes: Vec<ColumnLanes>,
}

/// Queued columns with a lighting `L`.
pub(crate) struct ColumnBatch<'m, 't, 'a, L> {
    memory: &'m mut BatchMemory,
    target: &'m mut Target<'t>,
    /// The texels and the lighting of the latest shaded range.
    latest: Option<(&'a [Rgb], L, ShadedRange)>,
    /// The first column that can still be queued, because the columns of a batch do not overlap.
    next: u32,
    /// Whether columns are drawn without a batch if there is a loop for them.
    are_direct: bool,
}

impl<'m, 't, 'a, L: Lighting> ColumnBatch<'m, 't, 'a, L> {
    pub(crate) fn new(
        memory: &'m mut BatchMemory,
        target: &'m mut Target<'t>,
        are_direct: bool,
    ) -> Self {
        let mut batch = Self { memory, target, latest: None, next: 0, are_direct };
        batch.clear();
        // This is enough for any batch, so later frames do not allocate.
        batch.memory.columns.reserve(MAX_COLUMNS);
        batch.memory.lanes.reserve(MAX_COLUMNS / LANES);
        batch
    }

    /// The target, for pixels that are in no queued column.
    pub(crate) fn target_mut(&mut self) -> &mut Target<'t> {
        self.target
    }

    /// Queues `rows` of column `x` for a fill with one colour.
    pub(crate) fn queue_color(&mut self, x: u32, rows: Range<u32>, color: Rgb, lighting: L) {
        self.make_room_for(x, 1);
        let shaded = &mut self.memory.shaded;
        let address = shaded.make(&[color], lighting).start();
        self.memory.columns.push(QueuedColumn { x, rows, address, step: 0 });
    }

    /// Draws or queues columns of a face that show one level in one lighting.
    #[inline]
    pub(crate) fn draw_columns(&mut self, shown: &DirectColumns<'a, L>) {
        let height = shown.level.height() as usize;
        let band = self.target.band_mut();
        if self.are_direct && direct_columns::have(height) {
            shown.draw(band);
            return;
        }
        let rows = band.rows();
        for (x, column) in (shown.x..).zip(shown.columns) {
            let rows = column.rows.within(&rows);
            if rows.is_empty() {
                continue;
            }
            let (stepper, texels) = (shown.texels.at(column.t), shown.level.column(column.u));
            if stepper.is_one_texture() {
                self.queue_texels(x, rows, texels, stepper, shown.lighting);
            } else {
                self.queue_repeating(x, rows, texels, stepper, shown.lighting);
            }
        }
    }

    /// Queues `rows` of column `x` for drawing with `texels`.
    #[expect(clippy::inline_always, reason = "a call would cost a fifth of it")]
    #[inline(always)]
    pub(crate) fn queue_texels(
        &mut self,
        x: u32,
        rows: Range<u32>,
        texels: &'a [Rgb],
        stepper: TextureStepper,
        lighting: L,
    ) {
        if texels.len() > 2 * rows.len() || texels.len() > ShadedTexels::MAX {
            self.draw_at_once(x, rows, texels, stepper, lighting);
            return;
        }
        self.make_room_for(x, texels.len());
        let range = match self.latest {
            Some((latest, of_lighting, range))
                if ptr::eq(latest, texels) && of_lighting == lighting =>
            {
                range
            }
            _ => self.memory.shaded.make(texels, lighting),
        };
        self.latest = Some((texels, lighting, range));
        self.push(x, rows, range, stepper);
    }

    /// Queues `rows` of column `x` for drawing with `texels`, which a face may repeat or show in
    /// part.
    fn queue_repeating(
        &mut self,
        x: u32,
        rows: Range<u32>,
        texels: &'a [Rgb],
        stepper: TextureStepper,
        lighting: L,
    ) {
        let most = ShadedTexels::MAX.min(2 * rows.len()) as i64;
        let places = stepper.places(&rows).filter(|places| places.end - places.start <= most);
        let Some(places) = places else {
            self.draw_at_once(x, rows, texels, stepper, lighting);
            return;
        };
        self.make_room_for(x, (places.end - places.start) as usize);
        let first = places.start;
        let shaded = &mut self.memory.shaded;
        let range = match stepper.slice(texels, &places) {
            Some(piece) => shaded.make_of_pieces(first, iter::once(piece), lighting),
            None => shaded.make_of_pieces(first, stepper.pieces(texels, places), lighting),
        };
        self.push(x, rows, range, stepper);
    }

    #[inline]
    fn push(&mut self, x: u32, rows: Range<u32>, range: ShadedRange, stepper: TextureStepper) {
        let (address, step) = range.address_and_step(stepper, rows.start);
        self.memory.columns.push(QueuedColumn { x, rows, address, step });
    }

    /// Draws `rows` of column `x` immediately, because there are too few pixels to shade all texels
    /// first, or too many texels.
    fn draw_at_once(
        &mut self,
        x: u32,
        rows: Range<u32>,
        texels: &[Rgb],
        stepper: TextureStepper,
        lighting: L,
    ) {
        let first = rows.start;
        for (pixel, row) in self.target.column_mut(x, rows).zip(first..) {
            *pixel = lighting.apply(texels[stepper.at(row)]);
        }
    }

    /// Makes room for column `x` with this number of shaded texels. Draws the queued columns if
    /// there is no room, or if `x` may be one of them.
    #[inline]
    fn make_room_for(&mut self, x: u32, texels: usize) {
        let BatchMemory { shaded, columns, .. } = &self.memory;
        let is_full = columns.len() == MAX_COLUMNS || !shaded.have_room_for(texels);
        if is_full || x < self.next {
            self.draw();
        }
        self.next = x + 1;
    }

    /// Draws the queued columns.
    pub(crate) fn draw(&mut self) {
        if self.memory.columns.is_empty() {
            return;
        }
        self.memory.draw(self.target.band_mut());
        self.clear();
    }

    fn clear(&mut self) {
        self.memory.clear();
        self.latest = None;
        self.next = 0;
    }
}

impl BatchMemory {
    /// Draws the queued columns on `band`. The code does not depend on the lighting, so it is
    /// compiled once.
    #[inline(never)]
    fn draw(&mut self, band: &mut Band<'_>) {
        let Self { shaded, columns, lanes } = self;
        let mut rest = columns.as_slice();
        while let [column, more @ ..] = rest {
            let Some(together) = rest.first_chunk().and_then(ColumnLanes::new) else {
                column.draw(shaded, column.rows.clone(), band);
                rest = more;
                continue;
            };
            let (columns, more) = rest.split_at(LANES);
            for column in columns {
                column.draw(shaded, column.rows.start..together.rows.start, band);
                column.draw(shaded, together.rows.end..column.rows.end, band);
            }
            lanes.push(together);
            rest = more;
        }
        let start = lanes.iter().map(|lanes| lanes.rows.start).min().unwrap_or_default();
        let end = lanes.iter().map(|lanes| lanes.rows.end).max().unwrap_or_default();
        for first in (start..end).step_by(ROWS_AT_ONCE as usize) {
            for lanes in &mut *lanes {
                lanes.draw(shaded, first..end.min(first + ROWS_AT_ONCE), band);
            }
        }
    }

    fn clear(&mut self) {
        let Self { shaded, columns, lanes } = self;
        shaded.clear();
        columns.clear();
        lanes.clear();
    }
}

/// The number of columns whose loop variables fit in registers.
const LANES: usize = 8;

/// A queued column of pixels.
#[derive(Clone, Debug)]
struct QueuedColumn {
    x: u32,
    rows: Range<u32>,
    /// The address of the texel of the first row, and the step from each row to the next.
    address: TexelAddress,
    step: u64,
}

impl QueuedColumn {
    /// Draws the part of the column in `rows`.
    #[inline]
    fn draw(&self, shaded: &ShadedTexels, rows: Range<u32>, band: &mut Band<'_>) {
        let mut address = self.address_in(rows.start);
        for pixel in band.column_mut(self.x, rows) {
            *pixel = shaded.at(address);
            address = address.further(self.step);
        }
    }

    #[inline]
    fn address_in(&self, row: u32) -> TexelAddress {
        self.address.further(self.step.wrapping_mul(u64::from(row - self.rows.start)))
    }
}

/// Neighbouring columns, in the rows that all of them share.
#[derive(Clone, Debug)]
struct ColumnLanes {
    x: u32,
    rows: Range<u32>,
    /// The address of each column's texel in the next row to be drawn.
    addresses: [TexelAddress; LANES],
    /// The step of each column from one row to the next.
    steps: [u64; LANES],
}

impl ColumnLanes {
    /// The lanes of `columns`; `None` if they are not neighbours or have no common row.
    #[inline]
    fn new(columns: &[QueuedColumn; LANES]) -> Option<Self> {
        let [QueuedColumn { x, .. }, .., last] = columns;
        let rows = columns.iter().map(|column| column.rows.clone()).reduce(common)?;
        // No two columns have the same `x`.
        let are_side_by_side = last.x - x == LANES as u32 - 1;
        (are_side_by_side && !rows.is_empty()).then(|| Self {
            x: *x,
            addresses: columns.each_ref().map(|column| column.address_in(rows.start)),
            steps: columns.each_ref().map(|column| column.step),
            rows,
        })
    }

    /// Draws the part of the lanes in `rows`, which follow the rows that were drawn last.
    #[inline]
    fn draw(&mut self, shaded: &ShadedTexels, rows: Range<u32>, band: &mut Band<'_>) {
        let Self { x, mut addresses, steps, .. } = *self;
        band.for_each_in_block(x, common(rows, self.rows.clone()), |pixels: &mut [Rgb; LANES]| {
            for lane in 0..LANES {
                pixels[lane] = shaded.at(addresses[lane]);
                addresses[lane] = addresses[lane].further(steps[lane]);
            }
        });
        self.addresses = addresses;
    }
}

/// The rows that are in both ranges.
fn common(one: Range<u32>, other: Range<u32>) -> Range<u32> {
    let start = one.start.max(other.start);
    start..one.end.min(other.end).max(start)
}

#[cfg(test)]
mod tests;
