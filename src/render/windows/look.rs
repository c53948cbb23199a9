//! The first pass: a column of pixels, and its ray through the gaps.

use std::ops::Range;

use glam::DVec2;

use super::faces::{Face, Facing, Stretch};
use super::notes::{Leg, Notes, Shown};
use super::profile::{Holds, Profiles, SlotId};
use super::things::Between;
use super::veils::{Film, Pane, Veil};
use super::{Part, Piece, Reflection, Scene, Windows};
use crate::cast::{Hit, Ray, Side, UnfoldedWalk};
use crate::render::Column;
use crate::world::{Cell, Light, Paint, Tile, TileId, TileKind};

/// How often a ray is reflected; the mirror after that shows its tint.
pub(super) const MOST_BOUNCES: u32 = 8;

/// A ray that is followed on in one gap.
#[derive(Clone, Debug)]
pub(super) struct Branch {
    pub(super) walk: UnfoldedWalk,
    pub(super) place: Place,
    pub(super) slot: SlotId,
    /// The rows that nothing nearer covers.
    pub(super) window: Range<u32>,
    /// Where on the ray it begins.
    pub(super) from: f64,
    pub(super) reflection: Reflection,
}

/// Where a branch is: in a cell, or off the map.
pub(super) type Place = Option<(Cell, TileId)>;

/// Something upright that a ray meets.
pub(super) struct Met {
    /// The kind of line that it is on, or runs along most.
    pub(super) side: Side,
    pub(super) facing: Facing,
    /// How much of the ray leads straight at it, for each unit of `t`.
    pub(super) slope: f64,
    pub(super) t: f64,
    pub(super) u: f64,
    /// From where it is met.
    pub(super) before: Place,
}

/// One column that is being looked at.
pub(super) struct Look<'a> {
    pub(super) scene: Scene<'a>,
    pub(super) profiles: &'a Profiles,
    column: u32,
    direction: DVec2,
    height: u32,
    pub(super) notes: &'a mut Notes,
    pub(super) branches: &'a mut Vec<Branch>,
    /// What it hit last before it was reflected, and how far it got.
    pub(super) hit: Option<Hit>,
    pub(super) distance: f64,
}

impl<'a> Look<'a> {
    /// At `column` of a picture of that height.
    pub(super) fn new(
        scene: Scene<'a>,
        column: u32,
        height: u32,
        windows: &'a mut Windows,
    ) -> Self {
        let Windows { profiles, notes, branches, .. } = windows;
        let direction = scene.projection.direction_of(column);
        let (hit, distance) = (None, 0.0);
        Self { scene, profiles, column, direction, height, notes, branches, hit, distance }
    }

    /// Follows `ray`, which is that of the column, to the end of all its branches. Tells what it hit
    /// and how far it got before it was reflected.
    pub(super) fn follow(mut self, ray: &Ray) -> Column {
        let mut branch = self.start(ray);
        loop {
            self.follow_branch(&mut branch);
            match self.branches.pop() {
                Some(next) => branch = next,
                None => break,
            }
        }
        self.notes.end_column(self.height);
        let Self { scene, hit, distance, .. } = self;
        let row_of = |height| scene.projection.row_of_height(height, distance);
        Column { hit, distance, rows: row_of(1.0)..row_of(0.0) }
    }

    fn start(&self, ray: &Ray) -> Branch {
        let world = self.scene.world;
        let eye = self.scene.projection.eye();
        let most_bounces = if world.has_mirrors() { MOST_BOUNCES } else { 0 };
        let walk = UnfoldedWalk::new(world.grid(), ray, most_bounces);
        let place = walk.cell(world.grid());
        let slot_in =
            |place| self.profiles.of(place).find(|(_, slot)| slot.gap.holds(eye)).map(|(id, _)| id);
        // An eye inside the rock sees as if the cell were like the map's own floor.
        let ground = place.map(|(cell, _)| (cell, TileId(0)));
        let (place, slot) = match (slot_in(place), slot_in(ground)) {
            (Some(slot), _) => (place, slot),
            (None, Some(slot)) => (ground, slot),
            (None, None) => (ground, SlotId::BOTTOMLESS),
        };
        let window = 0..self.height;
        Branch { walk, place, slot, window, from: 0.0, reflection: Reflection::NONE }
    }

    fn follow_branch(&mut self, branch: &mut Branch) {
        let start = branch.from;
        self.follow_on(branch);
        if self.scene.has_things {
            let (origin, unfolding) = (self.scene.projection.origin(), branch.walk.unfolding());
            let end = |t: f64| unfolding.real_point(origin + self.direction * t);
            let ends = [start, branch.from].map(end);
            self.notes.legs.push(Leg { ends, reflection: branch.reflection });
        }
    }

