//! Buckets of cells: in each, the last cell that was put in is the first to be taken out.
//!
//! All buckets are linked lists in one vector, which grows to the most cells that ever waited at
//! once. A vector for each bucket was refused: every one of them grows for itself, so that guards
//! who had walked for a minute still allocated memory.

use std::iter::successors;

use crate::world::Cell;

/// The cells for which a search reserves memory when it first begins.
const RESERVED: usize = 512;
/// The end of a list.
const NONE: u32 = u32::MAX;

/// That many buckets. Those with the same cells in the same order are equal.
#[derive(Clone, Debug)]
pub(crate) struct Buckets<const COUNT: usize> {
    entries: Vec<Entry>,
    /// The last entry of each bucket.
    tops: [u32; COUNT],
    /// The first of the entries that are in no bucket.
    free: u32,
    /// The number of cells in all buckets.
    count: usize,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    cell: Cell,
    /// The entry below it in its bucket.
    below: u32,
}

impl<const COUNT: usize> Buckets<COUNT> {
    /// Takes all cells out.
    pub(crate) fn clear(&mut self) {
        self.entries.clear();
        self.entries.reserve(RESERVED);
        (self.tops, self.free, self.count) = ([NONE; COUNT], NONE, 0);
    }

    /// Whether all buckets are empty.
    pub(crate) fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The cells in a bucket, from the one that is taken out first.
    pub(crate) fn cells(&self, bucket: usize) -> impl Iterator<Item = Cell> + Clone {
        let entry = |place: u32| self.entries.get(place as usize);
        let entries = successors(entry(self.tops[bucket]), move |above| entry(above.below));
        entries.map(|entry| entry.cell)
    }

    /// Puts a cell into a bucket.
    pub(crate) fn push(&mut self, bucket: usize, cell: Cell) {
        let entry = Entry { cell, below: self.tops[bucket] };
        let place = if let Some(free) = self.entries.get_mut(self.free as usize) {
            let place = self.free;
            self.free = free.below;
            *free = entry;
            place
        } else {
            self.entries.push(entry);
            self.entries.len() as u32 - 1
        };
        self.tops[bucket] = place;
        self.count += 1;
    }

    /// Takes a cell out of a bucket.
    pub(crate) fn pop(&mut self, bucket: usize) -> Option<Cell> {
        let top = self.tops[bucket];
        let entry = self.entries.get_mut(top as usize)?;
        self.tops[bucket] = entry.below;
        (entry.below, self.free) = (self.free, top);
        self.count -= 1;
        Some(entry.cell)
    }
}

impl<const COUNT: usize> PartialEq for Buckets<COUNT> {
    fn eq(&self, other: &Self) -> bool {
        self.count == other.count
            && (0..COUNT).all(|bucket| self.cells(bucket).eq(other.cells(bucket)))
    }
}

impl<const COUNT: usize> Default for Buckets<COUNT> {
    fn default() -> Self {
        Self { entries: Vec::new(), tops: [NONE; COUNT], free: NONE, count: 0 }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn each_bucket_is_a_stack(changes: Vec<(bool, bool, u32)>) {
            let mut buckets = Buckets::<2>::default();
            let mut stacks = [Vec::new(), Vec::new()];
            for (puts, second, column) in changes {
                let (bucket, cell) = (usize::from(second), Cell { column, row: 0 });
                if puts {
                    buckets.push(bucket, cell);
                    stacks[bucket].push(cell);
                } else {
                    prop_assert_eq!(buckets.pop(bucket), stacks[bucket].pop());
                }
                prop_assert_eq!(buckets.is_empty(), stacks.iter().all(Vec::is_empty));
            }
        }
    }
}
