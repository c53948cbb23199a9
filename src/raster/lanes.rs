//! Lanes: columns of pixels side by side that are drawn row by row.

use std::ops::Range;

use super::band::Band;
use super::shaded_texels::{ShadedTexels, TexelAddress};
use crate::color::Rgb;

/// So many columns have what their loop needs in registers.
pub(super) const LANES: usize = 8;

/// A column of pixels that is queued.
#[derive(Clone, Debug)]
pub(super) struct QueuedColumn {
    pub(super) x: u32,
    pub(super) rows: Range<u32>,
    /// The texel of the first of the rows, and how far it is from each row to the next.
    pub(super) address: TexelAddress,
    pub(super) step: u64,
}

impl QueuedColumn {
    /// Draws it in those of its `rows`.
    #[inline]
    pub(super) fn draw(&self, shaded: &ShadedTexels, rows: Range<u32>, band: &mut Band<'_>) {
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

/// Columns side by side, in the rows that all of them have.
#[derive(Clone, Debug)]
pub(super) struct Lanes {
    x: u32,
    pub(super) rows: Range<u32>,
    /// The texel of each of them in the next row to be drawn.
    addresses: [TexelAddress; LANES],
    /// From one row to the next.
    steps: [u64; LANES],
}

impl Lanes {
    /// `None` where they are not side by side, or have no row in common.
    #[inline]
    pub(super) fn new(columns: &[QueuedColumn; LANES]) -> Option<Self> {
        let [QueuedColumn { x, .. }, .., last] = columns;
        let rows = columns.iter().map(|column| column.rows.clone()).reduce(common)?;
        // There are no two at one `x`.
        let are_side_by_side = last.x - x == LANES as u32 - 1;
        (are_side_by_side && !rows.is_empty()).then(|| Self {
            x: *x,
            addresses: columns.each_ref().map(|column| column.address_in(rows.start)),
            steps: columns.each_ref().map(|column| column.step),
            rows,
        })
    }

    /// Draws what of it is in `rows`, which follow those that were drawn before.
    #[inline]
    pub(super) fn draw(&mut self, shaded: &ShadedTexels, rows: Range<u32>, band: &mut Band<'_>) {
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

/// The rows that both have.
fn common(one: Range<u32>, other: Range<u32>) -> Range<u32> {
    let start = one.start.max(other.start);
    start..one.end.min(other.end).max(start)
}
