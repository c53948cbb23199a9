//! The parts of walls that share a column of pixels, for the filter by area.
//!
//! Two neighbouring rays that hit different walls leave their border between them: the end of the nearer wall.
//! Its place in the picture is exact, and so are the ends of a wall at the ceiling and at the floor, which are
//! straight lines in the picture. A column that a border divides is drawn from both walls. Where a wall covers
//! a pixel in part, floor or ceiling is drawn behind it first.
//!
//! Rejected: more samples in each pixel. Eight times the samples along both axes take sixty times as long. Walls so
//! narrow that no ray hits them are not found, and the sides of doors, diagonals and pillars are at the borders of
//! pixels, as they are for other filters.

use std::ops::Range;

use glam::DVec2;

use super::place_of;
use crate::cast::{Hit, HitFace, Side};
use crate::visibility::projection::FaceEnds;
use crate::visibility::wall_part::{SlopedEdge, WallPart};
use crate::visibility::{Column, DrawList, Projection, Scene};
use crate::world::{Cell, TileId, TileKind, World};

/// Finds the parts of the walls that `list` shows by the flat way, and the columns around which planes are
/// drawn.
pub(crate) fn find(scene: Scene<'_>, list: &mut DrawList) {
    let mut drawn = std::mem::take(&mut list.opaque_columns);
    let mut parts = std::mem::take(&mut list.parts);
    let projection = scene.projection;
    let columns = list.flat_columns();
    let (rows, ground) = (projection.rows(), projection.first_row_of_ground());
    drawn.clear();
    drawn.extend_from_slice(columns);
    // Each border adds a part to one column.
    parts.reserve(2 * columns.len());
    let mut faces = columns.chunk_by(is_one_face).map(|columns| (columns, face_of(scene, columns)));
    let mut next = faces.next();
    let (mut first, mut before) = (0, None);
    while let Some((columns, face)) = next {
        next = faces.next();
        let end = first + columns.len();
        let after = next.and_then(|(_, next)| Border::new(scene, end, (face?, next?)));
        let borders = [before, after];
        let run = Run { projection, rows, ground, first, columns, face, borders };
        run.find(&mut drawn[first..end], &mut parts);
        (first, before) = (end, after);
    }
    (list.opaque_columns, list.parts) = (drawn, parts);
}

/// Neighbouring columns that show the same face.
struct Run<'a> {
    projection: &'a Projection,
    /// The rows of the picture, and the first one of the ground.
    rows: u32,
    ground: u32,
    /// The index of the first column.
    first: usize,
    columns: &'a [Column],
    face: Option<Face>,
    /// The borders to the neighbours on both sides.
    borders: [Option<Border>; 2],
}

/// A side of a wall.
#[derive(Clone, Copy)]
struct Face {
    side: HitFace,
    hit: Hit,
    tile: TileId,
    ends: FaceEnds,
}

/// What a part of a wall covers, as in [`WallPart`].
struct Shape {
    top: SlopedEdge,
    bottom: SlopedEdge,
    rows: Range<u32>,
    whole: Range<u32>,
}

/// A border between the walls of two columns.
#[derive(Clone, Copy)]
struct Border {
    /// In columns from the left edge of the picture.
    place: f64,
    left: Face,
    right: Face,
}

/// A border this near to that of a pixel is on it, in columns.
const EPSILON: f64 = 1.0 / 512.0;

impl Run<'_> {
    /// Finds the parts of all columns, and reduces the rows of those `drawn` to what walls cover as a whole.
    fn find(&self, drawn: &mut [Column], parts: &mut Vec<WallPart>) {
        let last = self.columns.len() - 1;
        for (index, (column, drawn)) in self.columns.iter().zip(drawn).enumerate() {
            let Some(hit) = column.hit.as_ref().filter(|hit| hit.t >= 0.0) else { continue };
            let x = self.first + index;
            let (start, end) = (x as f64, x as f64 + 1.0);
            let [before, after] = self.borders;
            let left = before.filter(|border| index == 0 && border.place > start + EPSILON);
            let right = after.filter(|border| index == last && border.place < end - EPSILON);
            drawn.rows = match self.face {
                Some(face) if left.is_some() || right.is_some() => {
                    self.divide(x as u32, face, left, right, parts)
                }
                Some(Face { ends, .. }) => self.add_whole(x as u32, hit, ends, parts),
                // The ends of other shapes are not straight lines.
                None => {
                    let ends = self.projection.level_ends(hit.t);
                    self.add_whole(x as u32, hit, ends, parts)
                }
            };
        }
    }

    /// Adds the part of the only wall in column `x`. Returns the rows that it covers as a whole.
    #[inline]
    fn add_whole(
        &self,
        x: u32,
        hit: &Hit,
        ends: FaceEnds,
        parts: &mut Vec<WallPart>,
    ) -> Range<u32> {
        let start = f64::from(x);
        let Shape { top, bottom, rows, whole } = self.shape(&(start..start + 1.0), ends);
        let covered = self.around_horizon(&whole);
        parts.push(WallPart {
            column: x,
            hit: *hit,
            middle: start + 0.5,
            share: 1.0,
            top,
            bottom,
            rows,
            whole,
            covered: covered.clone(),
            is_alone: true,
            is_last: true,
        });
        covered
    }

    /// Adds the parts of the walls in column `x` on both sides of the borders in it. Returns the rows that they
    /// cover as a whole.
    fn divide(
        &self,
        x: u32,
        face: Face,
        left: Option<Border>,
        right: Option<Border>,
        parts: &mut Vec<WallPart>,
    ) -> Range<u32> {
        let projection = self.projection;
        let (start, end) = (f64::from(x), f64::from(x) + 1.0);
        let from = left.map_or(start, |border| border.place);
        let to = right.map_or(end, |border| border.place);
        let walls = [
            left.map(|border| (border.left, start..from)),
            Some((face, from..to)),
            right.map(|border| (border.right, to..end)),
        ];
        let first = parts.len();
        let mut covered = 0..projection.rows();
        for (Face { side, ends, .. }, across) in walls.into_iter().flatten() {
            let middle = f64::midpoint(across.start, across.end);
            let hit = side.enter(&projection.ray_at(middle));
            let share = across.end - across.start;
            let Shape { top, bottom, rows, whole } = self.shape(&across, ends);
            covered = covered.start.max(whole.start)..covered.end.min(whole.end);
            parts.push(WallPart {
                column: x,
                hit,
                middle,
                share,
                top,
                bottom,
                rows,
                whole,
                covered: 0..0,
                is_alone: false,
                is_last: false,
            });
        }
        let covered = self.around_horizon(&covered);
        for part in &mut parts[first..] {
            part.covered = covered.clone();
        }
        if let Some(last) = parts.last_mut() {
            last.is_last = true;
        }
        covered
    }

    /// The shape of a wall with these `ends` between two places.
    #[inline]
    fn shape(&self, across: &Range<f64>, ends: FaceEnds) -> Shape {
        let [left, right] = [across.start, across.end].map(|place| ends.at(place));
        let [top, bottom] = [0, 1].map(|end| SlopedEdge::new(left[end], right[end]));
        let (of_top, of_bottom) = (top.rows(self.rows), bottom.rows(self.rows));
        let (rows, whole) = (of_top.start..of_bottom.end, of_top.end..of_bottom.start);
        Shape { top, bottom, rows, whole }
    }

    /// The same rows, if there are any; else none, at the horizon.
    #[inline]
    fn around_horizon(&self, rows: &Range<u32>) -> Range<u32> {
        rows.start.min(self.ground)..rows.end.max(self.ground)
    }
}

