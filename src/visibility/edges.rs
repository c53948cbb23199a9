//! Edges: the outlines of faces under the area filter, as straight lines in the picture.
//!
//! A wall covers the pixels along its edges only in part. The surfaces behind these pixels are drawn first:
//! floor and ceiling continue under the wall's lower and upper edge. The walls are then blended over them from
//! far to near, each by the share of the pixel that it covers. Walls that share a column of pixels are blended
//! together, so that no rounding happens between them.
//!
//! A wall so narrow that no ray hits it is not found. The sides of doors, diagonals and pillars are at the
//! borders of pixels, as under the other filters.
//!
//! Rejected: more samples in each pixel. Eight times the samples along both axes take sixty times as long.

use std::mem;
use std::ops::Range;

use glam::DVec2;

use super::Projection;
use super::face::{CellFace, Face, FaceColumn, Facing, Material, Rows};
use super::fan::Border;
use super::walk::{BorderGroup, ColumnMemory, SectorWalk, Visit, texture_coordinate_at};
use crate::world::{Sector, SectorId, TileKind, TileSectors};

/// The height in the picture of a face on the grid, as a linear function of the column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FaceEdges {
    /// The number of rows per cell of height at the left edge of the picture, and its change from column to
    /// column.
    rows: f64,
    change: f64,
    /// The part of each column that the face covers, from 0 at the left to 1 at the right.
    part: (f64, f64),
    /// `true` if the face is blended together with the next face, which shares the column.
    pub(crate) is_joined: bool,
}

/// The border between two walls that may share a column of pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WallBorder {
    /// The position, in columns from the left edge of the picture.
    place: f64,
}

/// The distance, in columns, within which a joint counts as on the border of a pixel.
const EPSILON: f64 = 1.0 / 512.0;
/// A number of rows per cell of height that is greater than the height of any picture.
const FAR: f64 = 1e9;

impl FaceEdges {
    /// The edges of `face`.
    pub(crate) fn new(projection: &Projection, face: &CellFace) -> Self {
        let to_line = face.distance_to_line(projection.origin());
        let [middle, right] =
            [projection.direction(), projection.plane()].map(|it| it[face.side as usize]);
        // The inverse of the distance to the camera plane is linear across the picture.
        let rows = (projection.focal_length() / to_line).min(FAR);
        let rows = if face.is_ahead { rows } else { -rows };
        let change = rows * right * (2.0 / projection.columns() as f64);
        Self { rows: rows * (middle - right), change, part: (0.0, 1.0), is_joined: false }
    }

    /// The number of rows per cell of height at `place`.
    #[inline]
    fn rows_at(&self, place: f64) -> f64 {
        self.rows + self.change * place
    }

    /// The upper and the lower edge of `face` in column `x`.
    #[inline]
    pub(crate) fn limits(&self, projection: &Projection, face: &Face, x: u32) -> [SlopedEdge; 2] {
        let across = self.across(x);
        [face.top, face.bottom].map(|height| self.edge(projection, height, &across))
    }

    /// The edge at `height` between two positions.
    #[inline]
    fn edge(&self, projection: &Projection, height: f64, across: &Range<f64>) -> SlopedEdge {
        SlopedEdge { ends: [across.start, across.end].map(|it| self.row(projection, height, it)) }
    }

    /// The row of `height` at `place`.
    #[inline]
    fn row(&self, projection: &Projection, height: f64, place: f64) -> f64 {
        projection.horizon() + (projection.eye() - height) * self.rows_at(place)
    }

    /// The edge at `height` in each of `columns`.
    #[inline]
    pub(crate) fn edges_in(
        &self,
        projection: &Projection,
        height: f64,
        columns: Range<u32>,
    ) -> impl Iterator<Item = SlopedEdge> {
        let mut left = self.row(projection, height, f64::from(columns.start));
        columns.map(move |x| {
            let right = self.row(projection, height, f64::from(x + 1));
            SlopedEdge { ends: [mem::replace(&mut left, right), right] }
        })
    }

    /// The rows that the edge at `height` crosses in column `x`.
    #[inline]
    fn rows_of(&self, projection: &Projection, height: f64, x: u32) -> Range<u32> {
        let across = f64::from(x)..f64::from(x) + 1.0;
        self.edge(projection, height, &across).rows(projection.rows())
    }

