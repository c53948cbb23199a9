//! What is met at a line between two cells: faces, gaps, mirrors, panes, and the edge of the map.

use std::ops::Range;

use super::faces::Stretch;
use super::look::{Branch, Look, MOST_BOUNCES, Met, Place};
use super::notes::Shown;
use super::profile::{BOTTOMLESS, Holds, SlotId};
use super::veils::Film;
use super::{Part, Piece, Reflection};
use crate::cast::Hit;
use crate::world::{Glass, Tile, TileKind};

impl Look<'_> {
    /// Shares the window of `branch` out among what is met at a line into `place`, and tells whether the
    /// branch goes on in one of the gaps. Others are left for later.
    pub(super) fn share_out(&mut self, branch: &mut Branch, place: Place, met: &Met) -> bool {
        let projection = self.scene.projection;
        let Range { start, end } = branch.window;
        if self.is_above_everything(end, met.t) {
            let reflection = branch.reflection;
            self.notes.show(start..end, Shown::Sky { reflection });
            return false;
        }
        let mut goes_on: Option<(SlotId, Range<u32>)> = None;
        // The rock that is below the next gap, and the row below it.
        let (mut rock_from, mut rock_end) = (f64::NEG_INFINITY, end);
        for (id, slot) in self.profiles.of(place) {
            let bottom = slot.row_of_bottom(projection, met.t);
            let top = slot.row_of_top(projection, met.t);
            let rock = start.max(bottom)..rock_end;
            self.meet_rock(branch, place, met, rock, rock_from..slot.gap.bottom);
            (rock_from, rock_end) = (slot.gap.top, end.min(top));
            let window = start.max(top)..end.min(bottom);
            if window.is_empty() {
                continue;
            }
            if place.is_none() {
                self.look_beyond_edge(window, branch.reflection);
                continue;
            }
            if slot.holds == Holds::Cube {
                self.pass_pane(place, &window, met);
            }
            if let Some((slot, window)) = goes_on.replace((id, window)) {
                self.branches.push(Branch { place, slot, window, ..branch.clone() });
            }
        }
        let Some((slot, window)) = goes_on else { return false };
        (branch.place, branch.slot, branch.window) = (place, slot, window);
        true
    }

    /// Whether there is only sky above row `end`, as far as `t` and further.
    fn is_above_everything(&self, end: u32, t: f64) -> bool {
        let projection = self.scene.projection;
        end <= projection.first_row_of_ground() && end <= projection.row_of(self.scene.top, t)
    }

    /// Meets what is solid in `place` between two heights, which shows in `rows`: a face, or a mirror.
    fn meet_rock(
        &mut self,
        branch: &Branch,
        place: Place,
        met: &Met,
        rows: Range<u32>,
        heights: Range<f64>,
    ) {
        if rows.is_empty() {
            return;
        }
        let is_lowest = heights.start == f64::NEG_INFINITY;
        let tile = self.tile(place).unwrap_or(&self.scene.world.tiles()[0]);
        if is_lowest
            && let TileKind::Mirror(tint) = tile.kind
            && branch.walk.bounces() < MOST_BOUNCES
        {
            self.reflect(Branch { window: rows, ..branch.clone() }, place, met, tint);
            return;
        }
        let before = self.tile(met.before).map(|tile| &tile.kind);
        let paint = match (is_lowest, before, &tile.kind) {
            (true, Some(TileKind::Door(door) | TileKind::Doorway(door)), TileKind::Wall(_)) => {
                door.jamb
            }
            (true, ..) => tile.riser,
            (false, ..) => tile.lintel,
        };
        // As far as it is in the gap that it is seen from.
        let gap = self.profiles.slot(branch.slot).gap;
        let stretch =
            Stretch { bottom: heights.start.max(gap.bottom), top: heights.end.min(gap.top) };
        self.face(rows, met, paint, self.light(place, met), stretch);
        if branch.reflection == Reflection::NONE {
            self.hit = place.map(|(cell, _)| Hit { cell, side: met.side, t: met.t, u: met.u });
        }
    }

    /// Follows the mirror image later, behind the mirror's tint.
    fn reflect(&mut self, mut image: Branch, place: Place, met: &Met, tint: Glass) {
        self.notes.counts.bounces += 1;
        let everywhere = Stretch { bottom: BOTTOMLESS.bottom, top: BOTTOMLESS.top };
        self.veil(image.window.clone(), met, place, Film::Glass(tint), everywhere);
        image.walk.reflect(met.side);
        image.reflection = self.notes.reflection(image.walk.unfolding());
        self.branches.push(image);
    }

    /// Passes the face of the cube in `place` that is seen through.
    fn pass_pane(&mut self, place: Place, window: &Range<u32>, met: &Met) {
        let Some(Tile { heights, kind, .. }) = self.tile(place) else { return };
        let film = match *kind {
            TileKind::Mask(texture) => Film::Mask(texture),
            TileKind::Glass(glass) => Film::Glass(glass),
            _ => return,
        };
        let stretch = Stretch { bottom: heights.floor(), top: heights.ceiling() };
        let rows = self.scene.rows_between(window, stretch, met.t);
        self.veil(rows, met, place, film, stretch);
    }

    /// Shows what is beyond the edge of the map: the sky, and the ground below the horizon.
    fn look_beyond_edge(&mut self, window: Range<u32>, reflection: Reflection) {
        let Range { start, end } = window;
        let horizon = self.scene.projection.first_row_of_ground().clamp(start, end);
        self.notes.show(start..horizon, Shown::Sky { reflection });
        let ground = Piece { tile: None, part: Part::Floor, reflection };
        self.notes.show(horizon..end, Shown::Plane(ground));
    }
}
