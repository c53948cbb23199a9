//! Lamplight: what lamps add to the light of nearby cells.
//!
//! A cell is lit if the straight line from the middle of the lamp's cell to its own middle passes
//! only through open floor, masks and glass. For things, doors count as closed: lamplight that
//! passes through opening doors was refused, since all lamps around would have to be computed again,
//! for a small difference. A lamp that moves shines through doors that are fully open, because the
//! player carries one.
//!
//! The sum of all lamps is stored for each cell, without a limit. What one lamp adds is therefore
//! taken away exactly when it moves, goes out, or has a wall moved before it, and the other lamps
//! are not computed again. Maps in which lamps change nothing store nothing.

mod glow;
mod lamps;

use super::{Cell, Grid, Light};
use lamps::{Change, Glows};

/// The light of a lamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// What it adds in its own cell.
    pub light: Light,
    /// How far its light reaches.
    pub reach: Reach,
}

/// A distance that light reaches, in cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach(f64);

impl Reach {
    /// The longest reach, in cells.
    const MOST: f64 = 32.0;

    /// A reach from 1 to 32 cells. `None` outside that range.
    pub fn new(cells: f64) -> Option<Self> {
        (1.0..=Self::MOST).contains(&cells).then_some(Self(cells))
    }

    /// The reach in cells.
    pub const fn cells(self) -> f64 {
        self.0
    }

    /// The number of cells that a lamp with this reach lights where nothing stands around it.
    pub(crate) fn cell_count(self) -> u64 {
        let most = self.0 as i64;
        let around = (-most..=most).flat_map(|row| (-most..=most).map(move |column| (column, row)));
        let is_reached =
            |&(column, row): &(i64, i64)| ((column * column + row * row) as f64).sqrt() < self.0;
        around.filter(is_reached).count() as u64
    }
}

impl Default for Reach {
    /// Four cells.
    fn default() -> Self {
        Self(4.0)
    }
}

impl Lamp {
    /// What it adds in a cell whose middle is `distance` cells away: `light · (1 − (distance /
    /// reach)²)²`, which ends smoothly at the reach.
    pub(crate) fn light_at(&self, distance: f64) -> Light {
        let part = (distance / self.reach.0).min(1.0);
        let nearness = 1.0 - part * part;
        self.light.dimmed(nearness * nearness)
    }
}

/// What lamps add in each cell.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct Lamplight {
    width: usize,
    /// The sums of what lamps add, in 256ths, row by row from the north; empty if no lamp adds
    /// anything.
    sums: Vec<u32>,
    /// Whether any cell is not fully lit without lamps.
    is_needed: bool,
    /// The lamps that move, and the cells that they are in.
    moving: Vec<(Cell, Lamp)>,
    glows: Glows,
}

impl Lamplight {
    /// Whether no lamp adds anything.
    pub(crate) fn is_dark(&self) -> bool {
        self.sums.is_empty()
    }

    /// What lamps add in `cell`.
    #[inline]
    pub(crate) fn at(&self, cell: Cell) -> Light {
        let is_on_map = (cell.column as usize) < self.width;
        let sum = self.sums.get(self.place(cell)).filter(|_| is_on_map);
        sum.map_or(Light::NONE, |&sum| Light::saturated(sum))
    }

    /// Reserves memory for the cells of `grid`, without any light yet.
    fn begin(&mut self, grid: &Grid) {
        let (width, height) = (grid.width() as usize, grid.height() as usize);
        self.width = width;
        self.sums.clear();
        self.sums.resize(width * height, 0);
    }

    /// Adds `light` in `cell`, or takes away what was added.
    fn change(&mut self, cell: Cell, light: Light, change: Change) {
        let place = self.place(cell);
        if let Some(sum) = self.sums.get_mut(place) {
            *sum = match change {
                Change::Add => *sum + light.in_256ths(),
                Change::TakeAway => *sum - light.in_256ths(),
            };
        }
    }

    fn place(&self, cell: Cell) -> usize {
        cell.row as usize * self.width + cell.column as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reach_of_whole_cells_ends_before_the_last() {
        let counts =
            [1.0, 1.5, 2.0, 4.0, 32.0].map(|cells| Reach::new(cells).unwrap().cell_count());
        assert_eq!(counts, [1, 9, 9, 45, 3205]);
    }

    #[test]
    fn a_lamp_is_brightest_in_its_cell_and_ends_at_its_reach() {
        let lamp = Lamp { light: Light::new(0.5).unwrap(), reach: Reach::default() };
        let lights = [0.0, 1.0, 2.0, 3.0, 3.9, 4.0, 9.0].map(|cells| lamp.light_at(cells));
        assert_eq!(lights[0], lamp.light);
        assert!(lights.windows(2).all(|pair| pair[0].in_256ths() >= pair[1].in_256ths()));
        assert_eq!(lights[5..], [Light::NONE; 2]);
    }
}
