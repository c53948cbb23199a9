//! Casting through doors that are ajar, shapes, glass, and masks.
//!
//! The traversal stops at every solid cell, and this module decides whether the ray goes on.
//! Between solid cells the cost is that of casting at walls.

use super::{Crossing, Hit, Ray, Side, door, shape};
use crate::world::{Cell, TileId, TileKind, World};

/// The hit of `ray` in `world`. The ray starts in the cell `start` and enters `solid_cells`; the
/// transparent faces that it enters are passed to `passed`. A tile that `ends` the ray is a hit.
pub(crate) fn cast(
    start: Option<(Cell, TileId)>,
    solid_cells: impl Iterator<Item = Crossing>,
    world: &World,
    ray: &Ray,
    ends: impl Fn(TileId) -> bool,
    mut passed: impl FnMut(Hit),
) -> Option<Hit> {
    let grid = world.grid();
    let leaf_in = |cell| door::meet(grid, ray, cell, world.opening(cell));
    let start = start.and_then(|(cell, tile)| match world.tile(tile).kind {
        TileKind::Door(_) => leaf_in(cell),
        TileKind::Shape(it) => shape::meet(ray, cell, it.outline),
        _ => None,
    });
    if start.is_some() {
        return start;
    }
    for crossing in solid_cells {
        if ends(crossing.tile) {
            return Some(Hit::entering(ray, crossing.cell, crossing.side));
        }
        match world.tile(crossing.tile).kind {
            TileKind::Door(_) => {
                if let Some(hit) = leaf_in(crossing.cell) {
                    return Some(hit);
                }
            }
            TileKind::Shape(it) => {
                if let Some(hit) = shape::meet(ray, crossing.cell, it.outline) {
                    return Some(hit);
                }
            }
            TileKind::Mask(_) | TileKind::Glass(_)
                if tile_before(world, ray, crossing) == Some(crossing.tile) => {}
            TileKind::Glass(glass) if glass.is_opaque() => {
                return Some(Hit::entering(ray, crossing.cell, crossing.side));
            }
            TileKind::Mask(_) | TileKind::Glass(_) => {
                passed(Hit::entering(ray, crossing.cell, crossing.side));
            }
            TileKind::Wall(_) | TileKind::Mirror(_) | TileKind::Open | TileKind::Doorway(_) => {
                return Some(Hit::entering(ray, crossing.cell, crossing.side));
            }
        }
    }
    None
}

/// The tile of the cell that `ray` leaves by a crossing.
fn tile_before(world: &World, ray: &Ray, crossing: Crossing) -> Option<TileId> {
    let back = |direction: f64| if direction > 0.0 { -1 } else { 1 };
    let (columns, rows) = match crossing.side {
        Side::X => (back(ray.direction().x), 0),
        Side::Y => (0, back(ray.direction().y)),
    };
    let (column, row) = (i64::from(crossing.cell.column), i64::from(crossing.cell.row));
    world.grid().tile(column + columns, row + rows)
}