impl Border {
    /// The border between two faces, of which the second one begins in column `x`; `None` if both look the same
    /// there.
    fn new(scene: Scene<'_>, x: usize, (left, right): (Face, Face)) -> Option<Self> {
        let [one, other] = [left.hit, right.hit];
        let is_one_line = one.side == other.side
            && match one.side {
                Side::X => one.cell.column == other.cell.column,
                Side::Y => one.cell.row == other.cell.row,
            };
        if is_one_line && left.tile == right.tile {
            return None;
        }
        // The ray on the border is in the middle between the two columns.
        let [of_left, of_right] = [left, right].map(|face| face.ends.rows_at(x as f64));
        let between = (x as f64 - 0.5, x as f64 + 0.5);
        let place = if of_left > of_right {
            left.end_of_wall(scene, left.side.right_end(), between)
        } else {
            right.end_of_wall(scene, right.side.left_end(), between)
        };
        Some(Self { place: place?.max(between.0).min(between.1), left, right })
    }
}

impl Face {
    /// The place of the end of the wall in the picture, which is at `end` or, where the wall goes on in the next
    /// cells, further on, if that is still between two places.
    fn end_of_wall(
        self,
        scene: Scene<'_>,
        mut end: DVec2,
        (least, most): (f64, f64),
    ) -> Option<f64> {
        let grid = scene.world.grid();
        let (left, right) = (self.side.left_end(), self.side.right_end());
        let step = if end == left { left - right } else { right - left };
        let back = if self.side.is_ahead() { -1.0 } else { 1.0 };
        let before = match self.hit.side {
            Side::X => DVec2::new(back, 0.0),
            Side::Y => DVec2::new(0.0, back),
        };
        let Cell { column, row } = self.hit.cell;
        let mut cell = DVec2::new(f64::from(column), f64::from(row));
        let mut place = place_of(scene.projection, end)?;
        while least < place && place < most {
            cell += step;
            let in_front = cell + before;
            let goes_on = grid.tile(cell.x as i64, cell.y as i64) == Some(self.tile)
                && !grid.is_solid(in_front.x as i64, in_front.y as i64);
            if !goes_on {
                break;
            }
            end += step;
            place = place_of(scene.projection, end)?;
        }
        Some(place)
    }
}

/// Whether both columns show the same face.
#[inline]
fn is_one_face(one: &Column, other: &Column) -> bool {
    match (&one.hit, &other.hit) {
        (Some(one), Some(other)) => {
            one.cell == other.cell && one.side == other.side && (one.t < 0.0) == (other.t < 0.0)
        }
        (None, None) => true,
        _ => false,
    }
}

/// The face that `columns` show; `None` if that is not a side of a wall, or if the portal way fills them.
fn face_of(scene: Scene<'_>, columns: &[Column]) -> Option<Face> {
    let hit = columns.first()?.hit.filter(|hit| hit.t >= 0.0)?;
    let tile = wall_tile(scene.world, hit.cell)?;
    let side = hit.face(scene.projection.origin());
    Some(Face { side, hit, tile, ends: scene.projection.face_ends(&side) })
}

/// The tile of `cell`, if it is a wall.
fn wall_tile(world: &World, cell: Cell) -> Option<TileId> {
    let tile = world.grid().tile_in(cell)?;
    matches!(world.tile(tile).kind, TileKind::Wall(_)).then_some(tile)
}
