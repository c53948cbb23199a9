//! The distance field: the number of grid lines that a ray may cross from each cell without a test.
//!
//! For each cell, one byte says whether a ray has to test it. Around the map is a border of such
//! cells, so a ray that leaves the map needs no other check.
//!
//! On mostly empty maps the byte is a distance, in the maximum norm, to the nearest cell that may
//! be solid. A ray leaps that many grid lines. The field is computed once, when a map is read, and
//! only if it pays off: among rooms, a ray reaches a wall before it gains anything. Cells that may
//! become solid count as solid, so a door that opens or closes changes nothing.
//!
//! Fields with distances have a second level, the minimum of each block of 8×8 cells. On a large
//! map, the blocks fit into the cache and the cells do not.
//!
//! The distances are found in two passes over the cells, as in the distance transform of Rosenfeld
//! and Pfaltz ("Sequential Operations in Digital Picture Processing", 1966). Rejected: skipping
//! only empty blocks, and blocks of blocks. A ray would stop at the edge of each block, and one
//! pillar fills all blocks that contain it.

use std::fmt;

/// For each cell and the border, the number of grid lines that a ray in it may cross at once,
/// because no nearer cell is solid or may become so. 0 if the cell itself may be solid.
#[derive(Clone, PartialEq, Eq)]
pub(crate) struct DistanceField {
    /// Row by row from the border row in the north, each from the border cell in the west.
    cells: Vec<CodedDistance>,
    /// The number of cells in a row.
    width: usize,
    /// The minimum of each block of cells; empty if no minimum is above 1.
    blocks: Vec<CodedDistance>,
    /// The number of blocks in a row.
    width_in_blocks: usize,
}

/// The number of cells of a block along each axis.
const BLOCK: usize = 1 << BLOCK_BITS;
const BLOCK_BITS: u32 = 3;

/// A number of lines in a byte: exact up to [`CodedDistance::EXACT`], then rounded down to a multiple of
/// [`CodedDistance::STEP`]. The largest number exceeds the lines of any map.
#[derive(Clone, Copy, PartialEq, Eq)]
struct CodedDistance(u8);

impl CodedDistance {
    const NONE: Self = Self(0);
    const ONE: Self = Self(1);
    const EXACT: u16 = 128;
    const STEP: u16 = 32;
    const MAX: u16 = Self::EXACT + (u8::MAX as u16 - Self::EXACT) * Self::STEP;

    fn new(lines: u16) -> Self {
        let beyond = lines.min(Self::MAX).saturating_sub(Self::EXACT);
        Self((lines.min(Self::EXACT) + beyond / Self::STEP) as u8)
    }

    #[inline]
    fn lines(self) -> u16 {
        let code = u16::from(self.0);
        let beyond = code.saturating_sub(Self::EXACT);
        code + beyond * (Self::STEP - 1)
    }
}

impl DistanceField {
    /// The mean number of lines crossed at once from which distances pay off.
    const WORTHWHILE: f64 = 4.0;

    /// A field of zeros and ones. `rows` have equal lengths, and cells that `may_be_solid` are 0.
    pub(crate) fn new<Row: ExactSizeIterator<Item = bool>>(
        rows: impl ExactSizeIterator<Item = Row>,
    ) -> Self {
        let height = rows.len() + 2;
        let mut width = 2;
        let mut cells = Vec::new();
        for row in rows {
            if cells.is_empty() {
                width += row.len();
                cells.reserve_exact(width * height);
                cells.resize(width, CodedDistance::NONE);
            }
            cells.push(CodedDistance::NONE);
            cells.extend(
                row.map(|may_be| if may_be { CodedDistance::NONE } else { CodedDistance::ONE }),
            );
            cells.push(CodedDistance::NONE);
        }
        cells.resize(width * height, CodedDistance::NONE);
        Self { cells, width, blocks: Vec::new(), width_in_blocks: 0 }
    }

