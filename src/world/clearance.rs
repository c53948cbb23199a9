//! Clearance: how far rays may go from each cell without looking.
//!
//! A byte a cell says whether there is anything to look at, so that a ray looks at little memory, and at
//! nothing else until it comes to something. Around the map is a border of cells that are not clear,
//! and a ray that leaves needs no other test.
//!
//! On an empty map the byte says more: how far the cell is from the nearest that may be solid. A ray
//! that knows it crosses as many lines in one step. That is measured once, when a map is read, and only
//! where it pays: among rooms a ray is at a wall before it has saved anything. What may become solid
//! counts as solid from the start, so a door that opens or closes changes nothing here.
//!
//! A measured map has a byte more for each block of 8 by 8 cells, the least that is said in it. Far
//! from anything solid a ray asks no cell: the blocks of a large map fit a cache that its cells do not.
//!
//! A large map on which little is solid has [shafts](Shafts), too, which tell how far it is clear ahead,
//! and not only around.
//!
//! Only to skip blocks that are empty, and blocks of blocks, was refused: a ray stops at the edge of
//! each block, and a single pillar fills all that hold it.

use std::fmt;

use super::Shafts;

/// For each cell, and those around the map, how many lines of the grid a ray can cross at once that is
/// in it: no cell that is nearer than that is, or may become, solid. 0 where the cell itself may be.
#[derive(Clone, PartialEq, Eq)]
pub(crate) struct Clearance {
    /// Row by row from the one north of the map, each from the cell west of it.
    cells: Vec<Coded>,
    /// How many cells are in a row.
    width: usize,
    /// For each block of cells, the least that any of them says; nothing where that is at most 1.
    ///
    /// Of a large map these are in the cache, and the cells are not.
    blocks: Vec<Coded>,
    /// How many blocks are in a row.
    width_in_blocks: usize,
    /// Of rays that are fastest along rows, and along columns.
    shafts: Option<Box<[Shafts; 2]>>,
}

/// How many cells a block has along each axis.
const BLOCK: usize = 1 << BLOCK_BITS;
const BLOCK_BITS: u32 = 3;

/// A number of lines in a byte: exact as far as [`Coded::EXACT`], then rounded down to a multiple of
/// [`Coded::STEP`], up to more than a map has.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Coded(u8);

impl Coded {
    const NONE: Self = Self(0);
    const ONE: Self = Self(1);
    const EXACT: u16 = 128;
    const STEP: u16 = 32;
    const MOST: u16 = Self::EXACT + (u8::MAX as u16 - Self::EXACT) * Self::STEP;

    fn new(lines: u16) -> Self {
        let beyond = lines.min(Self::MOST).saturating_sub(Self::EXACT);
        Self((lines.min(Self::EXACT) + beyond / Self::STEP) as u8)
    }

    #[inline]
    fn lines(self) -> u16 {
        let code = u16::from(self.0);
        let beyond = code.saturating_sub(Self::EXACT);
        code + beyond * (Self::STEP - 1)
    }
}

impl Clearance {
    /// Where a ray crosses as many lines at a time, in the mean, it is faster for it.
    const WORTHWHILE: f64 = 4.0;

    /// Looks one cell far. `rows` are as long as each other, of cells that `may_be_solid`.
    pub(super) fn new<Row: ExactSizeIterator<Item = bool>>(
        rows: impl ExactSizeIterator<Item = Row>,
    ) -> Self {
        let height = rows.len() + 2;
        let mut width = 2;
        let mut cells = Vec::new();
        for row in rows {
            if cells.is_empty() {
                width += row.len();
                cells.reserve_exact(width * height);
                cells.resize(width, Coded::NONE);
            }
            cells.push(Coded::NONE);
            cells.extend(row.map(|may_be| if may_be { Coded::NONE } else { Coded::ONE }));
            cells.push(Coded::NONE);
        }
        cells.resize(width * height, Coded::NONE);
        Self { cells, width, blocks: Vec::new(), width_in_blocks: 0, shafts: None }
    }

    /// How many bytes it takes in memory.
    pub(super) fn bytes(&self) -> usize {
        let of_shafts = self.shafts().into_iter().flatten().map(Shafts::bytes).sum::<usize>();
        size_of_val(self.cells.as_slice()) + size_of_val(self.blocks.as_slice()) + of_shafts
    }

    /// The same, which looks as far as there is anything to see, if rays gain by it.
    pub(super) fn measured_if_worthwhile(self) -> Self {
        let measured = self.measured();
        if !measured.is_worthwhile() {
            self
        } else if measured.are_shafts_worthwhile() {
            measured.with_shafts()
        } else {
            measured
        }
    }

