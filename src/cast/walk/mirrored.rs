//! The walk through mirrors: the ray continues straight, and the map is mirrored.
//!
//! Behind a mirror the map repeats in mirror image. A ray that meets a mirror is therefore not
//! bent: it keeps its origin, its direction and its `t`, and crosses the same lines in the same
//! exact order. Only the lookup of its cell on the map is mirrored. A view in a mirror is computed
//! like a view into a room built behind it, bit for bit.
//!
//! Rejected: a new ray that starts at the mirror. Its origin would be rounded, and each bounce
//! would add to the error.

use glam::DVec2;

use super::{Axis, Order};
use crate::cast::ray::meeting;
use crate::cast::{ExactOrder, Ray, Side};
use crate::world::{Cell, Grid, TileId};

/// The place of all rays from one origin that have crossed the same lines, reflections included.
///
/// The caller decides which line they cross next, because that depends on the direction of each
/// ray.
#[derive(Clone, Debug)]
pub(crate) struct Course {
    x: Axis,
    y: Axis,
    column: OnMap,
    row: OnMap,
}

/// The cells that a ray enters, in the exact order.
#[derive(Clone, Debug)]
pub(crate) struct RayWalk {
    ray: Ray,
    order: ExactOrder,
    course: Course,
}

/// The column or row of the map that contains a ray, after all reflections.
#[derive(Clone, Copy, Debug)]
struct OnMap {
    index: i64,
    /// The step to the next column or row on the map.
    step: i64,
}

impl RayWalk {
    /// The walk of `ray` through `grid`.
    pub(crate) fn new(grid: &Grid, ray: &Ray) -> Self {
        let (order, course) = (ExactOrder::new(grid, ray), Course::new(grid, ray));
        Self { ray: *ray, order, course }
    }

    /// The walk of `ray` through `grid` from its entry into `cell` by a line of kind `side`. The ray must
    /// enter the cell by such a line.
    #[cfg(feature = "tui")]
    #[inline]
    pub(crate) fn entering(grid: &Grid, ray: &Ray, at: (Cell, Side)) -> Self {
        let (order, (course, _)) = (ExactOrder::new(grid, ray), Course::entering(grid, ray, at));
        Self { ray: *ray, order, course }
    }

    /// The cell that contains the ray; `None` off the map.
    #[inline]
    pub(crate) fn cell(&self, grid: &Grid) -> Option<(Cell, TileId)> {
        self.course.cell(grid)
    }

    /// Advances until the ray enters a cell or leaves the map for good.
    pub(crate) fn cross(&mut self, grid: &Grid) -> Crossed {
        loop {
            let [x, y] = self.course.lines();
            let side = self.order.next(x, y);
            if let Some(crossed) = self.course.cross(grid, side) {
                return crossed;
            }
        }
    }

    /// The distance along the ray to a line that it has just crossed, as in [`Hit`](crate::cast::Hit), and the
    /// distance from the north or west end of the cell's face to that point.
    #[inline]
    pub(crate) fn meeting(&self, crossed: &Crossed) -> (f64, f64) {
        meeting(&self.ray, crossed.side, self.course.corner(crossed))
    }

    /// The ray.
    #[cfg(feature = "tui")]
    pub(crate) fn ray(&self) -> &Ray {
        &self.ray
    }
}

impl Course {
    /// The course of `ray` at the start, and of all rays from its origin that move towards the same
    /// sides.
    pub(crate) fn new(grid: &Grid, ray: &Ray) -> Self {
        let (origin, direction) = (ray.origin(), ray.direction());
        let x = Axis::new(origin.x, direction.x, grid.width());
        let y = Axis::new(origin.y, direction.y, grid.height());
        Self {
            column: OnMap { index: x.index, step: x.step },
            row: OnMap { index: y.index, step: y.step },
            x,
            y,
        }
    }

    /// The course of `ray` from its entry into `cell` by a line of kind `side`, and that line, which the
    /// ray has just crossed. The ray must enter the cell by such a line.
    #[cfg(feature = "tui")]
    fn entering(grid: &Grid, ray: &Ray, (cell, side): (Cell, Side)) -> (Self, Crossed) {
        let mut course = Self::new(grid, ray);
        course.x.enter(cell.column);
        course.y.enter(cell.row);
        course.column.index = course.x.index;
        course.row.index = course.y.index;
        let axis = match side {
            Side::X => &course.x,
            Side::Y => &course.y,
        };
        let line = axis.line - axis.stride;
        let into = course.cell(grid);
        (course, Crossed { side, into, line })
    }

    /// The course of a ray along `direction` in the cell at `place`, a column and a row along the
    /// straight ray, in the image of `transform`.
    pub(crate) fn resumed(
        grid: &Grid,
        direction: DVec2,
        transform: MirrorTransform,
        place: [i64; 2],
    ) -> Self {
        let [x, y] = [(direction.x, grid.width()), (direction.y, grid.height())];
        let x = Axis::resumed(x, place[0]);
        let y = Axis::resumed(y, place[1]);
        let [column, row] = transform.cell_to_map(place);
        let on_map = |index: i64, step: i64, axis: AxisTransform| OnMap {
            index,
            step: if axis.is_mirrored { -step } else { step },
        };
        Self {
            column: on_map(column, x.step, transform.x),
            row: on_map(row, y.step, transform.y),
            x,
            y,
        }
    }

