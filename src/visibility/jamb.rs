//! Jambs: what a wall looks like that a door is set into.

use super::Projection;
use crate::cast::{Hit, Side};
use crate::world::{Cell, Paint, World};

/// How the face of a wall looks that `hit` is on, where it faces a door's cell; `None` elsewhere.
pub(crate) fn jamb(world: &World, projection: &Projection, hit: &Hit) -> Option<Paint> {
    world.door(cell_before(projection, hit)?).map(|door| door.jamb)
}

/// The cell that a face looks into, by where it is seen from; `None` off the map's north or west.
fn cell_before(projection: &Projection, hit: &Hit) -> Option<Cell> {
    let Cell { column, row } = hit.cell;
    let viewer = projection.origin();
    let before = |index: u32, viewer: f64| {
        if viewer <= f64::from(index) { index.checked_sub(1) } else { Some(index + 1) }
    };
    Some(match hit.side {
        Side::X => Cell { column: before(column, viewer.x)?, row },
        Side::Y => Cell { column, row: before(row, viewer.y)? },
    })
}