    /// The cell that is nearest to one comes before it in the order of reading, or after it.
    pub(super) fn measured(&self) -> Self {
        let width = self.width;
        let farthest = |&cell: &Coded| if cell == Coded::NONE { 0 } else { Coded::MOST };
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
            (0..width_in_blocks).map(least).map(Coded::new).collect::<Vec<_>>()
        });
        let blocks = blocks.collect();
        let cells = cells.into_iter().map(Coded::new).collect();
        Self { cells, width, blocks, width_in_blocks, shafts: None }
    }

    /// The same, with shafts.
    pub(super) fn with_shafts(self) -> Self {
        let [columns, rows] = self.size();
        let along_rows = Shafts::new([columns, rows], self.solid());
        let swapped = self.solid().map(|[column, row]| [row, column]);
        let along_columns = Shafts::new([rows, columns], swapped);
        Self { shafts: Some(Box::new([along_rows, along_columns])), ..self }
    }

    fn are_shafts_worthwhile(&self) -> bool {
        let solid = self.cells.iter().filter(|&&cell| cell == Coded::NONE).count();
        Shafts::are_worthwhile(self.size(), solid as i64)
    }

    /// The map's columns and rows.
    fn size(&self) -> [i64; 2] {
        [self.width as i64 - 2, (self.cells.len() / self.width) as i64 - 2]
    }

    /// The column and row of each cell that is or may be solid, with those around the map.
    fn solid(&self) -> impl Iterator<Item = [i64; 2]> {
        let rows = self.cells.chunks_exact(self.width).zip(-1..);
        rows.flat_map(|(cells, row)| {
            let solid = cells.iter().zip(-1..).filter(|&(&cell, _)| cell == Coded::NONE);
            solid.map(move |(_, column)| [column, row])
        })
    }

    /// Whether a ray crosses more than a few lines at a time, in the mean of all cells that it may be
    /// in.
    fn is_worthwhile(&self) -> bool {
        let mut counts = [0_u64; u8::MAX as usize + 1];
        for &Coded(code) in &self.cells {
            counts[usize::from(code)] += 1;
        }
        let clear: u64 = counts[1..].iter().sum();
        let lines = (1..=u8::MAX).map(|code| f64::from(Coded(code).lines()));
        let looks: f64 = lines.zip(&counts[1..]).map(|(lines, &count)| count as f64 / lines).sum();
        clear as f64 > Self::WORTHWHILE * looks
    }

    /// How many lines can be crossed at once from the cell at `index`.
    #[inline]
    pub(crate) fn lines_at(&self, index: i64) -> i64 {
        i64::from(self.at(index).lines())
    }

    /// Whether the cell at `index` is not solid, and will never be.
    #[inline]
    pub(crate) fn is_clear(&self, index: i64) -> bool {
        self.at(index) != Coded::NONE
    }

    #[inline]
    fn at(&self, index: i64) -> Coded {
        self.cells.get(index as usize).copied().unwrap_or(Coded::NONE)
    }

    /// At least how many lines can be crossed at once from the cell at those `places` along two axes, of
    /// which `strides` are the [strides](Clearance::strides_of_blocks). 0 means that it is not known.
    #[inline]
    pub(crate) fn lines_of_block(&self, places: [i64; 2], strides: [i64; 2]) -> i64 {
        let [one, other] = places.map(|place| (place + 1) >> BLOCK_BITS);
        let index = one * strides[0] + other * strides[1];
        i64::from(self.blocks.get(index as usize).copied().unwrap_or(Coded::NONE).lines())
    }

    /// As [`Clearance::strides`], of blocks.
    #[inline]
    pub(crate) fn strides_of_blocks(&self) -> [i64; 2] {
        [1, self.width_in_blocks as i64]
    }

    /// The index of the cell in the map's north-west.
    #[inline]
    pub(crate) fn first(&self) -> i64 {
        self.width as i64 + 1
    }

    /// From a cell's index to that of the one to the east, and to that of the one to the south.
    #[inline]
    pub(crate) fn strides(&self) -> [i64; 2] {
        [1, self.width as i64]
    }

    /// Whether it is told how far a ray can go, and not only whether.
    #[inline]
    pub(crate) fn is_measured(&self) -> bool {
        !self.blocks.is_empty()
    }

    /// The shafts of rays that are fastest along rows, and of those along columns, if any.
    #[inline]
    pub(crate) fn shafts(&self) -> Option<&[Shafts; 2]> {
        self.shafts.as_deref()
    }
}

impl fmt::Debug for Clearance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Clearance")
            .field("is_measured", &self.is_measured())
            .finish_non_exhaustive()
    }
}

/// Brings each cell of a row, but the first and the last, as near as its neighbours in the row beside.
fn approach(row: &mut [u16], beside: &[u16]) {
    let inner = row.len() - 1;
    for (cell, neighbours) in row[1..inner].iter_mut().zip(beside.windows(3)) {
        let nearest = neighbours[0].min(neighbours[1]).min(neighbours[2]);
        *cell = (*cell).min(nearest + 1);
    }
}

/// Brings each cell as near as the one before it, the first of which is not clear.
fn spread<'row>(cells: impl Iterator<Item = &'row mut u16>) {
    cells.fold(0, |before, cell| {
        *cell = (*cell).min(before + 1);
        *cell
    });
}

#[cfg(test)]
mod tests;
