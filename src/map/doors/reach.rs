//! Reachable keys: a search from the start through open floor, doors, and locked doors whose keys
//! or switches have been found.
//!
//! It overestimates what the player can reach: walls that sink are open, all floors are at one
//! height, and a plate that a guard may step on is pressed.

use std::collections::{BTreeMap, BTreeSet};

use crate::world::{Cell, Grid};

/// What opens a door.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Opener<'a> {
    /// The key of that name.
    Key(&'a str),
    /// The switch of that name.
    Switch(&'a str),
}

/// A map for the search.
pub(super) struct Reach<'a> {
    pub(super) grid: &'a Grid,
    /// Solid cells that can be passed: doors; walls that sink; shapes, which may leave room beside
    /// them; and things that the player may jump over.
    pub(super) passable: &'a BTreeSet<Cell>,
    /// Locked doors, and what opens them.
    pub(super) locks: &'a BTreeMap<Cell, Opener<'a>>,
    /// What the player finds in a cell or, for levers, beside it.
    pub(super) found: &'a BTreeMap<Cell, Vec<Opener<'a>>>,
}

impl<'a> Reach<'a> {
    /// What the player can reach from `start`, and what is `given`.
    pub(super) fn openers_from(
        &self,
        start: Cell,
        given: BTreeSet<Opener<'a>>,
    ) -> BTreeSet<Opener<'a>> {
        let mut taken = given;
        let mut waiting = BTreeMap::<Opener<'_>, Vec<Cell>>::new();
        let mut seen = vec![false; self.grid.width() as usize * self.grid.height() as usize];
        let mut next = vec![start];
        while let Some(cell) = next.pop() {
            if std::mem::replace(&mut seen[self.index(cell)], true) {
                continue;
            }
            if let Some(&opener) = self.locks.get(&cell)
                && !taken.contains(&opener)
            {
                waiting.entry(opener).or_default().push(cell);
                continue;
            }
            for &opener in self.found.get(&cell).into_iter().flatten() {
                if taken.insert(opener) {
                    for door in waiting.remove(&opener).unwrap_or_default() {
                        seen[self.index(door)] = false;
                        next.push(door);
                    }
                }
            }
            next.extend(self.neighbors(cell));
        }
        taken
    }

    fn index(&self, cell: Cell) -> usize {
        cell.row as usize * self.grid.width() as usize + cell.column as usize
    }

    /// The neighbours of `cell` that the player can enter.
    fn neighbors(&self, cell: Cell) -> impl Iterator<Item = Cell> {
        let sides = [(-1, 0), (1, 0), (0, -1), (0, 1)];
        sides.into_iter().filter_map(move |(columns, rows)| {
            let (column, row) = (i64::from(cell.column) + columns, i64::from(cell.row) + rows);
            let tile = self.grid.tile(column, row)?;
            let is_barred = self.grid.is_solid_tile(tile) || self.grid.is_occupied(column, row);
            let cell = Cell { column: column as u32, row: row as u32 };
            (!is_barred || self.passable.contains(&cell)).then_some(cell)
        })
    }
}