    /// The part of column `x` that the face covers.
    #[inline]
    pub(crate) fn across(&self, x: u32) -> Range<f64> {
        let (x, (start, end)) = (f64::from(x), self.part);
        x + start..x + end
    }
}

impl SectorWalk<'_> {
    /// Returns true if faces are blended over the surfaces behind their edges.
    pub(crate) fn blends(&self) -> bool {
        self.scene.plan.filter == super::Filter::Area
    }

    /// Finds the positions at which neighbouring walls of the current visit share a column of pixels.
    pub(crate) fn find_joints(&mut self, visit: &Visit, sector: &Sector) {
        let mut joints = mem::take(&mut self.memory.joints);
        joints.clear();
        let pairs = self.memory.borders.array_windows();
        joints.extend(pairs.map(|[left, right]| self.joint(visit, sector, left, right)));
        self.memory.joints = joints;
    }

    fn joint(
        &self,
        visit: &Visit,
        sector: &Sector,
        left: &Border,
        right: &Border,
    ) -> Option<WallBorder> {
        let tile = |border: &Border| border.into.map(|(_, tile)| tile);
        let is_one_wall = left.face.is_in_line_with(&right.face) && tile(left) == tile(right);
        if is_one_wall || !self.is_wall(sector, left) || !self.is_wall(sector, right) {
            return None;
        }
        let projection = self.scene.projection;
        // The border is between two columns; its ray is in the middle.
        let x = f64::from(right.columns.start);
        let between = x - 0.5..x + 0.5;
        let end_of = |border: &Border, end: DVec2| {
            let place = self.end_of_wall(visit, border, end, &between)?;
            Some(place.max(between.start).min(between.end))
        };
        // The left wall ends there if it is the nearer one there. Nearness anywhere else is no evidence, because a
        // wall that rays graze recedes within a column.
        let is_nearer = |&place: &f64| {
            let [of_left, of_right] =
                [left, right].map(|it| FaceEdges::new(projection, &it.face).rows_at(place));
            of_left >= of_right
        };
        let of_left = end_of(left, left.face.right_end()).filter(is_nearer);
        let place = of_left.or_else(|| end_of(right, right.face.left_end()))?;
        Some(WallBorder { place })
    }

    /// Returns true if a wall that hides everything is behind `border`.
    fn is_wall(&self, sector: &Sector, border: &Border) -> bool {
        border.into.is_some_and(|(_, id)| {
            let TileSectors { lower, .. } = self.fan.sectors.of(id);
            let kind = self.scene.world.tiles()[usize::from(id.0)].kind;
            matches!(kind, TileKind::Wall(_)) && self.fan.sectors.get(lower).bottom >= sector.top
        })
    }

    /// The position in the picture of the end of the wall at `border`; `None` if it is behind the camera. The
    /// wall ends at `end`, or further on if it continues in the next cells. The search stops at the first
    /// position outside `between`.
    fn end_of_wall(
        &self,
        visit: &Visit,
        border: &Border,
        mut end: DVec2,
        between: &Range<f64>,
    ) -> Option<f64> {
        let grid = self.scene.world.grid();
        let face = &border.face;
        let is_left = end == face.left_end();
        let step = if is_left {
            face.left_end() - face.right_end()
        } else {
            face.right_end() - face.left_end()
        };
        let place_of = |end: DVec2| {
            let place = self.scene.projection.place(end);
            (place.depth > 0.0).then_some(place.column)
        };
        let (_, tile) = border.into?;
        let (mut cell, mut before) = (face.place, face.place_before());
        let mut place = place_of(end)?;
        while between.start < place && place < between.end {
            for place in [&mut cell, &mut before] {
                place[0] += step.x as i64;
                place[1] += step.y as i64;
            }
            let [beside, in_front] = [cell, before].map(|place| {
                let [column, row] = visit.image.cell_to_map(place);
                grid.tile(column, row)
            });
            let is_clear =
                in_front.is_none_or(|tile| self.fan.sectors.continues(visit.sector, tile));
            if beside != Some(tile) || !is_clear {
                break;
            }
            end += step;
            place = place_of(end)?;
        }
        Some(place)
    }

    /// Extends the planes of the sector under the rows that a face at the border covers only in part. `bottoms`
    /// and `tops` become the limits of the planes. `outer_bottoms` and `outer_tops` receive the limits of the
    /// faces.
    pub(crate) fn extend_planes(&mut self, sector: &Sector) {
        let projection = self.scene.projection;
        let ground = projection.first_row_of_ground();
        for index in 0..self.memory.borders.len() {
            let border = self.memory.borders[index].clone();
            let [above_floor, below_ceiling] = self.faces_at(sector, &border);
            let edges = FaceEdges::new(projection, &border.face);
            let ColumnMemory { bottoms, tops, outer_bottoms, outer_tops, .. } =
                &mut self.memory.columns;
            let columns = border.columns.start as usize..border.columns.end as usize;
            outer_bottoms[columns.clone()].copy_from_slice(&bottoms[columns.clone()]);
            outer_tops[columns.clone()].copy_from_slice(&tops[columns.clone()]);
            let height = projection.rows();
            if above_floor && projection.eye() > sector.bottom {
                let edges = edges.edges_in(projection, sector.bottom, border.columns.clone());
                let rows =
                    bottoms[columns.clone()].iter_mut().zip(&mut outer_bottoms[columns.clone()]);
                for (edge, (bottom, outer)) in edges.zip(rows) {
                    let Range { start, end } = edge.rows(height);
                    (*bottom, *outer) = (start.max(ground), end);
                }
            }
            if below_ceiling && projection.eye() < sector.top {
                let edges = edges.edges_in(projection, sector.top, border.columns);
                let rows = tops[columns.clone()].iter_mut().zip(&mut outer_tops[columns]);
                for (edge, (top, outer)) in edges.zip(rows) {
                    let Range { start, end } = edge.rows(height);
                    (*top, *outer) = (end.min(ground), start);
                }
            }
        }
        self.uncover_joints(sector);
    }

    /// Returns whether a blended face is above the floor at `border`, and whether one is below the ceiling.
    fn faces_at(&self, sector: &Sector, border: &Border) -> [bool; 2] {
        let sectors = self.fan.sectors;
        let Some((_, id)) = border.into else {
            return [sectors.get(SectorId::BEYOND).bottom > sector.bottom, false];
        };
        let tile = &self.scene.world.tiles()[usize::from(id.0)];
        let TileSectors { lower, upper } = sectors.of(id);
        let gap = sectors.get(lower);
        let is_rock = gap.bottom > sector.bottom && !tile.reflects();
        let is_lintel = gap.top < sector.top
            && upper.is_some_and(|upper| sectors.get(upper).bottom >= sector.top);
        [is_rock, is_rock && gap.bottom >= sector.top || is_lintel]
    }

    /// Extends the planes, in each column that two walls share, as far as they reach beside either wall.
    fn uncover_joints(&mut self, sector: &Sector) {
        let projection = self.scene.projection;
        let ground = projection.first_row_of_ground();
        for (index, joint) in self.memory.joints.iter().enumerate() {
            let Some(x) = joint.and_then(WallBorder::column) else { continue };
            let ColumnMemory { bottoms, tops, .. } = &mut self.memory.columns;
            let (bottom, top) = (&mut bottoms[x as usize], &mut tops[x as usize]);
            for border in &self.memory.borders[index..=index + 1] {
                let edges = FaceEdges::new(projection, &border.face);
                if projection.eye() > sector.bottom {
                    let Range { start, .. } = edges.rows_of(projection, sector.bottom, x);
                    *bottom = (*bottom).min(start.max(ground));
                }
                if projection.eye() < sector.top && sector.top < f64::INFINITY {
                    let Range { end, .. } = edges.rows_of(projection, sector.top, x);
                    *top = (*top).max(end.min(ground));
                }
            }
        }
    }

    /// Writes the rows of the faces at `group` between two heights to `tops` and `bottoms`, including the rows
    /// that the faces cover only in part. A height outside `sector` changes nothing.
    pub(crate) fn find_outer_limits(
        &mut self,
        sector: &Sector,
        group: &BorderGroup,
        top: f64,
        bottom: f64,
    ) {
        let projection = self.scene.projection;
        let edges = FaceEdges::new(projection, &group.face);
        let ColumnMemory { bottoms, tops, .. } = &mut self.memory.columns;
        let columns = group.columns.start as usize..group.columns.end as usize;
        let rows_in = |height: f64| {
            let edges = edges.edges_in(projection, height, group.columns.clone());
            edges.map(|edge| edge.rows(projection.rows()))
        };
        if sector.is_inside(top) {
            for (top, rows) in tops[columns.clone()].iter_mut().zip(rows_in(top)) {
                *top = rows.start;
            }
        }
        if sector.is_inside(bottom) {
            for (bottom, rows) in bottoms[columns].iter_mut().zip(rows_in(bottom)) {
                *bottom = rows.end;
            }
        }
    }

    /// Adds an opaque face at `group`, except in the columns that it shares with neighbouring walls.
    pub(crate) fn show_blended_face(
        &mut self,
        visit: &Visit,
        group: &BorderGroup,
        material: Material,
        (bottom, top): (f64, f64),
    ) {
        let Range { start, end } = group.columns;
        let shared = |index: Option<usize>| {
            self.memory.joints.get(index?).copied().flatten().and_then(WallBorder::column)
        };
        let before = shared(group.borders.start.checked_sub(1));
        let after = shared(Some(group.borders.end - 1));
        let columns = before.map_or(start, |x| start.max(x + 1))..after.map_or(end, |x| end.min(x));
        if columns.is_empty() {
            return;
        }
        let first = self.list.face_columns.len();
        self.list.face_columns.extend(self.memory.columns.of_face(&columns));
        let light = self.light_on_face(visit, group);
        self.list.push_face(Face {
            columns: columns.clone(),
            first,
            facing: Facing::Side(group.face.side),
            material,
            light,
            bottom,
            top,
            image: visit.image,
            edges: Some(FaceEdges::new(self.scene.projection, &group.face)),
        });
    }

    /// The face column at a border in column `x` of the picture, sampled in the middle of the part `across` of
    /// that column.
    fn column_at(
        &self,
        visit: &Visit,
        border: usize,
        (x, across): (u32, Range<f64>),
        ((bottom, top), edges): ((f64, f64), &FaceEdges),
    ) -> FaceColumn {
        let projection = self.scene.projection;
        let direction = projection.direction_at(f64::midpoint(across.start, across.end));
        let border = &self.memory.borders[border];
        let (t, u) = texture_coordinate_at(visit.image, projection, border, direction);
        let Rows { start, end } = self.memory.columns.entered[x as usize];
        let top = edges.rows_of(projection, top, x).start;
        let bottom = edges.rows_of(projection, bottom, x).end;
        FaceColumn { rows: Rows { start: start.max(top), end: end.min(bottom) }, t, u }
    }

    /// Adds the parts of walls in the columns that they share.
    pub(crate) fn show_shared_columns(&mut self, visit: &Visit, sector: &Sector) {
        let mut index = 0;
        while index < self.memory.joints.len() {
            let column = |index: usize| self.memory.joints.get(index)?.and_then(WallBorder::column);
            let Some(x) = column(index) else {
                index += 1;
                continue;
            };
            let mut end = index + 1;
            while column(end) == Some(x) {
                end += 1;
            }
            let within = |walk: &Self, index: usize| {
                walk.memory.joints[index].map_or(0.0, |joint| joint.place - f64::from(x))
            };
            for border in index..=end {
                let left = if border == index { 0.0 } else { within(self, border - 1) };
                let right = if border == end { 1.0 } else { within(self, border) };
                let is_last = border == end;
                self.show_part(visit, sector, border, (x, (left, right)), is_last);
            }
            index = end;
        }
    }

    /// Adds the part of the wall at a border that is in column `x`. It is blended together with the next part,
    /// unless it is the last.
    fn show_part(
        &mut self,
        visit: &Visit,
        sector: &Sector,
        border: usize,
        (x, part): (u32, (f64, f64)),
        is_last: bool,
    ) {
        let Border { columns, face, into } = self.memory.borders[border].clone();
        let Some((_, id)) = into else { return };
        let group = &BorderGroup { borders: border..border + 1, columns, face };
        let tile = &self.scene.world.tiles()[usize::from(id.0)];
        let paint = self.paint_of_rock(visit, group, tile);
        let edges = FaceEdges::new(self.scene.projection, &face);
        let edges = FaceEdges { part, is_joined: !is_last, ..edges };
        let (bottom, top) = (sector.bottom, sector.top);
        let shown = self.column_at(visit, border, (x, edges.across(x)), ((bottom, top), &edges));
        let first = self.list.face_columns.len();
        self.list.face_columns.push(shown);
        let light = self.light_on_face(visit, group);
        self.list.faces.push(Face {
            columns: x..x + 1,
            first,
            facing: Facing::Side(face.side),
            material: Material::Opaque(paint),
            light,
            bottom,
            top,
            image: visit.image,
            edges: Some(edges),
        });
    }
}

