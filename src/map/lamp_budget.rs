//! The limit on the light of lamps.
//!
//! A lamp takes time for each cell within its reach, so a number of lamps alone would be no limit.
//! The cells that all lamps of a map can light are counted, without regard to walls, before any of
//! them is lit.

use crate::world::Lamp;

/// The largest number of cells that lamps light, a cell counted for each lamp that reaches it: ten
/// thousand lamps of the longest reach.
pub(crate) const MOST_CELLS: u64 = 1 << 25;
/// The cells that a kind of lamp lights are computed once, which takes as long as to light this many
/// lamps.
const COST_OF_KIND: u64 = 32;

/// The cells that the lamps of a map may still light.
pub(crate) struct LampBudget {
    /// `None` after lamps exceeded it.
    left: Option<u64>,
}

impl Default for LampBudget {
    /// That of a whole map.
    fn default() -> Self {
        Self { left: Some(MOST_CELLS) }
    }
}

impl LampBudget {
    /// Takes the cells that `count` lamps of a kind light. Returns whether they exceed the budget,
    /// once only.
    pub(crate) fn is_exceeded_by(&mut self, lamp: Lamp, count: usize) -> bool {
        let Some(left) = self.left else { return false };
        let cells = lamp.reach.cell_count() * (count as u64 + COST_OF_KIND);
        self.left = left.checked_sub(cells);
        self.left.is_none()
    }
}
