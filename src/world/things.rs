//! Things, which stand in the cells, and figures, which move.
//!
//! Things are sorted by row and column, so the things in a range of cells are one slice. The start
//! of each row is stored; within the row, a binary search finds the slice. A frame looks at the
//! things in the cells that it shows, and other things cost nothing. Rejected: a list for each
//! cell. Most cells are empty, and a map has millions.
//!
//! A figure is at any place, and its owner sets its height, heading and frame: a guard, a thrown
//! stone, a cloud of smoke. A game replaces all figures at once after each step, so none can be
//! left behind. Rules:
//!
//! - A frame considers every figure. There are tens, and each costs one projection. Rejected:
//!   sorting them by cell. They change their cells all the time.
//! - A figure has the light of the cell that it is in. As with a thing, no part of it is drawn
//!   behind the edge of the map.
//! - A figure never changes with time, and causes no [next
//!   change](crate::render::Renderer::next_change).

use std::ops::Range;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::{Cell, Heading, KeyId, Light, Sprite, SpriteId, SwitchId, World};
use crate::sort;

/// Something that stands in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Thing {
    /// The kind of thing.
    pub kind: ThingKind,
    /// The cell in whose middle it stands.
    pub cell: Cell,
    /// Its sprite.
    pub sprite: SpriteId,
    /// The frame of the sprite that it shows; `None` if time selects it.
    pub frame: Option<u8>,
}

/// A kind of thing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ThingKind {
    /// Reaching it finishes the level.
    Exit,
    /// Reaching it takes it. It opens the doors that need it.
    Key(KeyId),
    /// Decoration.
    Ornament,
    /// Reaching it takes it. Contains its worth.
    Treasure(u16),
    /// Reaching it takes it, if the player is hurt. Contains the health that it restores.
    Healing(u8),
    /// Reaching it takes it. Contains the kind and the number of a tool that is used up.
    Supply(Supply, u8),
    /// Reaching it shows its text.
    Note(NoteId),
    /// Reaching it makes it the place from which the player continues after death.
    Checkpoint,
    /// Opening it turns its switch on or off.
    Lever(SwitchId),
    /// Spikes, which come out of the floor at intervals and hurt.
    Spikes(Rhythm),
    /// A lamp that the player can put out.
    Flame,
}

/// A tool that is used up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Supply {
    /// Thrown, to make a noise elsewhere.
    Pebbles,
    /// Shot; stuns a guard.
    Darts,
    /// Thrown; makes smoke.
    Flasks,
}

impl Supply {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Pebbles, Self::Darts, Self::Flasks];

    /// The name in maps.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pebbles => "pebbles",
            Self::Darts => "darts",
            Self::Flasks => "flasks",
        }
    }
}

/// A text to be found, as an index into the world's list of notes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct NoteId(pub u16);

/// The times at which spikes come out: once in each period, in steps of the game.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub struct Rhythm {
    /// The number of steps from one time to the next; at least 60.
    pub period: u16,
    /// The number of steps before the first time; below the period.
    pub delay: u16,
}

impl Rhythm {
    /// The number of steps of a game in a second.
    pub(crate) const STEPS_PER_SECOND: f64 = 60.0;

    /// A rhythm in seconds, rounded to steps: a period from 1 to 60, and a delay from 0 below the
    /// period. `None` outside these ranges.
    pub fn new(period: f64, delay: f64) -> Option<Self> {
        let is_in_range = (1.0..=60.0).contains(&period) && (0.0..period).contains(&delay);
        let steps = |seconds: f64| (seconds * Self::STEPS_PER_SECOND).round() as u16;
        let rhythm = Self { period: steps(period), delay: steps(delay) };
        (is_in_range && rhythm.delay < rhythm.period).then_some(rhythm)
    }
}

/// A sprite at any place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// Its sprite, which must be one of the world's sprites. A figure with any other sprite is not
    /// drawn.
    pub sprite: SpriteId,
    /// The place of its middle, on the map.
    pub position: DVec2,
    /// The height of its lower edge, in cells.
    pub base: f64,
    /// The direction of its front.
    pub heading: Heading,
    /// The frame of the sprite that it shows; the last one, if there is no such frame.
    pub frame: u8,
    /// The share of it that covers the background, from 0 for none to 255 for all. The opacity of
    /// each texel is multiplied by it, in 255ths, and rounded to the nearest whole number.
    pub opacity: u8,
}

impl Figure {
    /// The cell that contains it; `None` west or north of the map, where there are no cells.
    pub fn cell(&self) -> Option<Cell> {
        Cell::containing(self.position)
    }
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

    /// Removes the things in `cell` for which `is_taken` is true, and their light.
    pub(crate) fn take_things(&mut self, cell: Cell, is_taken: impl Fn(ThingKind) -> bool) {
        self.put_out(cell, &is_taken);
        self.things.remove(cell, is_taken);
    }

    /// Adds a thing that has no light.
    pub(crate) fn put_thing(&mut self, thing: Thing) {
        self.things.insert(thing);
    }

    /// Sets the frame of the things in `cell` for which `is_it` is true.
    pub(crate) fn set_frame(&mut self, cell: Cell, is_it: impl Fn(ThingKind) -> bool, frame: u8) {
        let wanted = self.things.in_cell_mut(cell).iter_mut().filter(|thing| is_it(thing.kind));
        wanted.for_each(|thing| thing.frame = Some(frame));
    }

    /// The worth of all treasure.
    pub(crate) fn treasure(&self) -> u64 {
        self.things.treasure
    }

