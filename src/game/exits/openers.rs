//! Openers: keys, and switches of levers and plates, that the player has reached.

use std::collections::BTreeSet;

use crate::sort;
use crate::world::{Cell, Driver, KeyId, SwitchId, ThingKind, Tile, TileEffect, World};

/// What the player has found that opens doors and moves tiles.
#[derive(Clone, PartialEq, Default)]
pub(crate) struct Openers {
    pub(crate) keys: BTreeSet<KeyId>,
    pub(crate) switches: BTreeSet<SwitchId>,
}

impl Openers {
    /// Adds the keys and plates in `cell`, and the levers in and around it.
    pub(crate) fn find_in(&mut self, world: &World, cell: Cell) {
        for thing in world.things_in(cell) {
            if let ThingKind::Key(key) = thing.kind {
                self.keys.insert(key);
            }
        }
        if let Some(TileEffect::Plate(switch)) = world.effect_in(cell) {
            self.switches.insert(switch);
        }
        if world.switch_count() == 0 {
            return;
        }
        for row in cell.row.saturating_sub(1)..=cell.row.saturating_add(1) {
            for column in cell.column.saturating_sub(1)..=cell.column.saturating_add(1) {
                for thing in world.things_in(Cell { column, row }) {
                    if let ThingKind::Lever(switch) = thing.kind {
                        self.switches.insert(switch);
                    }
                }
            }
        }
    }

    /// Whether what `driver` moves may be anywhere on its way.
    pub(crate) fn can_move(&self, driver: Driver) -> bool {
        match driver {
            Driver::Switch(switch) => self.switches.contains(&switch),
            Driver::Hand | Driver::Weight => true,
        }
    }
}

/// The switches of plates, if there are guards who may step on them.
pub(crate) fn pressed_by_guards(world: &World) -> BTreeSet<SwitchId> {
    let plate = |tile: &Tile| match tile.effect {
        Some(TileEffect::Plate(switch)) => Some(switch),
        _ => None,
    };
    let has_guards = !world.guards().is_empty();
    sort::gathered(world.tiles().iter().filter(|_| has_guards).filter_map(plate))
}
