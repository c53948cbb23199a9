//! The faces that rays meet, opaque or see-through, and their light; and the objects that stand in a cell
//! without filling it: the leaves of doors, and shapes.

use std::ops::Range;

use super::bundle::Bundle;
use super::layers::{Passed, RayPart};
use super::line::Line;
use super::tile_gaps::Place;
use super::walk::BundleWalk;
use crate::cast::{Hit, Passage, Side};
use crate::visibility::face_column::place_before;
use crate::visibility::runs::{FlatSurface, ImageId, Part, Shown};
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

impl BundleWalk<'_> {
    /// Handles the object in the gap of `bundle`. The rows above it remain open.
    pub(crate) fn meet_standing(&mut self, bundle: &Bundle) {
        let surroundings = self.surroundings;
        let Some(tile) = surroundings.tile(bundle.place) else { return };
        for column in bundle.columns.clone() {
            let clip = bundle.clip(column);
            self.meet_in(bundle, column, tile);
            if self.memory.clips[clip].rows.is_empty() {
                self.end(bundle, column);
            }
        }
    }

    /// Handles the object that is `tile` for the ray of `column`.
    fn meet_in(&mut self, bundle: &Bundle, column: u32, tile: &Tile) {
        let (kind, Some((cell, _))) = (tile.kind, bundle.place) else { return };
        let (world, clip) = (self.surroundings.scene.world, bundle.clip(column));
        let Passage { hit, end } = bundle.course.standing(&self.ray(column), world, cell, kind);
        if let Some(hit) = hit {
            // The ray after a reflection in this cell starts at the mirror: an earlier hit is not
            // on its path.
            if bundle.image != ImageId::NONE && hit.t < self.memory.clips[clip].from {
                return;
            }
            self.meet_side(bundle, column, tile, hit);
        }
        if let Some(end) = end {
            self.look_down_at(bundle, column, tile.top_of_what_stands(), end);
        }
    }

    /// Shows the face of a leaf or a shape at `hit`.
    fn meet_side(&mut self, bundle: &Bundle, column: u32, tile: &Tile, hit: Hit) {
        let kind = tile.kind;
        let (bottom, top) = (tile.heights.floor(), tile.top_of_what_stands());
        self.memory.distances[column as usize] = hit.t;
        self.close(&bundle.part(column..column + 1));
        let real = bundle.course.on_map(&self.ray(column));
        let (paint, facing) = match kind {
            TileKind::Door(door) => (door.leaf, Facing::Side(hit.side)),
            TileKind::Shape(it) => (it.paint, Facing::of_shape(it.outline, real.at(hit.t), &hit)),
            _ => return,
        };
        let before = match kind {
            // The cell in front of a leaf's cell, on the side from which the ray comes.
            TileKind::Door(_) => {
                place_before(self.surroundings.scene.world.grid(), real.direction(), &hit)
            }
            // A shape stands in a cell of its own.
            _ => bundle.place,
        };
        let slope = facing.slope(real.direction());
        let met = Met { side: hit.side, facing, slope, t: hit.t, u: hit.u, before };
        let clip = bundle.clip(column);
        let rows = self.rows_between(&self.memory.clips[clip].rows, bottom..top, hit.t);
        let above = self.surroundings.scene.projection.row_of_height(top, hit.t);
        let end = &mut self.memory.clips[clip].rows.end;
        *end = above.min(*end);
        let extent = Extent::Heights { bottom, top };
        self.show_face(column, rows, &met, (paint, bundle.place), extent);
        if bundle.image == ImageId::NONE {
            self.list.columns[column as usize].hit = Some(hit);
        }
    }

    /// Shows the top of a pillar, which extends to `end`, if the eye is above it.
    fn look_down_at(&mut self, bundle: &Bundle, column: u32, top: f64, end: f64) {
        let projection = self.surroundings.scene.projection;
        let index = bundle.clip(column);
        let clip = &self.memory.clips[index];
        let is_seen = projection.eye() > top && clip.from <= end;
        if !is_seen || clip.rows.is_empty() {
            return;
        }
        // What stands on the top is in front of it.
        if self.surroundings.has_things {
            let part = RayPart::new(bundle, column, clip, end, Some(top));
            self.memory.passed.push(column, Passed::Billboards(part));
        }
        let clip = &mut self.memory.clips[index];
        clip.from = end;
        let tile = bundle.place.map(|(_, tile)| tile);
        let surface = FlatSurface { tile, part: Part::Top, image: bundle.image };
        let Range { start, end: bottom } = clip.rows;
        let row = projection.row_of_height(top, end).clamp(start, bottom);
        clip.rows = start..row;
        self.list.runs.show(column, row..bottom, Shown::Plane(surface));
    }
}
