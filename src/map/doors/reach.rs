//! Reachable keys: a search from the start through open floor, doors, and locked doors whose keys
//! have been found.

use std::collections::{BTreeMap, BTreeSet};

use crate::world::{Cell, Grid};

/// A map for the search.
pub(super) struct Reach<'a> {
    pub(super) grid: &'a Grid,
    /// Solid cells that can be passed: doors; shapes, which may leave room beside them; and things
    /// that the player may jump over.
    pub(super) passable: &'a BTreeSet<Cell>,
    /// Locked doors, and the names of their keys.
    pub(super) locks: &'a BTreeMap<Cell, &'a str>,
    /// Keys in the grid, and their names.
    pub(super) keys: &'a BTreeMap<Cell, &'a str>,
}

impl<'a> Reach<'a> {
    /// The names of the keys that the player can reach from `start`.
    pub(super) fn keys_from(&self, start: Cell) -> BTreeSet<&'a str> {
        let mut taken = BTreeSet::new();
        let mut waiting = BTreeMap::<&str, Vec<Cell>>::new();
        let mut seen = vec![false; self.grid.width() as usize * self.grid.height() as usize];
        let mut next = vec![start];
        while let Some(cell) = next.pop() {
            if std::mem::replace(&mut seen[self.index(cell)], true) {
                continue;
            }
            if let Some(&key) = self.locks.get(&cell)
                && !taken.contains(key)
            {
                waiting.entry(key).or_default().push(cell);
                continue;
            }
            if let Some(&key) = self.keys.get(&cell)
                && taken.insert(key)
            {
                for door in waiting.remove(key).unwrap_or_default() {
                    seen[self.index(door)] = false;
                    next.push(door);
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