    /// The text of the note `id`.
    ///
    /// # Panics
    /// If `id` comes from another world that has more notes.
    pub fn note(&self, id: NoteId) -> &str {
        &self.mission.notes[usize::from(id.0)]
    }

    /// The figures, in the order in which they were set.
    pub fn figures(&self) -> &[Figure] {
        &self.figures
    }

    /// Replaces all figures.
    pub fn set_figures(&mut self, figures: impl Iterator<Item = Figure>) {
        self.figures.clear();
        self.figures.extend(figures);
    }

    /// Adds a sprite, for figures to refer to.
    pub(crate) fn add_sprite(&mut self, sprite: Sprite) -> SpriteId {
        let id = SpriteId(self.sprites.len() as u16);
        self.sprites = self.sprites.iter().cloned().chain([sprite]).collect();
        id
    }

    /// The greatest height that a figure reaches; 0 if there is no figure.
    pub(crate) fn top_of_figures(&self) -> f64 {
        let sprite = |figure: &Figure| self.sprites.get(usize::from(figure.sprite.0));
        let height = |figure: &Figure| sprite(figure).map_or(0.0, |sprite| sprite.height.cells());
        self.figures.iter().map(|figure| figure.base + height(figure)).fold(0.0, f64::max)
    }

    /// The light on `figure`. Off the map, returns the light of the map's own floor.
    pub(crate) fn light_on(&self, figure: &Figure) -> Light {
        let off_map = self.ground().light.unwrap_or(Light::FULL);
        figure.cell().map_or(off_map, |cell| self.light_in(cell))
    }
}

/// All things of a world, by place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Things {
    sorted: Vec<Thing>,
    /// The number of things before each row, up to the last row with any.
    before_row: Vec<usize>,
    /// The worth of all treasure.
    treasure: u64,
}

impl Things {
    pub(crate) fn new(mut things: Vec<Thing>) -> Self {
        sort::by_key(&mut things, place);
        let treasure = things.iter().map(|thing| worth(thing.kind)).sum();
        let mut new = Self { sorted: things, before_row: Vec::new(), treasure };
        new.find_rows();
        new
    }

    pub(crate) fn all(&self) -> &[Thing] {
        &self.sorted
    }

    /// The things in `row` between two columns, both included.
    pub(crate) fn between(&self, row: u32, first: u32, last: u32) -> &[Thing] {
        &self.sorted[self.range(row, first, last)]
    }

    /// The things in `cell`. The caller may change anything but their places.
    pub(crate) fn in_cell_mut(&mut self, cell: Cell) -> &mut [Thing] {
        let range = self.range(cell.row, cell.column, cell.column);
        &mut self.sorted[range]
    }

    fn range(&self, row: u32, first: u32, last: u32) -> Range<usize> {
        let start = self.before_row(row);
        let in_row = &self.sorted[start..self.before_row(row.saturating_add(1))];
        let from = in_row.partition_point(|thing| thing.cell.column < first);
        let to = from + in_row[from..].partition_point(|thing| thing.cell.column <= last);
        start + from..start + to
    }

    fn before_row(&self, row: u32) -> usize {
        self.before_row.get(row as usize).copied().unwrap_or(self.sorted.len())
    }

    fn insert(&mut self, thing: Thing) {
        self.treasure += worth(thing.kind);
        let index = self.sorted.partition_point(|other| place(other) <= place(&thing));
        self.sorted.insert(index, thing);
        self.find_rows();
    }

    /// Removes the things in `cell` for which `is_gone` is true. Other things are moved without
    /// being looked at, because a map may have a million.
    fn remove(&mut self, cell: Cell, is_gone: impl Fn(ThingKind) -> bool) {
        let range = self.range(cell.row, cell.column, cell.column);
        let Self { sorted, before_row, treasure } = self;
        let mut gone = 0;
        for index in range.rev() {
            if is_gone(sorted[index].kind) {
                *treasure -= worth(sorted.remove(index).kind);
                gone += 1;
            }
        }
        before_row.truncate(sorted.last().map_or(0, |last| last.cell.row as usize + 1));
        before_row.iter_mut().skip(cell.row as usize + 1).for_each(|before| *before -= gone);
    }

    fn find_rows(&mut self) {
        let Self { sorted, before_row, .. } = self;
        before_row.clear();
        for (index, thing) in sorted.iter().enumerate() {
            before_row.resize(before_row.len().max(thing.cell.row as usize + 1), index);
        }
    }
}

fn worth(kind: ThingKind) -> u64 {
    if let ThingKind::Treasure(worth) = kind { worth.into() } else { 0 }
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
        Thing {
            kind: ThingKind::Ornament,
            cell: Cell { column, row },
            sprite: SpriteId(0),
            frame: None,
        }
    }

    proptest! {
        #[test]
        fn a_range_of_a_row_yields_its_things(
            places in prop::collection::vec((0..SIDE, 0..SIDE), 0..20),
            gone in (0..SIDE, 0..SIDE),
            row in prop_oneof![0..SIDE + 2, Just(u32::MAX)],
            first in 0..SIDE,
            length in 0..SIDE,
        ) {
            let last = first + length;
            let mut things = Things::new(places.iter().copied().map(thing).collect());
            things.remove(thing(gone).cell, |_| true);
            let left = places.into_iter().filter(|&place| place != gone);
            prop_assert_eq!(&things, &Things::new(left.clone().map(thing).collect()));
            let mut expected: Vec<(u32, u32)> = left
                .filter(|&place| place.0 == row && (first..=last).contains(&place.1))
                .collect();
            expected.sort_unstable();
            let found: Vec<_> = things.between(row, first, last).iter().map(place).collect();
            prop_assert_eq!(found, expected);
        }
    }
}