    /// The size in memory, in bytes.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.cells.as_slice()) + size_of_val(self.blocks.as_slice())
    }

    /// The field with distances, if they pay off.
    pub(crate) fn measured_if_worthwhile(self) -> Self {
        let measured = self.measured();
        if measured.is_worthwhile() { measured } else { self }
    }

    /// The field with distances. Two passes suffice, because the nearest solid cell comes either
    /// before the cell in reading order or after it.
    pub(crate) fn measured(&self) -> Self {
        let width = self.width;
        let farthest = |&cell: &CodedDistance| {
            if cell == CodedDistance::NONE { 0 } else { CodedDistance::MAX }
        };
        let mut cells: Vec<u16> = self.cells.iter().map(farthest).collect();
        for end in (2 * width..=cells.len()).step_by(width) {
            let (before, row) = cells[..end].split_at_mut(end - width);
            approach(row, &before[before.len() - width..]);
            spread(row.iter_mut());
        }
        for start in (0..cells.len() - width).step_by(width).rev() {
            let (row, after) = cells[start..].split_at_mut(width);
            approach(row, &after[..width]);
            spread(row.iter_mut().rev());
        }
        let width_in_blocks = width.div_ceil(BLOCK);
        let blocks = cells.chunks(BLOCK * width).flat_map(|rows| {
            let least = |block: usize| {
                let of_row =
                    |row: &[u16]| row.iter().skip(block * BLOCK).take(BLOCK).min().copied();
                rows.chunks_exact(width).filter_map(of_row).min().unwrap_or(0)
            };
            (0..width_in_blocks).map(least).map(CodedDistance::new).collect::<Vec<_>>()
        });
        let blocks = blocks.collect();
        let cells = cells.into_iter().map(CodedDistance::new).collect();
        Self { cells, width, blocks, width_in_blocks }
    }

    /// Returns whether the mean of the distances is large enough for distances to pay off.
    fn is_worthwhile(&self) -> bool {
        let mut counts = [0_u64; u8::MAX as usize + 1];
        for &CodedDistance(code) in &self.cells {
            counts[usize::from(code)] += 1;
        }
        let clear: u64 = counts[1..].iter().sum();
        let lines = (1..=u8::MAX).map(|code| f64::from(CodedDistance(code).lines()));
        let looks: f64 = lines.zip(&counts[1..]).map(|(lines, &count)| count as f64 / lines).sum();
        clear as f64 > Self::WORTHWHILE * looks
    }

    /// The number of lines that a ray can cross at once from the cell at `index`.
    #[inline]
    pub(crate) fn lines_at(&self, index: i64) -> i64 {
        i64::from(self.at(index).lines())
    }

    /// Returns whether the cell at `index` is not solid and cannot become so.
    #[inline]
    pub(crate) fn is_clear(&self, index: i64) -> bool {
        self.at(index) != CodedDistance::NONE
    }

    #[inline]
    fn at(&self, index: i64) -> CodedDistance {
        self.cells.get(index as usize).copied().unwrap_or(CodedDistance::NONE)
    }

    /// A lower bound of the number of lines that a ray can cross at once from the cell at `places`
    /// along two axes. `strides` are the [strides](DistanceField::strides_of_blocks) of blocks
    /// along these axes. 0 if no bound is known.
    #[inline]
    pub(crate) fn lines_of_block(&self, places: [i64; 2], strides: [i64; 2]) -> i64 {
        let [one, other] = places.map(|place| (place + 1) >> BLOCK_BITS);
        let index = one * strides[0] + other * strides[1];
        i64::from(self.blocks.get(index as usize).copied().unwrap_or(CodedDistance::NONE).lines())
    }

    /// The strides of blocks, in the order of [`DistanceField::strides`].
    #[inline]
    pub(crate) fn strides_of_blocks(&self) -> [i64; 2] {
        [1, self.width_in_blocks as i64]
    }

    /// The index of the map's cell in the north-west.
    #[inline]
    pub(crate) fn first(&self) -> i64 {
        self.width as i64 + 1
    }

    /// The differences of the indices of a cell and its neighbours to the east and to the south.
    #[inline]
    pub(crate) fn strides(&self) -> [i64; 2] {
        [1, self.width as i64]
    }

    /// Returns whether the field has distances.
    #[inline]
    pub(crate) fn is_measured(&self) -> bool {
        !self.blocks.is_empty()
    }
}

impl fmt::Debug for DistanceField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DistanceField")
            .field("is_measured", &self.is_measured())
            .finish_non_exhaustive()
    }
}

/// Lowers the distance of each cell in a row, except the first and the last, to one above the least
/// of its neighbours in the row beside.
fn approach(row: &mut [u16], beside: &[u16]) {
    let inner = row.len() - 1;
    for (cell, neighbours) in row[1..inner].iter_mut().zip(beside.windows(3)) {
        let nearest = neighbours[0].min(neighbours[1]).min(neighbours[2]);
        *cell = (*cell).min(nearest + 1);
    }
}

/// Lowers the distance of each cell to at most one more than the distance of the cell before it.
/// The first becomes 0.
fn spread<'row>(cells: impl Iterator<Item = &'row mut u16>) {
    cells.fold(0, |before, cell| {
        *cell = (*cell).min(before + 1);
        *cell
    });
}

#[cfg(test)]
mod tests;
