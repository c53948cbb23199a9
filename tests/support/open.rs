//! An independent test whether a body is inside anything, based on the tiles and things of a world.

use cellcaster::world::{Anchor, Ceiling, Cell, Gap, ShapeHeight, TileKind, World};
use glam::DVec2;

const RADIUS: f64 = 0.25;
/// The player's smallest height.
const DUCKING: f64 = 0.5;

/// Returns whether the whole player, at the smallest height, fits into gaps of the cells around the
/// position.
pub(crate) fn is_in_the_open(world: &World, position: DVec2, feet: f64) -> bool {
    is_open_for(world, position, feet, DUCKING)
}

/// Returns whether a body of this height fits into gaps of the cells around the position.
pub(crate) fn is_open_for(world: &World, position: DVec2, feet: f64, height: f64) -> bool {
    let (column, row) = (position.x.floor() as i64, position.y.floor() as i64);
    let around =
        (row - 1..=row + 1).flat_map(|row| (column - 1..=column + 1).map(move |c| (c, row)));
    around
        .filter(|&(column, row)| {
            let corner = DVec2::new(column as f64, row as f64);
            position.distance_squared(position.clamp(corner, corner + 1.0)) < RADIUS * RADIUS
        })
        .all(|(column, row)| {
            let holds = |gap: &Gap| gap.bottom <= feet && feet <= gap.top - height;
            gaps(world, column, row).iter().any(holds)
                && is_beside_shape(world, column, row, position, feet)
        })
}

/// The gaps of a cell without its things; empty off the map.
fn gaps(world: &World, column: i64, row: i64) -> Vec<Gap> {
    use TileKind::{Door, Glass, Mask};
    let Some(tile) = world.grid().tile(column, row).map(|id| world.tile(id)) else {
        return Vec::new();
    };
    let is_filled = matches!(tile.kind, Door(_) | Mask(_) | Glass(_));
    let stands_in = |gap: &Gap| is_filled && gap.bottom < tile.heights.ceiling();
    let gaps = tile.gaps().filter(|gap| !stands_in(gap));
    let things = world.things_in(Cell { column: column as u32, row: row as u32 }).iter();
    let mut sprites = things.map(|thing| world.sprite(thing.sprite));
    let Some(sprite) = sprites.find(|sprite| sprite.blocks) else { return gaps.collect() };
    let (low, high) = match sprite.anchor {
        Anchor::Floor => (tile.heights.floor(), tile.heights.floor() + sprite.height.cells()),
        Anchor::Ceiling => (tile.heights.ceiling() - sprite.height.cells(), tile.heights.ceiling()),
    };
    gaps.flat_map(|gap| {
        [Gap { top: gap.top.min(low), ..gap }, Gap { bottom: gap.bottom.max(high), ..gap }]
    })
    .collect()
}

/// Returns whether the player is beside or above the shape in a cell. `true` if there is no shape.
fn is_beside_shape(world: &World, column: i64, row: i64, position: DVec2, feet: f64) -> bool {
    let Some(tile) = world.grid().tile(column, row).map(|id| world.tile(id)) else { return true };
    let TileKind::Shape(shape) = tile.kind else { return true };
    let cell = Cell { column: column as u32, row: row as u32 };
    let height = shape.height.map_or(f64::INFINITY, ShapeHeight::cells);
    let top = tile.heights.floor() + height;
    let top = match tile.ceiling {
        Ceiling::Sky if shape.height.is_some() => top,
        _ => top.min(tile.heights.ceiling()),
    };
    feet >= top || shape.outline.distance(cell, position) >= RADIUS
}
