//! Mechanisms as bytes, and in a world where they rest.

use super::Mechanisms;
use crate::game::stored::{Reader, StoredPart, Unrestorable, Writer, check};
use crate::world::World;

impl StoredPart for Mechanisms {
    fn write(&self, out: &mut Writer) {
        let Self {
            switches,
            plates,
            moving,
            // Found anew.
            down: _,
            active: _,
            secrets: _,
            // Given by the level.
            first_cells: _,
            doors: _,
            has_handles: _,
            has_crumbling: _,
        } = self;
        out.parts(switches);
        out.parts(plates);
        out.parts(moving);
    }

    fn read_over(&mut self, input: &mut Reader) -> Result<(), Unrestorable> {
        let Self {
            switches,
            plates,
            moving,
            // Found anew.
            down: _,
            active: _,
            secrets: _,
            // Given by the level.
            first_cells: _,
            doors: _,
            has_handles: _,
            has_crumbling: _,
        } = self;
        input.parts(switches)?;
        input.parts(plates)?;
        input.parts(moving)
    }
}

impl Mechanisms {
    /// Shows moving tiles in `world`, where they rest, as they are.
    ///
    /// # Errors
    /// If one is beyond its last state.
    pub(crate) fn show(&mut self, world: &mut World) -> Result<(), Unrestorable> {
        for moving in &self.moving {
            check(moving.is_possible(world), "a moving tile")?;
            let (cell, shown) = (moving.cell(), moving.shown(world));
            if world.grid().tile_in(cell) != Some(shown) {
                world.set_state(cell, shown);
            }
        }
        self.recollect(world);
        Ok(())
    }
}
