//! Columns: what the ray of each column of pixels met.

use std::ops::Range;

use crate::cast::{Hit, Side};

/// What the ray of one column of pixels met.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// What it hit, or `None` where it left the map.
    pub hit: Option<Hit>,
    /// How far it got, in cells from the camera plane: to the wall, or to the edge of the map.
    pub distance: f64,
    /// The rows of pixels between ceiling and floor at that distance: the wall or, beyond the edge
    /// of the map, the sky and the ground.
    pub rows: Range<u32>,
}

/// What a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// The ceiling.
    Ceiling,
    /// The sky beyond the edge of the map.
    Sky,
    /// A wall's west or east side.
    WallX,
    /// A wall's north or south side.
    WallY,
    /// The floor.
    Floor,
    /// A thing before all that.
    Thing,
}

impl Column {
    /// A column of which nothing is known yet.
    pub(crate) const UNKNOWN: Self = Self { hit: None, distance: 0.0, rows: 0..0 };

    /// What the pixel in `row` shows of a level scene, where the ground begins in row `ground`.
    pub(crate) fn surface(&self, row: u32, ground: u32) -> Surface {
        if row < self.rows.start {
            return Surface::Ceiling;
        }
        if row >= self.rows.end {
            return Surface::Floor;
        }
        match &self.hit {
            Some(hit) => Surface::of_wall(hit.side),
            None if row < ground => Surface::Sky,
            None => Surface::Floor,
        }
    }

    /// How many rows, from the top, show the ceiling, where the ground begins in row `ground`.
    pub(crate) fn rows_of_ceiling(&self, ground: u32) -> u32 {
        self.rows.start.min(ground)
    }

    /// How many rows, from the bottom of a frame `height` pixels high, show the floor.
    pub(crate) fn rows_of_floor(&self, ground: u32, height: u32) -> u32 {
        height
            - match self.hit {
                Some(_) => self.rows.end.max(ground),
                None => ground,
            }
    }
}

impl Surface {
    /// The side of a wall.
    pub(crate) fn of_wall(side: Side) -> Self {
        match side {
            Side::X => Self::WallX,
            Side::Y => Self::WallY,
        }
    }
}