impl WallBorder {
    /// The column that both walls share; `None` if the joint is on the border of a pixel.
    fn column(self) -> Option<u32> {
        let column = self.place as u32;
        let within = self.place - f64::from(column);
        (within > EPSILON && within < 1.0 - EPSILON).then_some(column)
    }
}

/// An edge that is straight in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SlopedEdge {
    /// The row at its left end and at its right end, in rows from the top.
    ends: [f64; 2],
}

impl SlopedEdge {
    /// The rows that the edge crosses, limited to `height`.
    #[inline]
    pub(crate) fn rows(self, height: u32) -> Range<u32> {
        let [left, right] = self.ends;
        let (upper, lower) = if left < right { (left, right) } else { (right, left) };
        // Conversions saturate.
        let (first, end) = (upper as u32, lower as u32);
        let is_between = f64::from(end) < lower;
        first.min(height)..end.saturating_add(u32::from(is_between)).min(height)
    }

    /// The share of `row`, between the edge's ends, that is below the edge.
    #[inline]
    pub(crate) fn share_below(self, row: u32) -> f64 {
        /// An edge with a smaller rise counts as level, because the difference is a rounding error.
        const LEVEL: f64 = 1e-6;
        let bottom = f64::from(row) + 1.0;
        let [left, right] = self.ends.map(|end| bottom - end);
        if left <= 0.0 && right <= 0.0 {
            return 0.0;
        }
        if left >= 1.0 && right >= 1.0 {
            return 1.0;
        }
        let middle = 0.5 * (left + right);
        if left >= 0.0 && right >= 0.0 && left <= 1.0 && right <= 1.0 {
            return middle;
        }
        let rise = right - left;
        if rise.abs() < LEVEL {
            return middle.clamp(0.0, 1.0);
        }
        (integral(right) - integral(left)) / rise
    }
}

