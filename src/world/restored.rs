//! What a game changes in its world, and the world of the map with these changes.

use super::{Cell, Figure, Thing, World};

/// What a game changes in its world, but for the tiles and openings that its doors and mechanisms know, and
/// the light of lamps.
pub(crate) struct Changes<'a> {
    pub(crate) things: &'a [Thing],
    pub(crate) figures: &'a [Figure],
    /// Whether lamps have ever added light.
    pub(crate) is_lamplit: bool,
}

impl World {
    /// What a game has changed.
    pub(crate) fn changes(&self) -> Changes<'_> {
        let Self {
            title: _,
            goal: _,
            // Doors and mechanisms give the tiles that have changed.
            grid: _,
            level_grid: _,
            tiles: _,
            textures: _,
            floor: _,
            ceiling: _,
            sky: _,
            fog: _,
            start: _,
            // A game adds its own at its start.
            sprites: _,
            things,
            figures,
            lamplight,
            // It follows from lamplight.
            light_varies: _,
            keys: _,
            mission: _,
            // Doors give it.
            ajar: _,
        } = self;
        Changes { things: things.all(), figures, is_lamplit: !lamplight.is_dark() }
    }

    /// Replaces the things by those that are left of them, which may show other frames, and computes all
    /// lamplight anew, without lamps that move. Returns `false`, and changes nothing, if the things are not
    /// in their order, were not all there, or have sprites without such a frame.
    pub(crate) fn leave_things(&mut self, left: Vec<Thing>) -> bool {
        let place = |cell: Cell| (cell.row, cell.column);
        let mut is_used = vec![false; self.things().len()];
        let mut is_there = |thing: &Thing| {
            let before = self.things();
            let first = before.partition_point(|it| place(it.cell) < place(thing.cell));
            let here = before[first..].iter().take_while(|it| it.cell == thing.cell);
            let is_it = |it: &Thing| Thing { frame: thing.frame, ..*it } == *thing;
            let found = (first..).zip(here).find(|&(index, it)| !is_used[index] && is_it(it));
            let Some((index, _)) = found else { return false };
            is_used[index] = true;
            thing.frame.is_none_or(|frame| frame <= self.sprite(thing.sprite).last_frame())
        };
        if !left.is_sorted_by_key(|thing| place(thing.cell)) || !left.iter().all(&mut is_there) {
            return false;
        }
        self.things = super::things::Things::new(left);
        self.light_up();
        true
    }

    /// The number of keys. Their ids are the numbers below it.
    pub(crate) fn key_count(&self) -> usize {
        self.keys.len()
    }
}
