//! Remarks about unusual positions of a camera.
//!
//! A camera may be anywhere, and its picture is drawn. But a position inside a wall is probably a
//! mistake, and is therefore reported.

use crate::world::{Camera, Cell, TileKind, World};

/// A sentence about a `camera` that is off the map or inside a solid cell; `None` elsewhere.
pub(crate) fn camera_remark(world: &World, camera: &Camera) -> Option<String> {
    let (grid, position) = (world.grid(), camera.position());
    let is_on_map = (0.0..f64::from(grid.width())).contains(&position.x)
        && (0.0..f64::from(grid.height())).contains(&position.y);
    if !is_on_map {
        let (columns, rows) = (grid.width(), grid.height());
        return Some(format!("the camera is off the map, which has {columns}×{rows} cells"));
    }
    let cell = Cell::at(position);
    let tile = world.tile_in(cell)?;
    let (eye, floor, ceiling) = (camera.eye(), tile.heights.floor(), tile.heights.ceiling());
    if tile.gaps().any(|gap| gap.holds(eye)) {
        return None;
    }
    Some(if matches!(tile.kind, TileKind::Wall(_) | TileKind::Mirror(_)) {
        "the camera is inside a wall".to_owned()
    } else if eye < floor {
        format!("the camera is below the floor: the eye at a height of {eye}, the floor at {floor}")
    } else {
        format!(
            "the camera is inside what hangs overhead: the eye at a height of {eye}, the ceiling at {ceiling}"
        )
    })
}
