//! What is met at a line between two cells: faces, gaps, mirrors, panes, and the edge of the map.

use std::ops::Range;

use super::faces::Stretch;
use super::look::{BOTTOMLESS, Branch, Look, MOST_BOUNCES, Met, Place};
use super::veils::Film;
use super::{Part, Piece, Reflection, Scene, Shown};
use crate::cast::Hit;
use crate::world::{Glass, Tile, TileKind};

impl Look<'_> {
    /// Shares the window of `branch` out among what is met at a line into `place`. One of the gaps
    /// is returned, others are left for later.
    pub(super) fn share_out(&mut self, branch: Branch, place: Place, met: &Met) -> Option<Branch> {
        let Scene { projection, top, .. } = self.scene;
        let end_of_sky = projection.row_of(top, met.t).min(projection.first_row_of_ground());
        if branch.window.end <= end_of_sky {
            self.show(branch.window, Shown::Sky { reflection: branch.reflection });
            return None;
        }
        let mut next: Option<Branch> = None;
        let mut rock_from = f64::NEG_INFINITY;
        for gap in self.gaps(place).into_iter().flatten() {
            self.meet_rock(&branch, place, met, rock_from..gap.bottom);
            let window = self.rows(&branch.window, gap.bottom, gap.top, met.t);
            rock_from = gap.top;
            if window.is_empty() {
                continue;
            }
            let open = Branch { place, gap, window, ..branch.clone() };
            self.pass_pane(&open, met);
            if place.is_none() {
                self.look_beyond_edge(&open);
            } else if let Some(other) = next.replace(open) {
                self.windows.branches.push(other);
            }
        }
        next
    }

    /// Meets what is solid in `place` between two heights: a face, or a mirror.
    fn meet_rock(&mut self, branch: &Branch, place: Place, met: &Met, heights: Range<f64>) {
        let rows = self.rows(&branch.window, heights.start, heights.end, met.t);
        if rows.is_empty() {
            return;
        }
        let is_lowest = heights.start == f64::NEG_INFINITY;
        if is_lowest
            && let Some((_, TileKind::Mirror(tint))) = self.kind(place)
            && branch.walk.bounces() < MOST_BOUNCES
        {
            self.reflect(Branch { window: rows, ..branch.clone() }, place, met, tint);
            return;
        }
        let tile = self.tile(place).unwrap_or(self.ground());
        let paint = match (is_lowest, self.kind(met.before), tile.kind) {
            (
                true,
                Some((_, TileKind::Door(door) | TileKind::Doorway(door))),
                TileKind::Wall(_),
            ) => door.jamb,
            (true, ..) => tile.riser,
            (false, ..) => tile.lintel,
        };
        // As far as it is in the gap that it is seen from.
        let bottom = heights.start.max(branch.gap.bottom);
        let top = heights.end.min(branch.gap.top);
        self.face(rows, met, paint, self.light(place, met), Stretch { bottom, top });
        if branch.reflection == Reflection::NONE {
            self.hit = place.map(|(cell, _)| Hit { cell, side: met.side, t: met.t, u: met.u });
        }
    }

    /// Follows the mirror image later, behind the mirror's tint.
    fn reflect(&mut self, mut image: Branch, place: Place, met: &Met, tint: Glass) {
        self.windows.counts.bounces += 1;
        let everywhere = Stretch { bottom: BOTTOMLESS.bottom, top: BOTTOMLESS.top };
        self.veil(image.window.clone(), met, place, Film::Glass(tint), everywhere);
        image.walk.reflect(met.side);
        image.reflection = self.windows.reflection(image.walk.unfolding());
        self.windows.branches.push(image);
    }

    /// Passes the face of a cube that is seen through, if `branch` has just entered one.
    fn pass_pane(&mut self, branch: &Branch, met: &Met) {
        let film = match self.kind(branch.place) {
            Some((_, TileKind::Mask(texture))) => Film::Mask(texture),
            Some((_, TileKind::Glass(glass))) => Film::Glass(glass),
            _ => return,
        };
        let Some(Tile { heights, .. }) = self.tile(branch.place) else { return };
        if heights.floor() == branch.gap.bottom {
            let rows = self.rows(&branch.window, heights.floor(), heights.ceiling(), met.t);
            let stretch = Stretch { bottom: heights.floor(), top: heights.ceiling() };
            self.veil(rows, met, branch.place, film, stretch);
        }
    }

    /// Shows what is beyond the edge of the map: the sky, and the ground below the horizon.
    fn look_beyond_edge(&mut self, branch: &Branch) {
        let Range { start, end } = branch.window;
        let reflection = branch.reflection;
        let horizon = self.scene.projection.first_row_of_ground().clamp(start, end);
        self.show(start..horizon, Shown::Sky { reflection });
        let ground = Piece { tile: None, part: Part::Floor, reflection };
        self.show(horizon..end, Shown::Plane(ground));
    }
}
