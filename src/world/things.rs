//! Things: what stands in the cells.
//!
//! Things are sorted by row and column, so that the things in a range of cells are one slice. The
//! start of each row is known; within it the slice is found by binary search. A frame looks at the
//! things in the cells that it shows, and others cost nothing. A list for each cell was refused:
//! most cells are empty, and a map has millions.

use super::{Cell, KeyId, SpriteId, World};

/// Something that stands in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Thing {
    /// The kind of thing.
    pub kind: ThingKind,
    /// The cell in whose middle it stands.
    pub cell: Cell,
    /// Its sprite.
    pub sprite: SpriteId,
}

/// A kind of thing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThingKind {
    /// Reaching it finishes the level.
    Exit,
    /// Reaching it takes it; it opens the doors that need it.
    Key(KeyId),
    /// Decoration.
    Ornament,
}

impl World {
    /// The things, row by row from the north, and within a row from the west.
    pub fn things(&self) -> &[Thing] {
        self.things.all()
    }

    /// The things in `cell`.
    pub fn things_in(&self, cell: Cell) -> &[Thing] {
        self.things.between(cell.row, cell.column, cell.column)
    }

    /// The things in `row` between two columns, both included.
    pub(crate) fn things_between(&self, row: u32, first: u32, last: u32) -> &[Thing] {
        self.things.between(row, first, last)
    }

    /// Removes the things in `cell` for which `is_taken` is true.
    pub(crate) fn take_things(&mut self, cell: Cell, is_taken: impl Fn(ThingKind) -> bool) {
        self.things.remove(|thing| thing.cell == cell && is_taken(thing.kind));
    }
}

/// All things of a world, by place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Things {
    sorted: Vec<Thing>,
    /// The number of things before each row, up to the last row with any.
    before_row: Vec<usize>,
}

impl Things {
    pub(super) fn new(mut things: Vec<Thing>) -> Self {
        things.sort_by_key(place);
        let mut new = Self { sorted: things, before_row: Vec::new() };
        new.find_rows();
        new
    }

    fn all(&self) -> &[Thing] {
        &self.sorted
    }

    /// The things in `row` between two columns, both included.
    fn between(&self, row: u32, first: u32, last: u32) -> &[Thing] {
        let in_row = &self.sorted[self.before_row(row)..self.before_row(row.saturating_add(1))];
        let start = in_row.partition_point(|thing| thing.cell.column < first);
        let rest = &in_row[start..];
        let end = rest.partition_point(|thing| thing.cell.column <= last);
        &rest[..end]
    }

    fn before_row(&self, row: u32) -> usize {
        self.before_row.get(row as usize).copied().unwrap_or(self.sorted.len())
    }

    fn remove(&mut self, is_gone: impl Fn(&Thing) -> bool) {
        self.sorted.retain(|thing| !is_gone(thing));
        self.find_rows();
    }

    fn find_rows(&mut self) {
        let Self { sorted, before_row } = self;
        before_row.clear();
        for (index, thing) in sorted.iter().enumerate() {
            before_row.resize(before_row.len().max(thing.cell.row as usize + 1), index);
        }
    }
}

fn place(thing: &Thing) -> (u32, u32) {
    (thing.cell.row, thing.cell.column)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const SIDE: u32 = 8;

    fn thing((row, column): (u32, u32)) -> Thing {
        Thing { kind: ThingKind::Ornament, cell: Cell { column, row }, sprite: SpriteId(0) }
    }

    proptest! {
        #[test]
        fn a_stretch_of_a_row_holds_what_stands_there(
            places in prop::collection::vec((0..SIDE, 0..SIDE), 0..20),
            gone_row in 0..SIDE,
            row in prop_oneof![0..SIDE + 2, Just(u32::MAX)],
            first in 0..SIDE,
            length in 0..SIDE,
        ) {
            let last = first + length;
            let mut things = Things::new(places.iter().copied().map(thing).collect());
            things.remove(|thing| thing.cell.row == gone_row);
            let mut expected: Vec<(u32, u32)> = places
                .into_iter()
                .filter(|&place| place.0 == row && row != gone_row)
                .filter(|place| (first..=last).contains(&place.1))
                .collect();
            expected.sort_unstable();
            let found: Vec<_> = things.between(row, first, last).iter().map(place).collect();
            prop_assert_eq!(found, expected);
        }
    }
}
