//! The ground of a plane: the tile and the light of a cell.

use glam::DVec2;

use super::{Plane, PlaneKind};
use crate::visibility::Scene;
use crate::world::{Cell, Light, TileId, TileKind};

impl Plane<'_> {
    /// The tile of the cell with this north-west corner, and the light that lamps add to it; `None`
    /// off the map.
    pub(crate) fn ground_in(&self, corner: DVec2) -> Option<(TileId, Light)> {
        let world = self.scene.world;
        // Casts saturate, and convert NaN to 0.
        let is_a_place = corner.is_finite();
        let (column, row) = (corner.x as i64, corner.y as i64);
        let tile = is_a_place.then(|| world.grid().tile(column, row)).flatten()?;
        Some((tile, world.lamplight_in(Cell { column: column as u32, row: row as u32 })))
    }

    /// The same, where walls are blended over planes: the centre of a pixel at the foot of a wall may be inside
    /// the wall. The pixel that is nearer to the eye by a row then tells the ground.
    pub(crate) fn ground_before_walls(
        &self,
        corner: DVec2,
        (row, x): (u32, usize),
    ) -> Option<(TileId, Light)> {
        let Scene { world, projection, .. } = self.scene;
        let ground = self.ground_in(corner);
        let is_wall = |(tile, _): (TileId, Light)| {
            matches!(world.tiles()[usize::from(tile.0)].kind, TileKind::Wall(_))
        };
        if !ground.is_some_and(is_wall) {
            return ground;
        }
        let nearer = match self.kind {
            PlaneKind::Floor => row + 1,
            PlaneKind::Ceiling => row.saturating_sub(1),
        };
        let point = projection.mapping(nearer).just_before(projection.origin()).point(x);
        self.ground_in(point.floor())
    }
}