/// The integral of `x.clamp(0.0, 1.0)` from 0 to `end`.
fn integral(end: f64) -> f64 {
    let limited = end.clamp(0.0, 1.0);
    limited * limited / 2.0 + (end - limited).max(0.0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn the_share_below_an_edge_matches_many_samples(
            ends in [-3.0..13.0_f64, -3.0..13.0_f64],
            row in 0_u32..10,
        ) {
            const SAMPLES: u32 = 200;
            let edge = SlopedEdge { ends };
            let mut below = 0.0;
            for across in 0..SAMPLES {
                let along = (f64::from(across) + 0.5) / f64::from(SAMPLES);
                let edge = ends[0] + along * (ends[1] - ends[0]);
                below += (f64::from(row) + 1.0 - edge).clamp(0.0, 1.0);
            }
            let off = edge.share_below(row) - below / f64::from(SAMPLES);
            prop_assert!(off.abs() < 1e-3, "{off}");
        }

        #[test]
        fn an_edge_crosses_only_its_rows(ends in [-3.0..13.0_f64, -3.0..13.0_f64]) {
            let edge = SlopedEdge { ends };
            let rows = edge.rows(10);
            for row in 0..10 {
                let share = edge.share_below(row);
                prop_assert!(rows.contains(&row) || !(1e-9..=1.0 - 1e-9).contains(&share));
                prop_assert!(row >= rows.start || share < 1e-9);
                prop_assert!(row < rows.end || share > 1.0 - 1e-9);
            }
        }
    }
}
