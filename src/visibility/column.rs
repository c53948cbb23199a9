//! Columns: the hit of the ray of each column of pixels.

use std::ops::Range;

use crate::cast::{Hit, Side};

/// The hit of the ray of one column of pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// The hit; `None` if the ray left the map.
    pub hit: Option<Hit>,
    /// The distance from the camera plane to the end of the ray, in cells: to the wall, or to the
    /// edge of the map.
    pub distance: f64,
    /// The rows of pixels between ceiling and floor at that distance: the wall or, beyond the edge
    /// of the map, sky and ground.
    pub rows: Range<u32>,
}

/// The kind of surface that a pixel shows.
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
    /// A thing in front of the others.
    Thing,
}

impl Column {
    /// A column whose ray has not been cast yet.
    pub(crate) const UNKNOWN: Self = Self { hit: None, distance: 0.0, rows: 0..0 };

    /// The surface that the pixel in `row` shows of a level scene whose ground begins in row
    /// `ground`.
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

    /// The number of rows, from the top, that show the ceiling if the ground begins in row
    /// `ground`.
    pub(crate) fn rows_of_ceiling(&self, ground: u32) -> u32 {
        self.rows.start.min(ground)
    }

    /// The number of rows, from the bottom of a frame of `height` rows, that show the floor.
    pub(crate) fn rows_of_floor(&self, ground: u32, height: u32) -> u32 {
        height
            - match self.hit {
                Some(_) => self.rows.end.max(ground),
                None => ground,
            }
    }
}

impl Surface {
    /// The surface of a wall's side.
    pub(crate) fn of_wall(side: Side) -> Self {
        match side {
            Side::X => Self::WallX,
            Side::Y => Self::WallY,
        }
    }
}
