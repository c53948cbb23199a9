//! Doors: their surfaces, their keys, and how far each door is open.
//!
//! A door stands in the middle of its cell and slides aside into a jamb. It has two kinds of tile.
//! While any part of it is in the way, it is a [`Door`](super::TileKind::Door), which is solid.
//! When it is fully open, it is a [`Doorway`](super::TileKind::Doorway), which is open floor
//! between two jambs. So an open door costs no more than floor, a closed one no more than a wall,
//! and collision need not know about doors. Rejected: a door that is solid only at its leaf. A
//! player beside the leaf would be inside it when it closes.

use serde::{Deserialize, Serialize};

use super::{Cell, Paint, SwitchId, Tile, TileId, TileKind, World};

/// A kind of door.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Door {
    /// The surface of its leaf.
    pub leaf: Paint,
    /// The surface of the neighbouring walls where they face the door's cell.
    pub jamb: Paint,
    /// The key that opens it; `None` if it is not locked.
    pub key: Option<KeyId>,
    /// The switch that opens it; `None` if players open it.
    pub switch: Option<SwitchId>,
}

/// A key: an index into the world's list of their names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct KeyId(pub u8);

/// The open part of a door, from 0 to 1: the part of its leaf that is in the jamb.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Opening(f64);

impl Opening {
    /// Closed.
    pub const CLOSED: Self = Self(0.0);
    /// Fully open.
    pub const OPEN: Self = Self(1.0);

    /// An opening from 0 to 1. `None` outside that range.
    pub fn new(part: f64) -> Option<Self> {
        // Adding zero removes the sign of a negative zero.
        (0.0..=1.0).contains(&part).then_some(Self(part + 0.0))
    }

    /// The open part, from 0 to 1.
    pub fn part(self) -> f64 {
        self.0
    }
}

impl World {
    /// The door in `cell`, open or closed; `None` if there is none.
    pub fn door(&self, cell: Cell) -> Option<Door> {
        match self.kind_at(cell)? {
            TileKind::Door(door) | TileKind::Doorway(door) => Some(door),
            _ => None,
        }
    }

    /// The opening of the door in `cell`; closed if there is no door.
    pub fn opening(&self, cell: Cell) -> Opening {
        match self.kind_at(cell) {
            Some(TileKind::Doorway(_)) => Opening::OPEN,
            _ => self.ajar.opening(cell).unwrap_or(Opening::CLOSED),
        }
    }

    /// Sets the opening of the door in `cell`; does nothing if there is none. The cell becomes open
    /// floor if the door is fully open, and solid otherwise.
    pub fn set_opening(&mut self, cell: Cell, opening: Opening) {
        let Some(&Tile { character, kind, .. }) = self.tile_in(cell) else { return };
        if !matches!(kind, TileKind::Door(_) | TileKind::Doorway(_)) {
            return;
        }
        let solid = |kind: &TileKind| matches!(kind, TileKind::Door(_));
        let id = match opening {
            Opening::OPEN => self.doorway(character),
            _ => self.tile_id(character, solid),
        };
        if let Some(id) = id {
            self.set_tile(cell, id);
            self.ajar.set(cell, opening);
        }
    }

    /// The name of the key `id`, such as "brass".
    ///
    /// # Panics
    /// If `id` comes from another world that has more keys.
    pub fn key_name(&self, id: KeyId) -> &str {
        &self.keys[usize::from(id.0)]
    }

    fn kind_at(&self, cell: Cell) -> Option<TileKind> {
        self.tile_in(cell).map(|tile| tile.kind)
    }

    /// The doorway of the door with `character`.
    pub(crate) fn doorway(&self, character: char) -> Option<TileId> {
        self.tile_id(character, |kind| matches!(kind, TileKind::Doorway(_)))
    }

    fn tile_id(&self, character: char, is_kind: impl Fn(&TileKind) -> bool) -> Option<TileId> {
        let is_it = |tile: &Tile| tile.character == character && is_kind(&tile.kind);
        self.tiles.iter().position(is_it).map(|index| TileId(index as u8))
    }
}

/// The doors that are partly open.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct PartlyOpenDoors {
    /// Sorted by cell. There are few at any time.
    openings: Vec<(Cell, Opening)>,
}

impl PartlyOpenDoors {
    /// The opening of the door in `cell`, if it is partly open.
    fn opening(&self, cell: Cell) -> Option<Opening> {
        self.find(cell).ok().map(|index| self.openings[index].1)
    }

    /// Records the opening of the door in `cell`.
    fn set(&mut self, cell: Cell, opening: Opening) {
        let is_ajar = Opening::CLOSED < opening && opening < Opening::OPEN;
        match self.find(cell) {
            Ok(index) if is_ajar => self.openings[index].1 = opening,
            Err(index) if is_ajar => self.openings.insert(index, (cell, opening)),
            Ok(index) => _ = self.openings.remove(index),
            Err(_) => {}
        }
    }

    fn find(&self, cell: Cell) -> Result<usize, usize> {
        self.openings.binary_search_by_key(&cell, |&(ajar, _)| ajar)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_opening_is_between_zero_and_one() {
        for part in [0.0, -0.0, 0.25, 1.0] {
            assert_eq!(Opening::new(part).map(Opening::part), Some(part));
        }
        for part in [-0.001, 1.001, f64::NAN, f64::INFINITY] {
            assert_eq!(Opening::new(part), None);
        }
    }

    #[test]
    fn only_doors_that_are_ajar_are_remembered() {
        let cell = |column| Cell { column, row: 0 };
        let half = Opening::new(0.5).unwrap();
        let mut ajar = PartlyOpenDoors::default();
        for column in [5, 3, 4] {
            ajar.set(cell(column), half);
        }
        ajar.set(cell(4), Opening::CLOSED);
        ajar.set(cell(3), Opening::OPEN);
        assert_eq!([3, 4, 5].map(|column| ajar.opening(cell(column))), [None, None, Some(half)]);
        ajar.set(cell(5), Opening::CLOSED);
        assert_eq!(ajar, PartlyOpenDoors::default());
    }
}
