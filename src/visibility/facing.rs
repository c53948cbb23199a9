//! Facing: the direction of an upright face, and the cell from which it is seen.

use glam::DVec2;

use crate::cast::{Hit, Side};
use crate::world::{Cell, Grid, Outline, TileId};

/// The direction of a face.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Facing {
    /// Along an axis, perpendicular to a side.
    Side(Side),
    /// Along a vector of length 1, in either direction.
    Normal(DVec2),
}

impl Facing {
    /// The facing of a shape that is hit at `point`.
    pub(crate) fn of_shape(outline: Outline, point: DVec2, hit: &Hit) -> Self {
        Self::Normal(match outline {
            Outline::Line(line) => line.stretch().perp().normalize(),
            Outline::Pillar(_) => (point - hit.cell.center()).normalize_or_zero(),
        })
    }

    /// The approach of a ray along `direction` to the face, in cells per unit of its `t`.
    #[inline]
    pub(crate) fn slope(self, direction: DVec2) -> f64 {
        match self {
            Self::Side(Side::X) => direction.x,
            Self::Side(Side::Y) => direction.y,
            Self::Normal(normal) => normal.dot(direction),
        }
    }
}

/// The column and the row of the cell from which a ray along `direction` sees the side of `hit`.
pub(crate) fn cell_before(direction: DVec2, hit: &Hit) -> [i64; 2] {
    let back = |direction: f64| if direction > 0.0 { -1 } else { 1 };
    let (column, row) = (i64::from(hit.cell.column), i64::from(hit.cell.row));
    match hit.side {
        Side::X => [column + back(direction.x), row],
        Side::Y => [column, row + back(direction.y)],
    }
}

/// That cell on the map and its tile; `None` off the map.
pub(crate) fn place_before(grid: &Grid, direction: DVec2, hit: &Hit) -> Option<(Cell, TileId)> {
    let [column, row] = cell_before(direction, hit);
    let tile = grid.tile(column, row)?;
    Some((Cell { column: column as u32, row: row as u32 }, tile))
}
