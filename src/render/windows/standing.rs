//! What stands in a cell and does not fill it: the leaves of doors, and shapes.

use std::ops::Range;

use glam::DVec2;

use super::faces::{Facing, Stretch};
use super::look::{Branch, Look, Met, Place};
use super::notes::Shown;
use super::{Part, Piece, Reflection};
use crate::cast::{Hit, Passage, Ray, Side};
use crate::world::{Cell, Outline, Tile, TileKind};

impl Look<'_> {
    /// Meets what stands in the slot that `branch` is in. What is above it, if anything, stays open.
    pub(super) fn meet_standing(&mut self, branch: &mut Branch) {
        let (Some((cell, _)), Some(tile)) = (branch.place, self.tile(branch.place)) else { return };
        let kind = tile.kind;
        let Passage { hit, end } = branch.walk.standing(self.scene.world, cell, kind);
        if let Some(hit) = hit {
            // A ray that was reflected in this cell may have been nowhere near before that.
            if branch.reflection != Reflection::NONE && hit.t < branch.from {
                return;
            }
            self.meet_side(branch, kind, tile, hit);
        }
        if let Some(end) = end {
            self.look_down_at(branch, tile.top_of_what_stands(), end);
        }
    }

    /// Meets a leaf or a shape where `hit` says.
    fn meet_side(&mut self, branch: &mut Branch, kind: TileKind, tile: &Tile, hit: Hit) {
        let (bottom, top) = (tile.heights.floor(), tile.top_of_what_stands());
        self.lay(branch, hit.t);
        let ray = branch.walk.real_ray();
        let (paint, facing) = match kind {
            TileKind::Door(door) => (door.leaf, Facing::Side(hit.side)),
            TileKind::Shape(it) => (it.paint, Facing::Normal(normal(it.outline, &ray, &hit))),
            _ => return,
        };
        let before = match kind {
            TileKind::Door(_) => self.place_before(&ray, &hit),
            // It stands in a cell of its own.
            _ => branch.place,
        };
        let slope = match facing {
            Facing::Side(Side::X) => ray.direction().x,
            Facing::Side(Side::Y) => ray.direction().y,
            Facing::Normal(normal) => normal.dot(ray.direction()),
        };
        let met = Met { side: hit.side, facing, slope, t: hit.t, u: hit.u, before };
        let stretch = Stretch { bottom, top };
        let rows = self.scene.rows_between(&branch.window, stretch, hit.t);
        let above = self.scene.projection.row_of_height(top, hit.t);
        branch.window.end = branch.window.end.min(above);
        let light = self.light(branch.place, &met);
        self.face(rows, &met, paint, light, stretch);
        if branch.reflection == Reflection::NONE {
            self.hit = Some(hit);
            self.distance = self.distance.max(hit.t);
        }
    }

    /// Shows the top of a pillar, which ends at `end`, to an eye that is above it.
    fn look_down_at(&mut self, branch: &mut Branch, top: f64, end: f64) {
        let is_seen = self.scene.projection.eye() > top && branch.from <= end;
        if !is_seen || branch.window.is_empty() {
            return;
        }
        let tile = branch.place.map(|(_, tile)| tile);
        let piece = Piece { tile, part: Part::Top, reflection: branch.reflection };
        let Range { start, end: bottom } = branch.window;
        let row = self.scene.projection.row_of_height(top, end).clamp(start, bottom);
        self.notes.show(row..bottom, Shown::Plane(piece));
        branch.window = start..row;
    }

    /// The cell before the one of a leaf, on the side that `ray` comes from.
    fn place_before(&self, ray: &Ray, hit: &Hit) -> Place {
        let back = |direction: f64| if direction > 0.0 { -1 } else { 1 };
        let (columns, rows) = match hit.side {
            Side::X => (back(ray.direction().x), 0),
            Side::Y => (0, back(ray.direction().y)),
        };
        let (column, row) = (i64::from(hit.cell.column) + columns, i64::from(hit.cell.row) + rows);
        let tile = self.scene.world.grid().tile(column, row)?;
        Some((Cell { column: column as u32, row: row as u32 }, tile))
    }
}

/// Which way a shape faces where `ray` hit it, or the opposite way: a vector of length 1.
fn normal(outline: Outline, ray: &Ray, hit: &Hit) -> DVec2 {
    match outline {
        Outline::Line(line) => line.stretch().perp().normalize(),
        Outline::Pillar(_) => (ray.at(hit.t) - hit.cell.center()).normalize_or_zero(),
    }
}
