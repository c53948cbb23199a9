//! The walk past what a ray may pass: doors that are ajar, shapes, glass, and holes.
//!
//! It stops at every solid cell and asks what that is; between two of them it is the walk that looks
//! for walls, and costs the same.

use super::{Crossing, Hit, Ray, Side, door, shape};
use crate::world::{Cell, TileId, TileKind, World};

/// What `ray` hits in `world`, where it starts in one cell and enters those `solid_cells`; it tells
/// `passed` what it passes, and passes no tile that `ends` it.
pub(super) fn cast(
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
            TileKind::Mask(_) | TileKind::Glass(_) => {
                if tile_before(world, ray, crossing) != Some(crossing.tile) {
                    passed(Hit::entering(ray, crossing.cell, crossing.side));
                }
            }
            TileKind::Wall(_) | TileKind::Mirror(_) | TileKind::Open | TileKind::Doorway(_) => {
                return Some(Hit::entering(ray, crossing.cell, crossing.side));
            }
        }
    }
    None
}

/// What the cell holds that `ray` leaves by a crossing.
fn tile_before(world: &World, ray: &Ray, crossing: Crossing) -> Option<TileId> {
    let back = |direction: f64| if direction > 0.0 { -1 } else { 1 };
    let (columns, rows) = match crossing.side {
        Side::X => (back(ray.direction().x), 0),
        Side::Y => (0, back(ray.direction().y)),
    };
    let (column, row) = (i64::from(crossing.cell.column), i64::from(crossing.cell.row));
    world.grid().tile(column + columns, row + rows)
}
