//! The line between two cells: faces, gaps, mirrors, and the edge of the map.

use std::ops::Range;

use super::bundle::{Bundle, Clip, MAX_BOUNCES};
use super::met::Met;
use super::tile_gaps::{BOTTOMLESS, Holds, Place, VisibleGap};
use super::walk::{BundleWalk, WalkMemory};
use crate::cast::{Crossed, CrossedFace, Hit, Side};
use crate::visibility::runs::{FlatSurface, ImageId, Part, Shown};
use crate::visibility::{Extent, Material};
use crate::world::{Glass, Paint, Tile, TileKind};

/// A line that the rays of a bundle have crossed, at the distances found.
pub(crate) struct Line {
    pub(crate) side: Side,
    /// The face on it.
    pub(crate) face: CrossedFace,
    /// The cell in front of it, and the one behind it.
    pub(crate) before: Place,
    into: Place,
}

impl BundleWalk<'_> {
    /// Divides the clip ranges of `bundle` among the faces and gaps at a line that it has crossed, and
    /// returns whether all of its rays continue. If not, those that do are stored.
    pub(crate) fn cross_line(&mut self, bundle: &mut Bundle, crossed: &Crossed) -> bool {
        let direction = self.memory.directions[bundle.columns.start as usize];
        let face = bundle.course.face(direction, crossed);
        let &Crossed { side, into, .. } = crossed;
        let line = &Line { side, face, before: bundle.place, into };
        self.show_what_is_above(bundle);
        if self.is_open(bundle) {
            return self.divide_rows(bundle, line);
        }
        let mut columns = bundle.columns.clone();
        while let Some(mut part) = self.next_open(bundle, &mut columns) {
            if self.divide_rows(&mut part, line) {
                self.store(part);
            }
        }
        false
    }

    /// Shows the sky where only the sky is above the rows of a ray, and ends these rays.
    fn show_what_is_above(&mut self, bundle: &Bundle) {
        let projection = self.surroundings.scene.projection;
        let ground = projection.first_row_of_ground();
        for column in bundle.columns.clone() {
            let Clip { ref rows, from, .. } = self.memory.clips[bundle.clip(column)];
            let is_above = !rows.is_empty() && rows.end <= ground;
            if is_above && rows.end <= projection.row_of(self.surroundings.top, from) {
                self.list.runs.show(column, rows.clone(), Shown::Sky(bundle.image));
                self.end(bundle, column);
            }
        }
    }

    /// Divides the clip ranges of `bundle`, none of whose rays has ended.
    fn divide_rows(&mut self, bundle: &mut Bundle, line: &Line) -> bool {
        let gaps = self.surroundings.gaps;
        let Some((upper, lower)) = gaps.upper_and_lower(line.into) else { return false };
        let mut lower = lower.map(|id| (Bundle { gap: id, ..bundle.clone() }, gaps.gap(id)));
        if let Some((lower, gap)) = &mut lower {
            self.meet_rock(bundle, line, gap, None);
            lower.first_clip = self.memory.clips.len();
            self.memory.clips.extend_from_within(bundle.clips());
            self.open(lower, line, gap);
            let WalkMemory { tops, ends, .. } = &mut *self.memory;
            ends[lower.indices()].copy_from_slice(&tops[lower.indices()]);
        }
        self.meet_rock(bundle, line, gaps.gap(upper), lower.as_ref().map(|(_, gap)| *gap));
        bundle.gap = upper;
        self.open(bundle, line, gaps.gap(upper));
        if let Some((lower, _)) = &lower {
            // The upper one is followed first.
            self.begin_lower(lower, bundle);
            self.store_open(lower);
        }
        let is_open = self.is_open(bundle);
        if !is_open {
            self.end_others(lower.as_ref().map(|(lower, _)| lower), bundle);
            self.store_open(bundle);
        }
        is_open
    }

    /// Begins the rays of `lower` that are followed in `upper`, too.
    fn begin_lower(&mut self, lower: &Bundle, upper: &Bundle) {
        for column in upper.columns.clone() {
            let is_upper_open = !self.memory.clips[upper.clip(column)].rows.is_empty();
            let clip = &mut self.memory.clips[lower.clip(column)];
            if is_upper_open {
                clip.start = clip.from;
            }
        }
    }

    /// Ends the rays that are followed neither in `lower` nor in `upper`.
    fn end_others(&mut self, lower: Option<&Bundle>, upper: &Bundle) {
        for column in upper.columns.clone() {
            let is_open = |it: &Bundle| !self.memory.clips[it.clip(column)].rows.is_empty();
            if !is_open(upper) && !lower.is_some_and(is_open) {
                self.end(upper, column);
            }
        }
    }

    /// Puts `bundle` behind the line, into `gap`, and reduces its clip ranges to the rows there.
    fn open(&mut self, bundle: &mut Bundle, line: &Line, gap: &VisibleGap) {
        bundle.place = line.into;
        let indices = bundle.indices();
        let WalkMemory { clips, bottoms, tops, .. } = &mut *self.memory;
        let rows = bottoms[indices.clone()].iter().zip(&tops[indices]);
        for (clip, (&bottom, &top)) in clips[bundle.clips()].iter_mut().zip(rows) {
            clip.rows = clip.rows.start.max(top)..clip.rows.end.min(bottom);
        }
        if line.into.is_none() || gap.holds == Holds::Cube {
            for column in bundle.columns.clone() {
                let rows = self.memory.clips[bundle.clip(column)].rows.clone();
                if !rows.is_empty() {
                    let end = self.pass_cube_or_edge(bundle, line, column, &rows);
                    self.memory.clips[bundle.clip(column)].rows.end = end;
                }
            }
        }
    }

    /// Shows what `rows` show of a see-through cube or of the edge of the map, and returns the end of those
    /// that show something behind it.
    fn pass_cube_or_edge(
        &mut self,
        bundle: &Bundle,
        line: &Line,
        column: u32,
        rows: &Range<u32>,
    ) -> u32 {
        if line.into.is_none() {
            self.show_beyond_edge(column, rows.clone(), bundle.image);
            return rows.start;
        }
        self.pass_cube(bundle, line, column, rows)
    }

    /// Shows the solid part below `gap`, and above the gap `lower` if there is one: its faces, or a mirror.
    fn meet_rock(
        &mut self,
        bundle: &Bundle,
        line: &Line,
        gap: &VisibleGap,
        lower: Option<&VisibleGap>,
    ) {
        self.find_rows(bundle, gap);
        let surroundings = self.surroundings;
        let tile = surroundings.tile(line.into);
        let tile = tile.unwrap_or(&surroundings.scene.world.tiles()[0]);
        if lower.is_none()
            && let TileKind::Mirror(tint) = tile.kind
            && !tint.is_opaque()
            && bundle.course.bounces() < MAX_BOUNCES
        {
            self.reflect(bundle, line, tint);
            return;
        }
        let before = surroundings.tile(line.before).map(|tile| &tile.kind);
        let paint = match (lower, before, &tile.kind) {
            (None, Some(TileKind::Door(door) | TileKind::Doorway(door)), TileKind::Wall(_)) => {
                door.jamb
            }
            (None, ..) => tile.riser,
            (Some(_), ..) => tile.lintel,
        };
        // Clipped to the gap from which it is seen.
        let from = surroundings.gaps.gap(bundle.gap).gap;
        let bottom = lower.map_or(f64::NEG_INFINITY, |lower| lower.gap.top).max(from.bottom);
        let extent = Extent::Heights { bottom, top: gap.gap.bottom.min(from.top) };
        for column in bundle.columns.clone() {
            let rows = self.rows_of_rock(bundle, column, lower.is_some());
            if !rows.is_empty() {
                let met = self.met_at(line, column);
                self.show_face(column, rows, &met, (paint, line.into), extent);
                self.set_hit(bundle, line, column, &met);
            }
        }
    }

    /// The rows of `column` that show the solid part below the gap whose rows were found.
    #[inline]
    fn rows_of_rock(&self, bundle: &Bundle, column: u32, is_above_gap: bool) -> Range<u32> {
        let x = column as usize;
        let Range { start, end } = self.memory.clips[bundle.clip(column)].rows;
        let end = if is_above_gap { end.min(self.memory.ends[x]) } else { end };
        start.max(self.memory.bottoms[x])..end
    }

    /// Stores the mirror image for later, in the rows of the mirror, behind its tint.
    fn reflect(&mut self, bundle: &Bundle, line: &Line, tint: Glass) {
        let everywhere = Extent::Heights { bottom: BOTTOMLESS.bottom, top: BOTTOMLESS.top };
        let first_clip = self.memory.clips.len();
        let mut is_seen = false;
        for column in bundle.columns.clone() {
            let rows = self.rows_of_rock(bundle, column, false);
            let from = self.memory.clips[bundle.clip(column)].from;
            self.memory.clips.push(Clip { rows: rows.clone(), from, start: from });
            if !rows.is_empty() {
                is_seen = true;
                self.memory.stats.bounces += 1;
                if !tint.is_clear() {
                    let met = self.met_at(line, column);
                    let material = Material::Translucent(tint);
                    self.pass(column, rows, &met, (material, line.into), everywhere);
                }
            }
        }
        if is_seen {
            let mut image = Bundle { first_clip, ..bundle.clone() };
            image.course.reflect(line.side);
            image.image = self.list.runs.image_id(image.course.transform());
            self.store_open(&image);
        }
    }

    /// Records the face of the see-through cube behind the line, and returns the end of those of `rows` that
    /// show something behind it.
    fn pass_cube(&mut self, bundle: &Bundle, line: &Line, column: u32, rows: &Range<u32>) -> u32 {
        let place = line.into;
        let Some(Tile { heights, kind, .. }) = self.surroundings.tile(place) else {
            return rows.end;
        };
        let (bottom, top) = (heights.floor(), heights.ceiling());
        let covered = self.rows_between(rows, bottom..top, self.memory.distances[column as usize]);
        let extent = Extent::Heights { bottom, top };
        let material = match *kind {
            TileKind::Glass(glass) if glass.is_opaque() => {
                let end = if covered.is_empty() { rows.end } else { covered.start };
                let met = self.met_at(line, column);
                self.set_hit(bundle, line, column, &met);
                self.show_face(column, covered, &met, (Paint::Color(glass.color), place), extent);
                return end;
            }
            TileKind::Glass(glass) if glass.is_clear() => return rows.end,
            TileKind::Glass(glass) => Material::Translucent(glass),
            TileKind::Mask(texture) => Material::Masked(texture),
            _ => return rows.end,
        };
        let met = self.met_at(line, column);
        self.pass(column, covered, &met, (material, place), extent);
        rows.end
    }

    /// Sets the hit of `column`, unless it is in a mirror.
    #[inline]
    fn set_hit(&mut self, bundle: &Bundle, line: &Line, column: u32, met: &Met) {
        let &Met { side, t, u, .. } = met;
        if bundle.image == ImageId::NONE {
            let hit = line.into.map(|(cell, _)| Hit { cell, side, t, u });
            self.list.columns[column as usize].hit = hit;
        }
    }

    /// The part of `rows` between two heights at distance `t`.
    pub(crate) fn rows_between(
        &self,
        rows: &Range<u32>,
        heights: Range<f64>,
        t: f64,
    ) -> Range<u32> {
        let row_of = |height| self.surroundings.scene.projection.row_of_height(height, t);
        rows.start.max(row_of(heights.end))..rows.end.min(row_of(heights.start))
    }

    /// Shows the sky and, below the horizon, the ground beyond the edge of the map.
    #[inline(never)]
    fn show_beyond_edge(&mut self, column: u32, rows: Range<u32>, image: ImageId) {
        let Range { start, end } = rows;
        let horizon = self.surroundings.scene.projection.first_row_of_ground().clamp(start, end);
        self.list.runs.show(column, start..horizon, Shown::Sky(image));
        let ground = FlatSurface { tile: None, part: Part::Floor, image };
        self.list.runs.show(column, horizon..end, Shown::Plane(ground));
    }
}
