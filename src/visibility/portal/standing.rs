//! Objects that stand in a cell without filling it: the leaves of doors, and shapes.

use std::ops::Range;

use super::met::{AlongFace, Met};
use super::walk::{ColumnWalk, Place, PortalRay};
use crate::cast::{Hit, Passage, Ray};
use crate::visibility::facing::cell_before;
use crate::visibility::runs::{FlatSurface, ImageId, Part, Shown};
use crate::visibility::{Extent, Facing};
use crate::world::{Cell, Tile, TileKind};

impl ColumnWalk<'_> {
    /// Handles the object in the gap of `ray`. The rows above it remain open.
    pub(super) fn meet_standing(&mut self, ray: &mut PortalRay) {
        let surroundings = self.surroundings;
        let (Some((cell, _)), Some(tile)) = (ray.place, surroundings.tile(ray.place)) else {
            return;
        };
        let kind = tile.kind;
        let Passage { hit, end } = ray.walk.standing(surroundings.scene.world, cell, kind);
        if let Some(hit) = hit {
            // The ray after a reflection in this cell starts at the mirror: an earlier hit is not
            // on its path.
            if ray.image != ImageId::NONE && hit.t < ray.from {
                return;
            }
            self.meet_side(ray, kind, tile, hit);
        }
        if let Some(end) = end {
            self.look_down_at(ray, tile.top_of_what_stands(), end);
        }
    }

    /// Shows the face of a leaf or a shape at `hit`.
    fn meet_side(&mut self, ray: &mut PortalRay, kind: TileKind, tile: &Tile, hit: Hit) {
        let (bottom, top) = (tile.heights.floor(), tile.top_of_what_stands());
        self.close(ray, hit.t);
        let real = ray.walk.ray_on_map();
        let (paint, facing) = match kind {
            TileKind::Door(door) => (door.leaf, Facing::Side(hit.side)),
            TileKind::Shape(it) => (it.paint, Facing::of_shape(it.outline, real.at(hit.t), &hit)),
            _ => return,
        };
        let before = match kind {
            TileKind::Door(_) => self.place_before(&real, &hit),
            // A shape stands in a cell of its own.
            _ => ray.place,
        };
        let slope = facing.slope(real.direction());
        let u = AlongFace::Known(hit.u);
        let met = Met { side: hit.side, facing, slope, t: hit.t, u, before };
        let rows = self.rows_between(&ray.rows, bottom..top, hit.t);
        let above = self.surroundings.scene.projection.row_of_height(top, hit.t);
        ray.rows.end = ray.rows.end.min(above);
        let light = self.light(ray.place, &met, hit.u);
        self.show_face(rows, &met, hit.u, (paint, light), Extent::Heights { bottom, top });
        if ray.image == ImageId::NONE {
            self.hit = Some(hit);
        }
    }

    /// Shows the top of a pillar, which extends to `end`, if the eye is above it.
    fn look_down_at(&mut self, ray: &mut PortalRay, top: f64, end: f64) {
        let projection = self.surroundings.scene.projection;
        let is_seen = projection.eye() > top && ray.from <= end;
        if !is_seen || ray.rows.is_empty() {
            return;
        }
        // What stands on the top is in front of it.
        self.keep_part(ray, end, Some(top));
        ray.from = end;
        let tile = ray.place.map(|(_, tile)| tile);
        let surface = FlatSurface { tile, part: Part::Top, image: ray.image };
        let Range { start, end: bottom } = ray.rows;
        let row = projection.row_of_height(top, end).clamp(start, bottom);
        self.list.runs.show(row..bottom, Shown::Plane(surface));
        ray.rows = start..row;
    }

    /// The cell in front of a leaf's cell, on the side from which `ray` comes.
    fn place_before(&self, ray: &Ray, hit: &Hit) -> Place {
        let [column, row] = cell_before(ray.direction(), hit);
        let tile = self.surroundings.scene.world.grid().tile(column, row)?;
        Some((Cell { column: column as u32, row: row as u32 }, tile))
    }
}
