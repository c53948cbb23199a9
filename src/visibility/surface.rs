//! Surfaces: what a pixel shows.

use crate::cast::Side;

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

impl Surface {
    /// The surface of a wall's side.
    pub(crate) fn of_wall(side: Side) -> Self {
        match side {
            Side::X => Self::WallX,
            Side::Y => Self::WallY,
        }
    }
}
