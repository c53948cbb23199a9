//! Glow: the cells that one kind of lamp lights, as a tree.
//!
//! The lines from a lamp to the cells within its reach are the same at every position, and many of
//! them share their first cells. They are computed once, as a tree. Each lamp follows the branches
//! of the tree until they meet an obstacle. Following every line by itself was refused: a generated
//! level has hundreds of lamps, and that took most of the time in which its window moves.
//!
//! Both ends of a line are middles of cells, so the order in which it crosses the lines of the grid
//! is that of fractions of small integers. It is the order of a [`Ray`](crate::cast::Ray) between
//! the two middles.

use glam::DVec2;

use super::Lamp;
use crate::sort;
use crate::world::{Cell, Grid, Light, TileId};

/// The cells that a kind of lamp lights where nothing stands around it.
#[derive(Debug)]
pub(crate) struct Glow {
    /// What it adds in its own cell.
    light: Light,
    /// The cells as a tree: each comes before those behind it.
    branches: Vec<Branch>,
}

/// A cell that light passes, coming from the cell before it in the tree. A lamp of the longest reach
/// has 25,000 of them, so they are kept small.
#[derive(Debug)]
struct Branch {
    /// Columns to the east of the lamp, and rows to the south, each at most the longest reach.
    offset: (i8, i8),
    /// What the lamp adds there; nothing, if its light only passes through.
    light: Light,
    /// The index of the first cell whose line does not lead through this one.
    next_beside: u32,
}

impl Glow {
    pub(crate) fn of(lamp: &Lamp) -> Self {
        let mut lines = lines(lamp);
        // Lines that share their first cells are neighbours, and shorter ones come first.
        sort::by(&mut lines, |one, other| one.cells.cmp(&other.cells));
        let mut branches: Vec<Branch> = Vec::new();
        let mut open: Vec<usize> = Vec::new();
        let mut before: &[Offset] = &[];
        for Line { cells, light } in &lines {
            let shared = before.iter().zip(cells).take_while(|(one, other)| one == other).count();
            close(&mut branches, open.drain(shared..));
            for &(columns, rows) in &cells[shared..] {
                open.push(branches.len());
                let offset = (columns as i8, rows as i8);
                branches.push(Branch { offset, light: Light::NONE, next_beside: 0 });
            }
            if let Some(end) = branches.last_mut() {
                end.light = *light;
            }
            before = cells;
        }
        close(&mut branches, open.drain(..));
        Self { light: lamp.light_at(0.0), branches }
    }

    /// Calls `add` for each cell of `grid` that a lamp at `place` lights, with what it adds there.
    /// Light passes through tiles for which `is_clear` is true.
    pub(crate) fn shine(
        &self,
        grid: &Grid,
        place: Cell,
        is_clear: impl Fn(TileId) -> bool,
        mut add: impl FnMut(Cell, Light),
    ) {
        add(place, self.light);
        let mut index = 0;
        while let Some(branch) = self.branches.get(index) {
            let column = i64::from(place.column) + i64::from(branch.offset.0);
            let row = i64::from(place.row) + i64::from(branch.offset.1);
            if grid.tile(column, row).is_some_and(&is_clear) {
                add(Cell { column: column as u32, row: row as u32 }, branch.light);
                index += 1;
            } else {
                index = branch.next_beside as usize;
            }
        }
    }
}

/// Ends the branches at `indices`: no later cell's line leads through them.
fn close(branches: &mut [Branch], indices: impl Iterator<Item = usize>) {
    let end = branches.len() as u32;
    indices.for_each(|index| branches[index].next_beside = end);
}

type Offset = (i64, i64);

/// The cells on the line from a lamp to a cell, without the first and with the last one.
struct Line {
    cells: Vec<Offset>,
    light: Light,
}

/// The lines from a lamp to all other cells within its reach.
fn lines(lamp: &Lamp) -> Vec<Line> {
    let reach = lamp.reach.cells() as i64;
    let around = (-reach..=reach).flat_map(|row| (-reach..=reach).map(move |column| (column, row)));
    let ends = around.filter(|&end| end != (0, 0)).filter_map(|end| {
        let distance = DVec2::new(end.0 as f64, end.1 as f64).length();
        let is_reached = distance < lamp.reach.cells();
        is_reached.then(|| Line { cells: cells_to(end), light: lamp.light_at(distance) })
    });
    ends.collect()
}

/// The cells that a line from the middle of a cell to that of the cell at `end` enters. Where it
/// meets a column line and a row line at once, it crosses the row line first.
fn cells_to(end: Offset) -> Vec<Offset> {
    let (columns, rows) = (end.0.abs(), end.1.abs());
    let (mut column, mut row) = (0, 0);
    let mut cells = Vec::with_capacity((columns + rows) as usize);
    while (column, row) != (columns, rows) {
        // The next lines are at (2 column + 1) / (2 columns) and at (2 row + 1) / (2 rows) of the way.
        if (2 * row + 1) * columns <= (2 * column + 1) * rows {
            row += 1;
        } else {
            column += 1;
        }
        cells.push((column * end.0.signum(), row * end.1.signum()));
    }
    cells
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::num::NonZeroU32;

    use proptest::prelude::*;

    use super::*;
    use crate::cast::{Ray, Walk};
    use crate::world::Reach;

    /// Whether the line from the middle of one cell to that of another leads through open floor.
    fn is_seen(grid: &Grid, from: Cell, to: Cell) -> bool {
        let Ok(ray) = Ray::new(from.center(), to.center() - from.center()) else { return true };
        let mut open = Walk::new(grid, &ray).take_while(|it| !grid.is_solid_tile(it.tile));
        open.any(|crossing| crossing.cell == to)
    }

    proptest! {
        #[test]
        fn a_lamp_lights_what_a_straight_line_leads_to(
            width in 1_u32..24,
            solid in prop::collection::vec(prop::bool::weighted(0.2), 24 * 24),
            height in 1_u32..24,
            place in any::<prop::sample::Index>(),
            reach in prop_oneof![1.0..=32.0, (1..=32_u32).prop_map(f64::from)],
        ) {
            let place = place.index((width * height) as usize) as u32;
            let place = Cell { column: place % width, row: place / width };
            let cells: Vec<TileId> = (0..height * width)
                .map(|index| TileId(u8::from(solid[index as usize])))
                .collect();
            let sides = [width, height].map(|side| NonZeroU32::new(side).unwrap());
            let grid = Grid::new(sides[0], sides[1], TileId(1), cells).unwrap();
            let lamp = Lamp { light: Light::FULL, reach: Reach::new(reach).unwrap() };

            let mut lit = BTreeMap::new();
            let is_clear = |tile| !grid.is_solid_tile(tile);
            Glow::of(&lamp).shine(&grid, place, is_clear, |cell, light| {
                let before = lit.entry(cell).or_insert(Light::NONE);
                *before = before.plus(light);
            });
            let every_cell = (0..height).flat_map(|row| (0..width).map(move |column| Cell { column, row }));
            for cell in every_cell {
                let distance = cell.center().distance(place.center());
                let is_lit = distance < reach && is_seen(&grid, place, cell);
                let expected = if is_lit { lamp.light_at(distance) } else { Light::NONE };
                prop_assert_eq!(lit.get(&cell).copied().unwrap_or(Light::NONE), expected, "{:?}", cell);
            }
        }
    }
}
