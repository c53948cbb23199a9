//! The fan: the rays of neighbouring columns through one sector, up to the faces at its border.
//!
//! Only a few of the rays are cast. If two rays hit the same face, all rays between them hit it too. A cell
//! outside the sector that hides the face would be nearer and at least as wide as the face, so one of the two
//! rays would hit that cell. Rays are therefore cast where a face ends: at the first column beyond the face,
//! then at its last column. Rejected: halving the picture recursively. At 80×48 pixels, it casts 33 rays
//! instead of 15.
//!
//! Two rays may also hit neighbouring faces on one line, each a cell wide. The rays between them then hit only
//! these two faces if no cell fits between the two rays. A cell in front of the line is at least one cell
//! nearer than the line. If the line is D cells from the eye, the rays are less than one cell apart at such a
//! cell if they are less than D / (D − 1) cells apart at the line. The corner between the two faces decides
//! which ray hits which face.

use std::cell::Cell as Counter;
use std::ops::Range;

use glam::DVec2;

use super::face::CellFace;
use super::{FrameContext, Projection, WalkStats};
use crate::cast::{
    CommonOrder, Course, Crossing, MajorAxisTraversal, MirrorTransform, Order, Ray, Side,
};
use crate::world::{Cell, Grid, SectorId, Sectors, TileId};

/// Neighbouring columns whose rays leave a sector through one face.
#[derive(Clone, Debug)]
pub(crate) struct Border {
    pub(crate) columns: Range<usize>,
    pub(crate) face: CellFace,
    /// The cell behind the face; `None` at the edge of the map.
    pub(crate) into: Option<(Cell, TileId)>,
}

/// The start of rays in a sector.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayStarts<'a> {
    pub(crate) sector: SectorId,
    pub(crate) image: MirrorTransform,
    pub(crate) entries: &'a [SectorEntry],
    /// `true` if the rays begin at the camera.
    pub(crate) is_at_camera: bool,
}

/// The cell in which rays enter a sector: the ray of `column`, and the rays to its right up to the next entry.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SectorEntry {
    pub(crate) column: usize,
    /// The column and the row of the cell along the straight rays.
    pub(crate) place: [i64; 2],
}

/// The directions of the rays of all columns.
#[derive(Clone, Debug, Default)]
pub(crate) struct Directions {
    /// The positions of the columns across the picture, from −1 to 1.
    places: Vec<f64>,
    along: [Vec<f64>; 2],
}

/// State shared by the rays of a frame.
pub(crate) struct Fan<'a> {
    pub(crate) scene: FrameContext<'a>,
    pub(crate) sectors: &'a Sectors,
    pub(crate) directions: &'a Directions,
    order: CommonOrder,
    /// The cost of the rays cast until now.
    pub(crate) counts: Counter<WalkStats>,
}

/// Rays whose neighbours to the left are not known yet, in memory that is reused from frame to frame.
pub(crate) type FanMemory = Vec<(usize, FaceHit)>;

/// The face through which a ray leaves a sector, and the cell behind the face.
type FaceHit = (CellFace, Option<(Cell, TileId)>);

/// The distance, in columns, within which a corner counts as on the centre of a pixel.
const EPSILON: f64 = 1e-6;

impl Directions {
    /// Finds the directions of all columns of `projection`.
    pub(crate) fn begin(&mut self, projection: &Projection) {
        let Self { places, along: [x, y] } = self;
        if places.len() != projection.columns() {
            places.clear();
            places.extend((0..projection.columns()).map(|it| projection.place_of(it)));
        }
        let (middle, right) = (projection.direction(), projection.plane());
        x.clear();
        y.clear();
        x.extend(places.iter().map(|place| middle.x + right.x * place));
        y.extend(places.iter().map(|place| middle.y + right.y * place));
    }

    /// The direction of the ray of `column`.
    #[inline]
    pub(crate) fn of(&self, column: usize) -> DVec2 {
        let [x, y] = &self.along;
        DVec2::new(x[column], y[column])
    }

    /// The components of all directions across the lines of `side`.
    #[inline]
    pub(crate) fn across(&self, side: Side) -> &[f64] {
        &self.along[side as usize]
    }
}

