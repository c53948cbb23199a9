//! Lanes: neighbouring columns of pixels that are drawn row by row.

use std::ops::Range;

use super::band::Band;
use super::shaded_texels::{ShadedTexels, TexelAddress};
use crate::color::Rgb;

/// The number of columns whose loop variables fit in registers.
pub(crate) const LANES: usize = 8;

/// A queued column of pixels.
#[derive(Clone, Debug)]
pub(crate) struct QueuedColumn {
    pub(crate) x: u32,
    pub(crate) rows: Range<u32>,
    /// The address of the texel of the first row, and the step from each row to the next.
    pub(crate) address: TexelAddress,
    pub(crate) step: u64,
}

impl QueuedColumn {
    /// Draws the part of the column in `rows`.
    #[inline]
    pub(crate) fn draw(&self, shaded: &ShadedTexels, rows: Range<u32>, band: &mut Band<'_>) {
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

/// Neighbouring columns, in the rows that all of them have.
#[derive(Clone, Debug)]
pub(crate) struct Lanes {
    x: u32,
    pub(crate) rows: Range<u32>,
    /// The address of each column's texel in the next row to be drawn.
    addresses: [TexelAddress; LANES],
    /// The step of each column from one row to the next.
    steps: [u64; LANES],
}

impl Lanes {
    /// The lanes of `columns`; `None` if they are not neighbours or have no common row.
    #[inline]
    pub(crate) fn new(columns: &[QueuedColumn; LANES]) -> Option<Self> {
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

    /// Draws the part of the lanes in `rows`, which follow the rows drawn before.
    #[inline]
    pub(crate) fn draw(&mut self, shaded: &ShadedTexels, rows: Range<u32>, band: &mut Band<'_>) {
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

/// The rows common to both.
fn common(one: Range<u32>, other: Range<u32>) -> Range<u32> {
    let start = one.start.max(other.start);
    start..one.end.min(other.end).max(start)
}
