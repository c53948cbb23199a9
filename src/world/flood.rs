//! Flood fill: the cells that can be reached from a start in straight steps, the nearest first.
//!
//! The search is breadth-first, and the caller says which cells are open. `game::distances`
//! contains the searches with costs and diagonal steps.

use std::collections::VecDeque;

use super::Cell;

/// A flood fill of a map.
pub(crate) struct Flood {
    /// The columns and rows of the map.
    size: (u32, u32),
    /// Whether each cell has been reached, row by row.
    is_reached: Vec<bool>,
    /// The cells whose neighbours have not been visited, with the number of steps to each.
    queue: VecDeque<(Cell, u32)>,
}

impl Flood {
    /// Begins at `start`, a cell of a map with these columns and rows.
    pub(crate) fn new((columns, rows): (u32, u32), start: Cell) -> Self {
        let is_reached = vec![false; columns as usize * rows as usize];
        let mut flood = Self { size: (columns, rows), is_reached, queue: VecDeque::new() };
        flood.enter(start);
        flood
    }

    /// Adds another start, unless the cell has been reached.
    pub(crate) fn enter(&mut self, cell: Cell) {
        self.reach(cell, 0, |_| true);
    }

    /// Returns the next cell and the number of steps to it, and spreads to its neighbours for which
    /// `is_open` is true. `is_open` is called with cells of the map that have not been reached.
    pub(crate) fn next(&mut self, mut is_open: impl FnMut(Cell) -> bool) -> Option<(Cell, u32)> {
        let (cell, steps) = self.queue.pop_front()?;
        cell.beside().for_each(|beside| self.reach(beside, steps + 1, &mut is_open));
        Some((cell, steps))
    }

    fn reach(&mut self, cell: Cell, steps: u32, is_open: impl FnOnce(Cell) -> bool) {
        let (columns, rows) = self.size;
        if cell.column >= columns || cell.row >= rows {
            return;
        }
        let is_reached =
            &mut self.is_reached[cell.row as usize * columns as usize + cell.column as usize];
        if !*is_reached && is_open(cell) {
            *is_reached = true;
            self.queue.push_back((cell, steps));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_come_once_and_nearest_first() {
        let map = ["..#.", ".##.", "...."];
        let is_open = |cell: Cell| map[cell.row as usize].as_bytes()[cell.column as usize] == b'.';
        let mut flood = Flood::new((4, 3), Cell { column: 1, row: 0 });
        let mut found = Vec::new();
        while let Some((Cell { column, row }, steps)) = flood.next(is_open) {
            found.push((column, row, steps));
        }
        let expected = [(1, 0, 0), (0, 0, 1), (0, 1, 2), (0, 2, 3), (1, 2, 4), (2, 2, 5)];
        assert_eq!(found[..6], expected);
        assert_eq!(found[6..], [(3, 2, 6), (3, 1, 7), (3, 0, 8)]);
        flood.enter(Cell { column: 3, row: 0 });
        assert_eq!(flood.next(is_open), None);
        flood.enter(Cell { column: 2, row: 1 });
        assert_eq!(flood.next(is_open), Some((Cell { column: 2, row: 1 }, 0)));
    }
}