    /// Follows `branch` as far as it goes.
    fn follow_on(&mut self, branch: &mut Branch) {
        let grid = self.scene.world.grid();
        loop {
            if self.profiles.slot(branch.slot).holds == Holds::Standing {
                self.meet_standing(branch);
                if branch.window.is_empty() {
                    return;
                }
            }
            let crossed = branch.walk.cross(grid);
            self.notes.counts.cells += u64::from(crossed.into.is_some());
            let tile = |(_, tile): (Cell, TileId)| tile;
            if crossed.into.is_some() && crossed.into.map(tile) == branch.place.map(tile) {
                // All of its heights are the same.
                branch.place = crossed.into;
                continue;
            }
            let (t, u) = branch.walk.meeting(&crossed);
            self.lay(branch, t);
            if branch.reflection == Reflection::NONE {
                self.distance = self.distance.max(t);
            }
            if branch.window.is_empty() {
                return;
            }
            let side = crossed.side;
            let slope = match side {
                Side::X => self.direction.x,
                Side::Y => self.direction.y,
            };
            let met = Met { side, facing: Facing::Side(side), slope, t, u, before: branch.place };
            if !self.share_out(branch, crossed.into, &met) {
                return;
            }
        }
    }

    /// Notes floor and ceiling of the cell that `branch` is in, which it leaves at `t`, and closes
    /// the window over them.
    pub(super) fn lay(&mut self, branch: &mut Branch, t: f64) {
        self.note_things(branch, t);
        let projection = self.scene.projection;
        let (eye, slot) = (projection.eye(), self.profiles.slot(branch.slot));
        let Range { start, end } = branch.window;
        let tile = branch.place.map(|(_, tile)| tile);
        let reflection = branch.reflection;
        let piece = |part| Shown::Plane(Piece { tile, part, reflection });
        let bottom = slot.row_of_bottom(projection, t);
        let top = slot.row_of_top(projection, t);
        if eye > slot.gap.bottom {
            self.notes.show(bottom.max(start)..end, piece(slot.below));
        }
        if eye < slot.gap.top && slot.gap.top < f64::INFINITY {
            self.notes.show(start..top.min(end), piece(Part::Ceiling));
        }
        branch.window = start.max(top)..end.min(bottom);
        branch.from = t;
    }

    /// Notes a face that shows in `rows`.
    pub(super) fn face(
        &mut self,
        rows: Range<u32>,
        met: &Met,
        paint: Paint,
        light: Light,
        stretch: Stretch,
    ) {
        self.notes.show(rows.clone(), Shown::Face(met.side));
        let &Met { facing, slope, t, u, .. } = met;
        let column = self.column;
        self.notes.faces.push(Face { column, rows, facing, slope, t, u, paint, light, stretch });
    }

    /// Notes what is seen through in `rows`.
    pub(super) fn veil(
        &mut self,
        rows: Range<u32>,
        met: &Met,
        place: Place,
        film: Film,
        stretch: Stretch,
    ) {
        if rows.is_empty() {
            return;
        }
        let light = self.light(place, met);
        let &Met { facing, slope, t, u, .. } = met;
        let column = self.column;
        self.notes.veils.push(Veil::Pane(self.notes.panes.len()));
        let pane = Pane { column, rows, facing, slope, t, u, light, film, stretch };
        self.notes.panes.push(pane);
    }

    /// Notes that things are seen by `branch` before it gets to `to`.
    fn note_things(&mut self, branch: &Branch, to: f64) {
        if !self.scene.has_things {
            return;
        }
        let &Branch { ref window, slot, from, reflection, .. } = branch;
        let (column, rows) = (self.column, window.clone());
        let between = Between { column, rows, from, to, slot, reflection };
        self.notes.veils.push(Veil::Things(between));
    }

    /// How bright what is in `place` is, seen from where it is met: by its own light, if it is solid,
    /// else as it is there.
    pub(super) fn light(&self, place: Place, met: &Met) -> Light {
        if !self.scene.walls.faded {
            return Light::FULL;
        }
        let is_solid = |tile: &&Tile| !matches!(tile.kind, TileKind::Open | TileKind::Doorway(_));
        let world = self.scene.world;
        let tile = self.tile(place);
        if let Some(own) = tile.filter(is_solid).and_then(|tile| tile.light) {
            return own;
        }
        let Some((before, _)) = met.before else { return Light::FULL };
        let is_door = tile.is_some_and(|tile| matches!(tile.kind, TileKind::Door(_)));
        match place {
            // Leaves have one light all over, as has a shape, which is met in its own cell.
            Some((cell, _)) if cell != before && !is_door => {
                world.face_light(cell, before).at(met.u)
            }
            _ => world.light_in(before),
        }
    }

    pub(super) fn tile(&self, place: Place) -> Option<&'a Tile> {
        let (_, id) = place?;
        self.scene.world.tiles().get(usize::from(id.0))
    }
}
