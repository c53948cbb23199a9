//! Collision of a circle with what blocks: it is never inside anything, never passes through
//! anything, and slides along walls.
//!
//! The predicate [`is_clear`] says where the circle may be, and no position that fails it is ever
//! accepted. If rounding puts a contact slightly inside, the circle is moved back along its path to
//! a position that passes. So the circle is clear after a step because it was clear before. Moving
//! first and pushing out of walls afterwards was refused: it picks the wrong side of a wall at
//! speed, and jitters in corners.

mod outline;
mod place;
mod sweep;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::world::{Cell, Outline};
pub(crate) use place::{Place, Stature};
use sweep::{Path, first_contact};

/// The number of walls that a body may touch in one step. A corner has two; a body that touches
/// more is stuck between them, and stops.
const MOST_CONTACTS: usize = 4;

/// The radius of a circle that can stand in the middle of any open cell: above 0 and at most half a
/// cell, so that only the eight cells around its own are in reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Radius(f64);

impl Radius {
    /// A radius in cells; `None` outside the range.
    pub(crate) const fn new(cells: f64) -> Option<Self> {
        if cells > 0.0 && cells <= 0.5 { Some(Self(cells)) } else { None }
    }

    /// The radius in cells.
    pub(crate) const fn cells(self) -> f64 {
        self.0
    }
}

/// What may block a circle.
pub(crate) trait Obstacles {
    /// Whether a cell is solid. Cells outside the map are: nobody leaves the map.
    fn blocks(&self, column: i64, row: i64) -> bool;

    /// The shape in a cell that does not block, if there is one.
    fn outline(&self, cell: Cell) -> Option<Outline> {
        _ = cell;
        None
    }

    /// The middles of other circles of the same radius that block.
    fn circles(&self) -> &[DVec2] {
        &[]
    }

    /// Whether a cell touched by a circle around `center` does not block any more, because it gives
    /// way or because the circle has been lifted onto it.
    fn gives_way(&mut self, column: i64, row: i64, center: DVec2, radius: Radius) -> bool {
        _ = (column, row, center, radius);
        false
    }
}

/// The position of a body, in cells, and its velocity, in cells per second.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Body {
    pub(crate) position: DVec2,
    pub(crate) velocity: DVec2,
}

/// Moves a body by `displacement`, of any length, and along what blocks it. The body loses the part
/// of its velocity that points into what it touches.
pub(crate) fn slide<O: Obstacles>(
    obstacles: &mut O,
    body: Body,
    displacement: DVec2,
    radius: Radius,
) -> Body {
    let Body { mut position, mut velocity } = body;
    let mut remaining = displacement;
    let mut contacts = 0;
    while contacts < MOST_CONTACTS {
        let Some(path) = Path::new(position, remaining) else {
            return Body { position, velocity };
        };
        let Some(contact) = first_contact(obstacles, path, radius) else {
            let position = path.last_clear(obstacles, path.length(), radius);
            return Body { position, velocity };
        };
        position = contact.position;
        let gives_way = |(column, row)| obstacles.gives_way(column, row, position, radius);
        if contact.cell.is_some_and(gives_way) {
            remaining = contact.remaining;
            continue;
        }
        contacts += 1;
        remaining = without_inward(contact.remaining, contact.normal);
        velocity = without_inward(velocity, contact.normal);
    }
    Body { position, velocity: DVec2::ZERO }
}

/// Moves a circle by `displacement` up to the first contact. Returns its position, and whether there
/// was a contact.
pub(crate) fn fly<O: Obstacles>(
    obstacles: &O,
    position: DVec2,
    displacement: DVec2,
    radius: Radius,
) -> (DVec2, bool) {
    let Some(path) = Path::new(position, displacement) else { return (position, false) };
    match first_contact(obstacles, path, radius) {
        Some(contact) => (contact.position, true),
        None => (path.last_clear(obstacles, path.length(), radius), false),
    }
}

/// `vector` without its part against `normal`, a unit vector.
fn without_inward(vector: DVec2, normal: DVec2) -> DVec2 {
    vector - normal * vector.dot(normal).min(0.0)
}

/// Whether a circle around `center` overlaps nothing that blocks; it may touch. Cells are closed
/// squares.
pub(crate) fn is_clear<O: Obstacles>(obstacles: &O, center: DVec2, radius: Radius) -> bool {
    let least = 2.0 * radius.0;
    let is_apart = |other: &DVec2| other.distance_squared(center) >= least * least;
    obstacles.circles().iter().all(is_apart)
        && overlapped(center, radius).all(|(column, row)| {
            let stands_clear = |cell| {
                let outline = obstacles.outline(cell);
                outline.is_none_or(|outline| outline::is_clear_of(outline, cell, center, radius))
            };
            !obstacles.blocks(column, row) && cell_on_map(column, row).is_none_or(stands_clear)
        })
}

/// The columns and rows of the cells that a circle around `center` overlaps, row by row.
fn overlapped(center: DVec2, radius: Radius) -> impl Iterator<Item = (i64, i64)> {
    let along = |place: f64, index: i64| {
        let (before, after) = (place - index as f64, (index + 1) as f64 - place);
        index - i64::from(before < radius.0)..=index + i64::from(after < radius.0)
    };
    let (column, row) = cell_of(center);
    let columns = along(center.x, column);
    along(center.y, row)
        .flat_map(move |row| columns.clone().map(move |column| (column, row)))
        .filter(move |&(column, row)| !is_clear_of(center, column, row, radius))
}

/// Whether a circle around `center` overlaps `cell`, solid or not. Touching is not overlapping.
pub(crate) fn overlaps(center: DVec2, cell: Cell, radius: Radius) -> bool {
    !is_clear_of(center, i64::from(cell.column), i64::from(cell.row), radius)
}

fn is_clear_of(center: DVec2, column: i64, row: i64, Radius(radius): Radius) -> bool {
    square_distance(center, column, row) >= radius * radius
}

/// The squared distance from `point` to the nearest point of a cell.
fn square_distance(point: DVec2, column: i64, row: i64) -> f64 {
    let low = DVec2::new(column as f64, row as f64);
    (low - point).max(point - (low + DVec2::ONE)).max(DVec2::ZERO).length_squared()
}

/// The cell at a column and a row; `None` where one of them is negative.
fn cell_on_map(column: i64, row: i64) -> Option<Cell> {
    Some(Cell { column: u32::try_from(column).ok()?, row: u32::try_from(row).ok()? })
}

fn cell_of(point: DVec2) -> (i64, i64) {
    (point.x.floor() as i64, point.y.floor() as i64)
}

#[cfg(test)]
mod tests;