impl<'a> Fan<'a> {
    pub(crate) fn new(
        scene: FrameContext<'a>,
        sectors: &'a Sectors,
        directions: &'a Directions,
        most_bounces: u32,
    ) -> Self {
        let origin = scene.projection.origin();
        let order = CommonOrder::new(scene.world.grid(), origin, most_bounces);
        Self { scene, sectors, directions, order, counts: Counter::default() }
    }

    /// Writes the faces through which the rays of `columns` leave the sector of `view` to `borders`, from left
    /// to right. `columns` must not be empty.
    pub(crate) fn find(
        &self,
        view: RayStarts<'_>,
        columns: Range<usize>,
        memory: &mut FanMemory,
        borders: &mut Vec<Border>,
    ) {
        borders.clear();
        let grid = self.grid_of(view);
        let cast = |column: usize| self.cast(view, grid, column);
        let is_each_cast = !self.scene.projection.fans_out()
            || matches!(view.sector, SectorId::BEYOND | SectorId::SOLID);
        if is_each_cast {
            columns.for_each(|column| extend(borders, column..column + 1, cast(column)));
            return;
        }
        let last = columns.end - 1;
        let (mut first, mut left) = (columns.start, cast(columns.start));
        extend(borders, first..first + 1, left);
        memory.clear();
        if first < last {
            memory.push((last, cast(last)));
        }
        while let Some(&(column, right)) = memory.last() {
            let pair = RayPair { fan: self, first, width: column - first };
            let next = match pair.step([&left.0, &right.0]) {
                FanStep::Split(split) => {
                    extend(borders, first + 1..first + split, left);
                    extend(borders, first + split..column + 1, right);
                    (first, left) = (column, right);
                    memory.pop();
                    continue;
                }
                FanStep::Cast(next) => first + next,
            };
            memory.push((next, cast(next)));
        }
    }

    /// The grid in which exactly the cells outside the sector of `view` are solid; `None` if the world has no
    /// such grid.
    fn grid_of(&self, view: RayStarts<'_>) -> Option<&'a Grid> {
        let world = self.scene.world;
        if !view.is_at_camera {
            return None;
        }
        let grid = world.level_grid().unwrap_or(world.grid());
        let is_of_level = |tile: TileId| {
            let is_level = || world.tiles()[usize::from(tile.0)].is_level();
            !world.grid().is_solid_tile(tile) && (world.level_grid().is_none() || is_level())
        };
        let tiles = (0..world.tiles().len()).map(|tile| TileId(tile as u8));
        let mut tiles =
            tiles.map(|tile| self.sectors.continues(view.sector, tile) == is_of_level(tile));
        tiles.all(|is_alike| is_alike).then_some(grid)
    }

    /// The hit of the ray of `column`.
    fn cast(&self, view: RayStarts<'_>, grid: Option<&Grid>, column: usize) -> FaceHit {
        let direction = self.directions.of(column);
        let hit = grid.and_then(|grid| self.cast_through(grid, direction));
        hit.unwrap_or_else(|| self.walk(view, column, direction))
    }

    /// The hit of the ray from the camera along `direction`: the first solid cell of `grid` that it enters.
    #[inline]
    fn cast_through(&self, grid: &Grid, direction: DVec2) -> Option<FaceHit> {
        let ray = Ray::of_camera(self.scene.projection.origin(), direction);
        let mut traversal = MajorAxisTraversal::new(grid, &ray)?;
        let (start, Crossing { cell, side, .. }) = (traversal.cell(), traversal.next()?);
        if let Some((start, _)) = start {
            let cells = start.column.abs_diff(cell.column) + start.row.abs_diff(cell.row);
            self.count(u64::from(cells), traversal.lookups());
        }
        let place = [i64::from(cell.column), i64::from(cell.row)];
        let is_ahead = direction[side as usize] > 0.0;
        let tile = self.scene.world.grid().tile_in(cell)?;
        Some((CellFace { side, place, is_ahead }, Some((cell, tile))))
    }

    /// Counts a ray that entered `cells` cells and made `looks` lookups.
    fn count(&self, cells: u64, looks: u64) {
        self.counts.update(|counts| WalkStats {
            rays: counts.rays + 1,
            cells: counts.cells + cells,
            looks: counts.looks + looks,
            ..counts
        });
    }

    /// The hit of the ray of `column`, found by following it from cell to cell.
    fn walk(&self, view: RayStarts<'_>, column: usize, direction: DVec2) -> FaceHit {
        let grid = self.scene.world.grid();
        let mut order = self.order.along(direction);
        let entry = view.entries.iter().rfind(|entry| entry.column <= column);
        let entry = entry.or(view.entries.first()).map_or([0; 2], |entry| entry.place);
        let mut course = Course::resumed(grid, direction, view.image, entry);
        let mut cells = 0;
        loop {
            cells += 1;
            let [x, y] = course.lines();
            let side = order.next(x, y);
            let Some(crossed) = course.cross(grid, side) else { continue };
            if let Some((_, tile)) = crossed.into
                && self.sectors.continues(view.sector, tile)
            {
                continue;
            }
            let is_ahead = direction[side as usize] > 0.0;
            self.count(cells, cells);
            return (CellFace { side, place: course.place(), is_ahead }, crossed.into);
        }
    }
}

/// Adds `columns` whose rays leave through the face of a hit. They extend the last border if it has the same
/// face.
#[inline]
fn extend(borders: &mut Vec<Border>, columns: Range<usize>, (face, into): FaceHit) {
    if columns.is_empty() {
        return;
    }
    match borders.last_mut() {
        Some(last) if last.face == face => last.columns.end = columns.end,
        _ => borders.push(Border { columns, face, into }),
    }
}

/// Two rays with known hits, and the columns from the first to the second.
struct RayPair<'a> {
    fan: &'a Fan<'a>,
    first: usize,
    /// The number of columns from the first ray to the second.
    width: usize,
}

