//! The line between two cells: faces, gaps, mirrors, and the edge of the map.

use std::ops::Range;

use super::met::Met;
use super::tile_gaps::{BOTTOMLESS, GapId, Holds};
use super::walk::{ColumnWalk, MOST_BOUNCES, Place, PortalRay};
use crate::cast::Hit;
use crate::visibility::runs::{FlatSurface, ImageId, Part, Shown};
use crate::visibility::{Extent, Material};
use crate::world::{Glass, Paint, Tile, TileKind};

impl ColumnWalk<'_> {
    /// Divides the clip range of `ray` among the faces and gaps at a line into `place`, and returns
    /// whether the ray continues in one of the gaps. The other gaps are stored for later.
    pub(super) fn cross_line(&mut self, ray: &mut PortalRay, place: Place, met: &Met) -> bool {
        let projection = self.surroundings.scene.projection;
        let Range { start, end } = ray.rows;
        if self.is_above_everything(end, met.t) {
            self.list.runs.show(start..end, Shown::Sky(ray.image));
            return false;
        }
        let gaps = self.surroundings.gaps;
        let mut goes_on: Option<(GapId, u32, u32)> = None;
        // The bottom of the solid part below the next gap, and the row below it.
        let (mut rock_from, mut rock_end) = (f64::NEG_INFINITY, end);
        for id in gaps.of(place) {
            let gap = gaps.gap(id);
            let bottom = gap.row_of_bottom(projection, met.t);
            let top = gap.row_of_top(projection, met.t);
            let rock = start.max(bottom)..rock_end;
            if !rock.is_empty() {
                self.meet_rock(ray, place, met, rock, rock_from..gap.gap.bottom);
            }
            (rock_from, rock_end) = (gap.gap.top, end.min(top));
            let (start, mut end) = (start.max(top), end.min(bottom));
            if start >= end {
                continue;
            }
            if place.is_none() {
                self.show_beyond_edge(start..end, ray.image);
                continue;
            }
            if gap.holds == Holds::Cube {
                end = self.pass_cube(ray, place, &(start..end), met);
                if start >= end {
                    continue;
                }
            }
            if let Some((gap, start, end)) = goes_on.replace((id, start, end)) {
                let (walk, rows) = (ray.walk.clone(), start..end);
                self.memory.rays.push(PortalRay { walk, place, gap, rows, ..*ray });
            }
        }
        let Some((gap, start, end)) = goes_on else { return false };
        (ray.place, ray.gap, ray.rows) = (place, gap, start..end);
        true
    }

    /// Whether only the sky is above row `end`, from distance `t` on.
    fn is_above_everything(&self, end: u32, t: f64) -> bool {
        let projection = self.surroundings.scene.projection;
        end <= projection.first_row_of_ground()
            && end <= projection.row_of(self.surroundings.top, t)
    }

    /// Shows the solid part of `place` between two heights, which covers `rows`: a face, or a
    /// mirror.
    #[inline(never)]
    fn meet_rock(
        &mut self,
        ray: &PortalRay,
        place: Place,
        met: &Met,
        rows: Range<u32>,
        heights: Range<f64>,
    ) {
        let is_lowest = heights.start == f64::NEG_INFINITY;
        let surroundings = self.surroundings;
        let tile = surroundings.tile(place).unwrap_or(&surroundings.scene.world.tiles()[0]);
        if is_lowest
            && let TileKind::Mirror(tint) = tile.kind
            && !tint.is_opaque()
            && ray.walk.bounces() < MOST_BOUNCES
        {
            self.reflect(ray, rows, place, met, tint);
            return;
        }
        let before = surroundings.tile(met.before).map(|tile| &tile.kind);
        let paint = match (is_lowest, before, &tile.kind) {
            (true, Some(TileKind::Door(door) | TileKind::Doorway(door)), TileKind::Wall(_)) => {
                door.jamb
            }
            (true, ..) => tile.riser,
            (false, ..) => tile.lintel,
        };
        // Clipped to the gap from which it is seen.
        let gap = surroundings.gaps.gap(ray.gap).gap;
        let extent = Extent::Heights {
            bottom: heights.start.max(gap.bottom),
            top: heights.end.min(gap.top),
        };
        let u = met.u(ray);
        self.show_face(rows, met, u, (paint, self.light(place, met, u)), extent);
        if ray.image == ImageId::NONE {
            self.hit = place.map(|(cell, _)| Hit { cell, side: met.side, t: met.t, u });
        }
    }

    /// Stores the mirror image for later, in these `rows` behind the mirror's tint.
    fn reflect(&mut self, ray: &PortalRay, rows: Range<u32>, place: Place, met: &Met, tint: Glass) {
        self.memory.stats.bounces += 1;
        if !tint.is_clear() {
            let everywhere = Extent::Heights { bottom: BOTTOMLESS.bottom, top: BOTTOMLESS.top };
            self.pass(ray, rows.clone(), met, place, Material::Translucent(tint), everywhere);
        }
        let mut walk = ray.walk.clone();
        walk.reflect(met.side);
        let image = self.list.runs.image_id(walk.transform());
        self.memory.rays.push(PortalRay { walk, rows, image, ..*ray });
    }

    /// Records the face of the see-through cube in `place`, and returns the end of those of `rows` that show
    /// something behind it.
    #[inline(never)]
    fn pass_cube(&mut self, ray: &PortalRay, place: Place, rows: &Range<u32>, met: &Met) -> u32 {
        let Some(Tile { heights, kind, .. }) = self.surroundings.tile(place) else {
            return rows.end;
        };
        let (bottom, top) = (heights.floor(), heights.ceiling());
        let covered = self.rows_between(rows, bottom..top, met.t);
        let extent = Extent::Heights { bottom, top };
        let material = match *kind {
            TileKind::Glass(glass) if glass.is_opaque() => {
                let end = if covered.is_empty() { rows.end } else { covered.start };
                let u = met.u(ray);
                if ray.image == ImageId::NONE {
                    self.hit = place.map(|(cell, _)| Hit { cell, side: met.side, t: met.t, u });
                }
                let light = self.light(place, met, u);
                self.show_face(covered, met, u, (Paint::Color(glass.color), light), extent);
                return end;
            }
            TileKind::Glass(glass) if glass.is_clear() => return rows.end,
            TileKind::Glass(glass) => Material::Translucent(glass),
            TileKind::Mask(texture) => Material::Masked(texture),
            _ => return rows.end,
        };
        self.pass(ray, covered, met, place, material, extent);
        rows.end
    }

    /// The part of `rows` between two heights at distance `t`.
    pub(super) fn rows_between(
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
    fn show_beyond_edge(&mut self, rows: Range<u32>, image: ImageId) {
        let Range { start, end } = rows;
        let horizon = self.surroundings.scene.projection.first_row_of_ground().clamp(start, end);
        self.list.runs.show(start..horizon, Shown::Sky(image));
        let ground = FlatSurface { tile: None, part: Part::Floor, image };
        self.list.runs.show(horizon..end, Shown::Plane(ground));
    }
}
