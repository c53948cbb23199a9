//! Chains: the items of each column of pixels, added to the columns in any order.
//!
//! All items are in one vector, and each knows the one added before it to the same column. A vector for
//! each column was refused: each would allocate memory of its own.

use std::{iter, mem};

/// The items of each column, in memory that is reused from frame to frame.
#[derive(Clone, Debug)]
pub(crate) struct Chains<T> {
    /// Each item, with the index of the one before it in its column.
    links: Vec<(T, u32)>,
    /// The index of the latest item of each column.
    latest: Vec<u32>,
}

/// The index of an item in a column that has none.
const NONE: u32 = u32::MAX;

impl<T> Default for Chains<T> {
    fn default() -> Self {
        Self { links: Vec::new(), latest: Vec::new() }
    }
}

impl<T> Chains<T> {
    /// Removes all items, and begins with `width` columns.
    pub(crate) fn begin(&mut self, width: usize) {
        self.links.clear();
        self.latest.clear();
        self.latest.resize(width, NONE);
    }

    /// Reserves memory for `width` columns with this number of items each.
    pub(crate) fn reserve(&mut self, width: usize, of_a_column: usize) {
        self.begin(0);
        self.links.reserve(width * of_a_column);
        self.latest.reserve(width);
    }

    /// Adds `item` to `column`.
    #[inline]
    pub(crate) fn push(&mut self, column: u32, item: T) {
        let latest = &mut self.latest[column as usize];
        let before = mem::replace(latest, self.links.len() as u32);
        self.links.push((item, before));
    }

    /// The items of `column`, from the last added to the first.
    #[inline]
    pub(crate) fn latest_first(&self, column: usize) -> impl Iterator<Item = &T> {
        let mut index = self.latest[column];
        iter::from_fn(move || {
            let (item, before) = self.links.get(index as usize)?;
            index = *before;
            Some(item)
        })
    }

    /// The number of columns.
    pub(crate) fn width(&self) -> usize {
        self.latest.len()
    }

    /// All items, in the order in which they were added.
    #[cfg(test)]
    pub(crate) fn items(&self) -> impl Iterator<Item = &T> {
        self.links.iter().map(|(item, _)| item)
    }
}
