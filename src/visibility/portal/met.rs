//! The faces that rays meet, opaque or see-through, and their light.

use std::ops::Range;

use super::layers::Passed;
use super::line::Line;
use super::surroundings::Place;
use super::walk::BundleWalk;
use crate::cast::Side;
use crate::visibility::runs::Shown;
use crate::visibility::{Extent, Facing, Material, SeeThroughColumn, WallColumn};
use crate::world::{Light, Paint, Tile, TileKind};

/// An upright face, where a ray meets it.
pub(crate) struct Met {
    /// The kind of line that the face is on, or to which it is most nearly parallel.
    pub(crate) side: Side,
    pub(crate) facing: Facing,
    /// The approach of the ray to the face, in cells per unit of `t`.
    pub(crate) slope: f64,
    pub(crate) t: f64,
    /// The position along the face, from 0 at its left end to 1 at its right.
    pub(crate) u: f64,
    /// The cell from which the ray meets it.
    pub(crate) before: Place,
}

impl BundleWalk<'_> {
    /// The face at `line` where the ray of `column` meets it.
    #[inline]
    pub(crate) fn met_at(&self, line: &Line, column: u32) -> Met {
        let ray = self.ray(column);
        let t = self.memory.distances[column as usize];
        let &Line { side, ref face, before, .. } = line;
        let facing = Facing::Side(side);
        let slope = facing.slope(ray.direction());
        Met { side, facing, slope, t, u: face.u(&ray, t), before }
    }

    /// Shows a face of `place` in `rows`.
    #[inline]
    pub(crate) fn show_face(
        &mut self,
        column: u32,
        rows: Range<u32>,
        met: &Met,
        (paint, place): (Paint, Place),
        extent: Extent,
    ) {
        if rows.is_empty() {
            return;
        }
        self.list.runs.show(column, rows.clone(), Shown::Face(met.side));
        let light = self.light(place, met);
        let &Met { facing, slope, t, u, .. } = met;
        let wall = WallColumn { column, rows, facing, slope, t, u, light, material: paint, extent };
        self.list.walls.push(wall);
    }

    /// Records a see-through face of `place` in `rows`.
    pub(crate) fn pass(
        &mut self,
        column: u32,
        rows: Range<u32>,
        met: &Met,
        (material, place): (Material, Place),
        extent: Extent,
    ) {
        if rows.is_empty() {
            return;
        }
        let light = self.light(place, met);
        let &Met { facing, slope, t, u, .. } = met;
        self.memory.passed.push(column, Passed::SeeThrough(self.list.see_through.len()));
        let face = SeeThroughColumn { column, rows, facing, slope, t, u, light, material, extent };
        self.list.see_through.push(face);
    }

    /// The light on a face of `place`, seen from the cell before it: the tile's own light if it is solid and
    /// has one, else the light there.
    #[inline]
    fn light(&self, place: Place, met: &Met) -> Light {
        let scene = self.surroundings.scene;
        if !scene.plan.walls.faded {
            return Light::FULL;
        }
        let is_solid = |tile: &&Tile| !matches!(tile.kind, TileKind::Open | TileKind::Doorway(_));
        let tile = self.surroundings.tile(place);
        if let Some(own) = tile.filter(is_solid).and_then(|tile| tile.light) {
            return own;
        }
        let Some((before, _)) = met.before else { return Light::FULL };
        let is_door = tile.is_some_and(|tile| matches!(tile.kind, TileKind::Door(_)));
        match place {
            // A leaf has the same light everywhere, as has a shape, which is met in its own cell.
            Some((cell, _)) if cell != before && !is_door => {
                scene.world.face_light(cell, before).at(met.u)
            }
            _ => scene.world.light_in(before),
        }
    }
}
