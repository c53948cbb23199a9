//! Things: what stands in the cells.
//!
//! They are sorted by row and column, so that what stands in a stretch of cells is one slice, found by
//! halving: a frame looks at the things in the cells that it shows, and pays for no others. A list for
//! each cell was refused: most cells are empty, and a map has millions.

use super::{Cell, KeyId, SpriteId};

/// Something that stands in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Thing {
    /// What it is.
    pub kind: ThingKind,
    /// Where it stands: in the middle.
    pub cell: Cell,
    /// How it looks.
    pub sprite: SpriteId,
}

/// What a thing is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThingKind {
    /// Who reaches it has finished the level.
    Exit,
    /// Who reaches it takes it, and can open the doors that ask for it.
    Key(KeyId),
    /// To be looked at.
    Ornament,
}

/// All things of a world, by place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Things {
    sorted: Vec<Thing>,
}

impl Things {
    pub(super) fn new(mut things: Vec<Thing>) -> Self {
        things.sort_by_key(place);
        Self { sorted: things }
    }

    pub(super) fn all(&self) -> &[Thing] {
        &self.sorted
    }

    /// Those in `row` between two columns, themselves included.
    pub(super) fn between(&self, row: u32, first: u32, last: u32) -> &[Thing] {
        let start = self.sorted.partition_point(|thing| place(thing) < (row, first));
        let rest = &self.sorted[start..];
        let end = rest.partition_point(|thing| place(thing) <= (row, last));
        &rest[..end]
    }

    pub(super) fn remove(&mut self, is_gone: impl Fn(&Thing) -> bool) {
        self.sorted.retain(|thing| !is_gone(thing));
    }
}

fn place(thing: &Thing) -> (u32, u32) {
    (thing.cell.row, thing.cell.column)
}
