//! The faces that a ray meets, opaque or see-through, and their light.

use std::ops::Range;

use super::layers::Passed;
use super::walk::{ColumnWalk, Place, PortalRay};
use crate::cast::{Crossed, Side};
use crate::visibility::runs::Shown;
use crate::visibility::{Extent, Facing, Material, SeeThroughColumn, WallColumn};
use crate::world::{Light, Paint, Tile, TileKind};

/// An upright face that a ray meets.
pub(super) struct Met {
    /// The kind of line that the face is on, or to which it is most nearly parallel.
    pub(super) side: Side,
    pub(super) facing: Facing,
    /// The approach of the ray to the face, in cells per unit of `t`.
    pub(super) slope: f64,
    pub(super) t: f64,
    pub(super) u: AlongFace,
    /// The cell from which the ray meets it.
    pub(super) before: Place,
}

/// The position along a face at which a ray meets it.
pub(super) enum AlongFace {
    Known(f64),
    /// Computed on demand from the line that the ray has just crossed: most lines have no face in
    /// view.
    AtLine(Crossed),
}

impl ColumnWalk<'_> {
    /// Shows a face in `rows`.
    pub(super) fn show_face(
        &mut self,
        rows: Range<u32>,
        met: &Met,
        u: f64,
        (paint, light): (Paint, Light),
        extent: Extent,
    ) {
        if rows.is_empty() {
            return;
        }
        self.list.runs.show(rows.clone(), Shown::Face(met.side));
        let &Met { facing, slope, t, .. } = met;
        let column = self.column;
        let wall = WallColumn { column, rows, facing, slope, t, u, paint, light, extent };
        self.list.walls.push(wall);
    }

    /// Records a see-through face in `rows`.
    pub(super) fn pass(
        &mut self,
        ray: &PortalRay,
        rows: Range<u32>,
        met: &Met,
        place: Place,
        material: Material,
        extent: Extent,
    ) {
        if rows.is_empty() {
            return;
        }
        let u = met.u(ray);
        let light = self.light(place, met, u);
        let &Met { facing, slope, t, .. } = met;
        self.memory.passed.push(Passed::SeeThrough(self.list.see_through.len()));
        let column = self.column;
        let face = SeeThroughColumn { column, rows, facing, slope, t, u, light, material, extent };
        self.list.see_through.push(face);
    }

    /// The light at `u` on a face of `place`, seen from the cell before it: the tile's own light if
    /// it is solid and has one, else the light there.
    pub(super) fn light(&self, place: Place, met: &Met, u: f64) -> Light {
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
                scene.world.face_light(cell, before).at(u)
            }
            _ => scene.world.light_in(before),
        }
    }
}

impl Met {
    /// The position along the face at which `ray` meets it, from 0 at its left end to 1 at its
    /// right.
    pub(super) fn u(&self, ray: &PortalRay) -> f64 {
        match &self.u {
            AlongFace::Known(u) => *u,
            AlongFace::AtLine(crossed) => ray.walk.along_face(crossed),
        }
    }
}