    /// The column and the row of the cell along the straight rays.
    #[inline]
    pub(crate) fn place(&self) -> [i64; 2] {
        [self.x.index, self.y.index]
    }

    /// The cell that contains the rays; `None` off the map.
    #[inline]
    pub(crate) fn cell(&self, grid: &Grid) -> Option<(Cell, TileId)> {
        grid.cell(self.column.index, self.row.index)
    }

    /// The coordinates of the x line and the y line ahead.
    #[inline]
    pub(crate) fn lines(&self) -> [f64; 2] {
        [self.x.line, self.y.line]
    }

    /// Crosses the next line of kind `side`. `None` if the rays have yet to enter the map.
    #[inline]
    pub(crate) fn cross(&mut self, grid: &Grid, side: Side) -> Option<Crossed> {
        let (axis, on_map) = match side {
            Side::X => (&mut self.x, &mut self.column),
            Side::Y => (&mut self.y, &mut self.row),
        };
        let line = axis.line;
        axis.cross();
        on_map.index += on_map.step;
        let into = self.cell(grid);
        (into.is_some() || !self.is_on_map_along(side)).then_some(Crossed { side, into, line })
    }

    /// Returns whether the rays are on the map along the axis that crosses lines of kind `side`.
    fn is_on_map_along(&self, side: Side) -> bool {
        match side {
            Side::X => (0..self.x.count).contains(&self.column.index),
            Side::Y => (0..self.y.count).contains(&self.row.index),
        }
    }

    /// The north or west end of the face that the rays have just crossed.
    #[inline]
    fn corner(&self, crossed: &Crossed) -> DVec2 {
        match crossed.side {
            Side::X => DVec2::new(crossed.line, self.y.index as f64),
            Side::Y => DVec2::new(self.x.index as f64, crossed.line),
        }
    }
}

/// The transform of an image in mirrors: from points along the straight ray to points on the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) struct MirrorTransform {
    x: AxisTransform,
    y: AxisTransform,
}

/// The transform along one axis: a coordinate is offset, or mirrored at 0 and then offset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
struct AxisTransform {
    is_mirrored: bool,
    offset: i64,
}

impl MirrorTransform {
    /// The point on the map for a point along the straight ray.
    pub(crate) fn to_map(self, point: DVec2) -> DVec2 {
        DVec2::new(self.x.to_map(point.x), self.y.to_map(point.y))
    }

    /// The point along the straight ray for a point on the map.
    pub(crate) fn in_image(self, point: DVec2) -> DVec2 {
        DVec2::new(self.x.in_image(point.x), self.y.in_image(point.y))
    }

    /// Returns whether lines of kind `side` are mirrored along themselves.
    pub(crate) fn is_mirrored_along(self, side: Side) -> bool {
        match side {
            Side::X => self.y.is_mirrored,
            Side::Y => self.x.is_mirrored,
        }
    }

    /// Adds a mirror at `line`, of kind `side`. Returns the column or row of the map behind it for
    /// column or row `index` along the straight ray.
    pub(crate) fn reflect(&mut self, side: Side, line: i64, index: i64) -> i64 {
        let along = match side {
            Side::X => &mut self.x,
            Side::Y => &mut self.y,
        };
        *along = along.mirrored_at(line);
        along.index_on_map(index)
    }

    /// The column and the row on the map for a column and a row along the straight ray.
    #[inline]
    pub(crate) fn cell_to_map(self, [column, row]: [i64; 2]) -> [i64; 2] {
        [self.x.index_on_map(column), self.y.index_on_map(row)]
    }

    /// Returns whether left and right are exchanged.
    pub(crate) fn swaps_sides(self) -> bool {
        self.x.is_mirrored != self.y.is_mirrored
    }

    /// The direction on the map for a direction along the straight ray.
    pub(crate) fn direction_to_map(self, direction: DVec2) -> DVec2 {
        let along =
            |transform: AxisTransform, part: f64| if transform.is_mirrored { -part } else { part };
        DVec2::new(along(self.x, direction.x), along(self.y, direction.y))
    }
}

impl AxisTransform {
    fn to_map(self, place: f64) -> f64 {
        let offset = self.offset as f64;
        if self.is_mirrored { offset - place } else { offset + place }
    }

    fn in_image(self, place: f64) -> f64 {
        let offset = self.offset as f64;
        if self.is_mirrored { offset - place } else { place - offset }
    }

    /// The column or row of the map for column or row `index` along the straight ray.
    fn index_on_map(self, index: i64) -> i64 {
        if self.is_mirrored { self.offset - 1 - index } else { self.offset + index }
    }

    /// The transform behind a mirror at `line`.
    fn mirrored_at(self, line: i64) -> Self {
        let moved = if self.is_mirrored { -2 * line } else { 2 * line };
        Self { is_mirrored: !self.is_mirrored, offset: self.offset + moved }
    }
}

/// A line that a walk has crossed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossed {
    /// The kind of line.
    pub(crate) side: Side,
    /// The cell behind the line; `None` for the edge of the map, where the walk ends.
    pub(crate) into: Option<(Cell, TileId)>,
    /// The coordinate of the line along the straight ray.
    pub(crate) line: f64,
}

#[cfg(test)]
mod tests;
