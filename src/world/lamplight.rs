//! Lamplight: what lamps add to the light of nearby cells.
//!
//! It is computed once, when a map is read, and stored as one light for each cell; maps in which it
//! changes nothing store none. Lamplight that passes through opening doors was refused: every lamp
//! would have to be computed again in each step, for a small difference.

use std::num::NonZeroU32;

use super::{Cell, Light};

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
    /// A reach from 1 to 32 cells. `None` outside that range.
    pub fn new(cells: f64) -> Option<Self> {
        (1.0..=32.0).contains(&cells).then_some(Self(cells))
    }

    /// The reach in cells.
    pub const fn cells(self) -> f64 {
        self.0
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
        let nearness = 1.0 - (distance / self.reach.0).min(1.0).powi(2);
        self.light.dimmed(nearness * nearness)
    }
}

/// What lamps add in each cell.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct Lamplight {
    width: usize,
    /// Row by row from the north; empty if no lamp adds anything.
    cells: Vec<Light>,
}

impl Lamplight {
    /// No light, for a map of that size.
    pub(crate) fn new(width: NonZeroU32, height: NonZeroU32) -> Self {
        let width = width.get() as usize;
        Self { width, cells: vec![Light::NONE; width * height.get() as usize] }
    }

    /// Whether no lamp adds anything.
    pub(crate) fn is_dark(&self) -> bool {
        self.cells.is_empty()
    }

    /// Adds `light` in `cell`.
    pub(crate) fn add(&mut self, cell: Cell, light: Light) {
        let place = self.place(cell);
        if let Some(cell) = self.cells.get_mut(place) {
            *cell = cell.plus(light);
        }
    }

    /// What lamps add in `cell`.
    #[inline]
    pub(crate) fn at(&self, cell: Cell) -> Light {
        let is_on_map = (cell.column as usize) < self.width;
        let light = self.cells.get(self.place(cell)).filter(|_| is_on_map);
        light.copied().unwrap_or(Light::NONE)
    }

    fn place(&self, cell: Cell) -> usize {
        cell.row as usize * self.width + cell.column as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lamp_is_brightest_in_its_cell_and_ends_at_its_reach() {
        let lamp = Lamp { light: Light::new(0.5).unwrap(), reach: Reach::default() };
        let lights = [0.0, 1.0, 2.0, 3.0, 3.9, 4.0, 9.0].map(|cells| lamp.light_at(cells));
        assert_eq!(lights[0], lamp.light);
        assert!(lights.windows(2).all(|pair| pair[0].in_256ths() >= pair[1].in_256ths()));
        assert_eq!(lights[5..], [Light::NONE; 2]);
    }
}