/// The next step for the rays in a gap. Columns are counted from the column of the first ray.
enum FanStep {
    /// The rays before this column hit the first face, and the others hit the second one.
    Split(usize),
    /// The ray of this column must be cast.
    Cast(usize),
}

impl RayPair<'_> {
    /// The next step for the rays between the two: the split if it follows from their hits, else the ray to
    /// cast.
    fn step(&self, faces: [&CellFace; 2]) -> FanStep {
        let [left, right] = faces;
        let (width, last) = (self.width, self.width - 1);
        if left == right || width == 1 {
            return FanStep::Split(width);
        }
        // The face on the left ends before this column.
        let end_of_left = self.column_of(left.right_end()).unwrap_or(f64::INFINITY);
        let beyond_left = self.first_column_from(end_of_left);
        if (1..=width).contains(&beyond_left) {
            let is_clear = |column: usize| (end_of_left - column as f64).abs() > EPSILON;
            let are_known = left.is_beside(right)
                && is_clear(beyond_left - 1)
                && is_clear(beyond_left)
                && self.has_no_room_for_a_cell(faces);
            return if are_known {
                FanStep::Split(beyond_left)
            } else {
                FanStep::Cast(beyond_left.min(last))
            };
        }
        if beyond_left == 0 {
            return FanStep::Cast(1);
        }
        // The face on the right, or a third face, is in front.
        let start_of_right = self.column_of(right.left_end()).unwrap_or(0.0);
        let first_of_right = self.first_column_from(start_of_right);
        FanStep::Cast(if first_of_right == 0 {
            width / 2
        } else {
            (first_of_right - 1).clamp(1, last)
        })
    }

    /// Returns true if no cell in front of the line of both faces fits between the rays.
    fn has_no_room_for_a_cell(&self, [left, right]: [&CellFace; 2]) -> bool {
        let origin = self.fan.scene.projection.origin();
        let to_line = left.distance_to_line(origin);
        let point = |column: usize, face: &CellFace| {
            let direction = self.fan.directions.of(column);
            let t = (to_line / direction[face.side as usize]).abs();
            direction * t
        };
        let apart = point(self.first, left) - point(self.first + self.width, right);
        // The rounding error is far less than a hundredth.
        apart.abs().max_element() * (to_line - 1.0) < 0.99 * to_line
    }

    /// The position of `point`, in columns from the first ray. Integers are the centres of columns. `None` if
    /// the point is behind the camera.
    fn column_of(&self, point: DVec2) -> Option<f64> {
        let place = self.fan.scene.projection.place(point);
        (place.depth > 0.0).then_some(place.column - 0.5 - self.first as f64)
    }

    /// The first column whose centre is not before `position`, limited to one column after the second ray.
    fn first_column_from(&self, position: f64) -> usize {
        let position = position.max(0.0).min(self.width as f64 + 1.0);
        // On old processors `f64::ceil` is a call.
        let column = position as usize;
        column + usize::from((column as f64) < position)
    }
}

#[cfg(test)]
mod tests;
