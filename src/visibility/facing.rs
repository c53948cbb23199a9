//! Facing: which way an upright face looks, and from where it is seen.

use glam::DVec2;

use crate::cast::{Hit, Side};
use crate::world::Outline;

/// Which way a face looks.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Facing {
    /// Along an axis.
    Side(Side),
    /// Along a vector of length 1, or the opposite way.
    Normal(DVec2),
}

impl Facing {
    /// That of a shape which is hit at `point`.
    pub(super) fn of_shape(outline: Outline, point: DVec2, hit: &Hit) -> Self {
        Self::Normal(match outline {
            Outline::Line(line) => line.stretch().perp().normalize(),
            Outline::Pillar(_) => (point - hit.cell.center()).normalize_or_zero(),
        })
    }

    /// How many cells a ray along `direction` comes nearer to the face for each unit of its `t`.
    #[inline]
    pub(super) fn slope(self, direction: DVec2) -> f64 {
        match self {
            Self::Side(Side::X) => direction.x,
            Self::Side(Side::Y) => direction.y,
            Self::Normal(normal) => normal.dot(direction),
        }
    }
}

/// The column and the row of the cell from which a ray along `direction` sees the side that `hit` is on.
pub(super) fn cell_before(direction: DVec2, hit: &Hit) -> [i64; 2] {
    let back = |direction: f64| if direction > 0.0 { -1 } else { 1 };
    let (column, row) = (i64::from(hit.cell.column), i64::from(hit.cell.row));
    match hit.side {
        Side::X => [column + back(direction.x), row],
        Side::Y => [column, row + back(direction.y)],
    }
}
