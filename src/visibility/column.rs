//! Columns: the ray hit of each column of pixels.

use crate::cast::{Hit, Side};

/// The ray hit of one column of pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// The hit; `None` if the ray left the map.
    pub hit: Option<Hit>,
    /// The distance from the camera plane to the end of the ray at a wall or at the edge of the map, in cells.
    pub distance: f64,
}

/// The kind of surface that a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// The ceiling.
    Ceiling,
    /// The sky.
    Sky,
    /// A wall's west or east side.
    WallX,
    /// A wall's north or south side.
    WallY,
    /// The floor.
    Floor,
    /// A thing in front of the other surfaces.
    Thing,
}

impl Column {
    /// A column whose ray has not been followed yet.
    pub(crate) const UNKNOWN: Self = Self { hit: None, distance: 0.0 };
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
