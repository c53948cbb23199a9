//! Cameras and distances that several tests need.
#![allow(dead_code, reason = "every test file uses its own share of this")]

use cellcaster::world::{Camera, FieldOfView, Heading, TileKind, World};
use glam::DVec2;

/// The camera at a position, with a heading and a field of view in degrees.
pub(crate) fn camera(position: impl Into<DVec2>, degrees: f64, field_of_view: f64) -> Camera {
    let heading = Heading::from_degrees(degrees).unwrap();
    let field_of_view = FieldOfView::from_degrees(field_of_view).unwrap();
    Camera::new(position.into(), heading, field_of_view).unwrap()
}

/// The distance from `point` to the nearest cell around it that a wall fills. Pillars and other
/// shapes do not count, because they leave room in their cells.
pub(crate) fn clearance(world: &World, point: DVec2) -> f64 {
    let (column, row) = (point.x as i64, point.y as i64);
    let around =
        (row - 1..=row + 1).flat_map(|row| (column - 1..=column + 1).map(move |c| (c, row)));
    let grid = world.grid();
    let fills = |column, row| {
        let shape = grid.tile(column, row).map(|tile| world.tile(tile).kind);
        grid.is_solid(column, row) && !matches!(shape, Some(TileKind::Shape(_)))
    };
    around
        .filter(|&(column, row)| fills(column, row))
        .map(|(column, row)| {
            let corner = DVec2::new(column as f64, row as f64);
            point.distance(point.clamp(corner, corner + 1.0))
        })
        .fold(f64::INFINITY, f64::min)
}
