//! Mechanisms: tiles that move, what moves them, and what happens to those who stand on a tile.
//!
//! A moving tile has a list of states, which are tiles themselves. A game replaces the tile of a
//! cell by the next state, so that drawing, collision and light need not know that it moves. A
//! height for each cell was refused: every stage would read it in its innermost loop.

use serde::{Deserialize, Serialize};

use super::{Cell, TileId, World};

/// A switch: an index into the world's list of their names. Levers and plates set it.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize,
)]
pub struct SwitchId(pub u8);

/// A tile whose cells change their height.
#[derive(Clone, Debug, PartialEq)]
pub struct MovingTile {
    /// The tiles that a cell shows in turn, from rest to the end; there are at least two. The first
    /// one is drawn in the map, and is among the states of no other moving tile.
    pub states: Vec<TileId>,
    /// What moves it.
    pub driver: Driver,
}

/// What moves a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driver {
    /// A switch: all its cells move to the end while it is on, and back while it is off.
    Switch(SwitchId),
    /// A hand: a cell moves to the end, for good, after the player has opened it. It looks like a
    /// wall, and counts as a secret.
    Hand,
    /// A weight: a cell moves to the end, for good, some time after somebody has stepped on it.
    Weight,
}

/// What happens to those who stand on a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TileEffect {
    /// Cold water: it slows, splashes, puts out lamps, and hurts those who stay.
    Water,
    /// A plate: its switch is on while somebody stands on it.
    Plate(SwitchId),
}

impl World {
    /// The tiles that move.
    pub fn moving_tiles(&self) -> &[MovingTile] {
        &self.mission.moving_tiles
    }

    /// The name of the switch `id`.
    ///
    /// # Panics
    /// If `id` comes from another world that has more switches.
    pub fn switch_name(&self, id: SwitchId) -> &str {
        &self.mission.switches[usize::from(id.0)]
    }

    /// The number of switches. Their ids are the numbers below it.
    pub fn switch_count(&self) -> usize {
        self.mission.switches.len()
    }

    /// The effect of the tile of `cell` on those who stand there.
    pub fn effect_in(&self, cell: Cell) -> Option<TileEffect> {
        self.tile_at(cell)?.effect
    }

    /// Sets the tile of `cell`, which must be a cell of a [`MovingTile`], to one of its states.
    pub(crate) fn set_state(&mut self, cell: Cell, state: TileId) {
        self.set_tile(cell, state);
        let is_level = self.tile(state).is_level();
        if let Some(grid) = &mut self.level_grid {
            grid.set(cell, if is_level { state } else { TileId(u8::MAX) });
        }
    }
}
