//! Reachable keys: a search from the start through open floor, doors, and locked doors whose keys
//! or switches have been found.
//!
//! It overestimates what the player can reach: walls that sink are open, all floors are at one
//! height, and a plate that a guard may step on is pressed.
//!
//! What is known of a cell is in arrays with a value for each cell. Ordered sets of cells were refused:
//! a map with a pillar in each of a million cells took 1.3 s, most of it in the sets.

use std::collections::{BTreeMap, BTreeSet};
use std::mem;
use std::num::NonZeroU32;

use crate::world::{Cell, Flood, Grid};

/// What opens a door.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Opener<'a> {
    /// The key of that name.
    Key(&'a str),
    /// The switch of that name.
    Switch(&'a str),
}

/// An opener by its number, from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct OpenerId(NonZeroU32);

/// The openers of a map, numbered.
#[derive(Default)]
pub(crate) struct Openers<'a> {
    ids: BTreeMap<Opener<'a>, OpenerId>,
}

/// A value for each cell of a grid, the default at first.
pub(crate) struct PerCell<T> {
    width: usize,
    values: Vec<T>,
}

/// A map for the search.
pub(crate) struct Reach<'g> {
    grid: &'g Grid,
    /// Solid cells that can be passed: doors; walls that sink; shapes, which may leave room beside
    /// them; and things that the player may jump over.
    pub(crate) passable: PerCell<bool>,
    /// What opens the door in a cell, if it is locked.
    pub(crate) locks: PerCell<Option<OpenerId>>,
    /// What the player finds in a cell.
    pub(crate) found: PerCell<Option<OpenerId>>,
    /// The switches of levers, for each cell from which the player can reach them.
    pub(crate) levers: BTreeMap<Cell, Vec<OpenerId>>,
}

impl<'a> Openers<'a> {
    /// The number of `opener`, which is new if it has none yet. There are fewer openers than characters.
    pub(crate) fn id(&mut self, opener: Opener<'a>) -> OpenerId {
        let new = NonZeroU32::MIN.saturating_add(self.ids.len() as u32);
        *self.ids.entry(opener).or_insert(OpenerId(new))
    }

    /// The number of `opener`; `None` if it has none.
    pub(crate) fn known(&self, opener: Opener<'_>) -> Option<OpenerId> {
        self.ids.get(&opener).copied()
    }
}

impl<T: Copy + Default> PerCell<T> {
    fn new(grid: &Grid) -> Self {
        let (width, height) = (grid.width() as usize, grid.height() as usize);
        Self { width, values: vec![T::default(); width * height] }
    }

    /// Sets the value of `cell`, and returns the one before.
    pub(crate) fn replace(&mut self, cell: Cell, value: T) -> T {
        let index = self.index(cell);
        mem::replace(&mut self.values[index], value)
    }

    fn get(&self, cell: Cell) -> T {
        self.values[self.index(cell)]
    }

    fn index(&self, cell: Cell) -> usize {
        cell.row as usize * self.width + cell.column as usize
    }
}

impl<'g> Reach<'g> {
    /// A map of `grid` in which nothing is found.
    pub(crate) fn new(grid: &'g Grid) -> Self {
        let (locks, found) = (PerCell::new(grid), PerCell::new(grid));
        Self { grid, passable: PerCell::new(grid), locks, found, levers: BTreeMap::new() }
    }

    /// What the player can reach from `start`, and what is `given`.
    pub(crate) fn openers_from(
        &self,
        start: Cell,
        given: BTreeSet<OpenerId>,
    ) -> BTreeSet<OpenerId> {
        let mut taken = given;
        let mut waiting = BTreeMap::<OpenerId, Vec<Cell>>::new();
        let size = (self.grid.width(), self.grid.height());
        let mut flood = Flood::new(size, start);
        loop {
            let next = flood.next(|cell| {
                let missing = self.locks.get(cell).filter(|opener| !taken.contains(opener));
                if let Some(opener) = missing {
                    waiting.entry(opener).or_default().push(cell);
                }
                missing.is_none() && self.can_enter(cell)
            });
            let Some((cell, _)) = next else { return taken };
            let at_levers = self.levers.get(&cell).into_iter().flatten().copied();
            for opener in self.found.get(cell).into_iter().chain(at_levers) {
                if taken.insert(opener) {
                    let doors = waiting.remove(&opener).unwrap_or_default();
                    doors.into_iter().for_each(|door| flood.enter(door));
                }
            }
        }
    }

    fn can_enter(&self, cell: Cell) -> bool {
        let (column, row) = (i64::from(cell.column), i64::from(cell.row));
        let is_barred = self.grid.is_solid(column, row) || self.grid.is_occupied(column, row);
        !is_barred || self.passable.get(cell)
    }
}
