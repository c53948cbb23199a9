//! The walk through mirrors: the ray continues straight, and the map is mirrored.
//!
//! Behind a mirror the map repeats in mirror image. A ray that meets a mirror is therefore not
//! bent: it keeps its origin, its direction and its `t`, and crosses the same lines in the same
//! exact order. Only the lookup of its cell on the map is mirrored. A view in a mirror is computed
//! like a view into a room built behind it, bit for bit.
//!
//! A new ray that starts at the mirror was refused: its origin would be rounded, and each bounce
//! would add to the error.

use glam::DVec2;

use super::Axis;
use crate::cast::hit::{meeting, texture_coordinate};
use crate::cast::{ExactOrder, Order, Passage, Ray, Side, door};
use crate::world::{Cell, Grid, TileId, TileKind, World};

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

/// A line that a walk has crossed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossed {
    /// The kind of line.
    pub(crate) side: Side,
    /// The cell behind the line; `None` for the edge of the map, where the walk ends.
    pub(crate) into: Option<(Cell, TileId)>,
    /// The coordinate of the line along the straight ray.
    line: f64,
}

/// The cells that a ray enters, in the exact order, reflections included.
#[derive(Clone, Debug)]
pub(crate) struct MirroredWalk {
    ray: Ray,
    order: ExactOrder,
    x: Axis,
    y: Axis,
    transform: MirrorTransform,
    column: OnMap,
    row: OnMap,
    bounces: u32,
}

/// The column or row of the map that contains a ray, after all reflections.
#[derive(Clone, Copy, Debug)]
struct OnMap {
    index: i64,
    /// The step to the next one on the map.
    step: i64,
}

impl MirroredWalk {
    /// The walk of `ray` through `grid`, with at most this number of reflections.
    pub(crate) fn new(grid: &Grid, ray: &Ray, most_bounces: u32) -> Self {
        let size = DVec2::new(f64::from(grid.width()), f64::from(grid.height()));
        let (origin, direction) = (ray.origin(), ray.direction());
        let x = Axis::new(origin.x, direction.x, grid.width());
        let y = Axis::new(origin.y, direction.y, grid.height());
        Self {
            ray: *ray,
            order: ExactOrder::within(size * f64::from(most_bounces + 1), ray),
            transform: MirrorTransform::default(),
            column: OnMap { index: x.index, step: x.step },
            row: OnMap { index: y.index, step: y.step },
            x,
            y,
            bounces: 0,
        }
    }

    /// The walk of `ray` through `grid` from its entry into `cell` by a line of kind `side`, and
    /// that line, which the walk has just crossed. The ray must enter the cell by such a line.
    #[inline]
    pub(crate) fn entering(
        grid: &Grid,
        ray: &Ray,
        most_bounces: u32,
        (cell, side): (Cell, Side),
    ) -> (Self, Crossed) {
        let mut walk = Self::new(grid, ray, most_bounces);
        walk.x.enter(cell.column);
        walk.y.enter(cell.row);
        walk.column.index = walk.x.index;
        walk.row.index = walk.y.index;
        let axis = match side {
            Side::X => &walk.x,
            Side::Y => &walk.y,
        };
        let line = axis.line - axis.stride;
        let into = walk.cell(grid);
        (walk, Crossed { side, into, line })
    }

    /// The cell that contains the ray; `None` off the map.
    #[inline]
    pub(crate) fn cell(&self, grid: &Grid) -> Option<(Cell, TileId)> {
        let (column, row) = (self.column.index, self.row.index);
        let tile = grid.tile(column, row)?;
        Some((Cell { column: column as u32, row: row as u32 }, tile))
    }

    /// Advances until the ray enters a cell or leaves the map for good.
    pub(crate) fn cross(&mut self, grid: &Grid) -> Crossed {
        loop {
            let side = self.order.next(self.x.line, self.y.line);
            let (axis, on_map) = match side {
                Side::X => (&mut self.x, &mut self.column),
                Side::Y => (&mut self.y, &mut self.row),
            };
            let line = axis.line;
            axis.cross();
            on_map.index += on_map.step;
            let into = self.cell(grid);
            if into.is_some() || !self.is_on_map_along(side) {
                return Crossed { side, into, line };
            }
        }
    }

    /// Whether the ray is on the map along the axis that crosses lines of kind `side`.
    fn is_on_map_along(&self, side: Side) -> bool {
        match side {
            Side::X => (0..self.x.count).contains(&self.column.index),
            Side::Y => (0..self.y.count).contains(&self.row.index),
        }
    }

    /// The distance along the ray of a line that it has just crossed, as in
    /// [`Hit`](crate::cast::Hit).
    #[inline]
    pub(crate) fn distance(&self, crossed: &Crossed) -> f64 {
        meeting(&self.ray, crossed.side, self.corner(crossed)).0
    }

    /// The position along its face at which the ray has just crossed a line, as in
    /// [`Hit`](crate::cast::Hit).
    pub(crate) fn along_face(&self, crossed: &Crossed) -> f64 {
        let (_, along) = meeting(&self.ray, crossed.side, self.corner(crossed));
        let transform = match crossed.side {
            Side::X => self.transform.y,
            Side::Y => self.transform.x,
        };
        let along = along.clamp(0.0, 1.0);
        let along = if transform.is_mirrored { 1.0 - along } else { along };
        texture_coordinate(self.direction(), crossed.side, along)
    }

    /// The north or west end of the face that the ray has just crossed.
    #[inline]
    fn corner(&self, crossed: &Crossed) -> DVec2 {
        match crossed.side {
            Side::X => DVec2::new(crossed.line, self.y.index as f64),
            Side::Y => DVec2::new(self.x.index as f64, crossed.line),
        }
    }

    /// Reflects the ray at the line of kind `side` that it has just crossed.
    pub(crate) fn reflect(&mut self, side: Side) {
        let (axis, transform, on_map) = match side {
            Side::X => (&self.x, &mut self.transform.x, &mut self.column),
            Side::Y => (&self.y, &mut self.transform.y, &mut self.row),
        };
        *transform = transform.mirrored_at(axis.line as i64 - axis.step);
        *on_map = OnMap { index: transform.index_on_map(axis.index), step: -on_map.step };
        self.bounces += 1;
    }

    /// The hit of the ray, where it is now, on an object that stands in `cell` without filling it:
    /// the leaf of a door, which has no interior, or a shape.
    pub(crate) fn standing(&self, world: &World, cell: Cell, kind: TileKind) -> Passage {
        let ray = self.ray_on_map();
        match kind {
            TileKind::Door(_) => {
                let hit = door::meet(world.grid(), &ray, cell, world.opening(cell));
                Passage { hit, end: None }
            }
            TileKind::Shape(it) => Passage::new(&ray, cell, it.outline),
            _ => Passage::NONE,
        }
    }

    /// The ray on the map after all reflections, as if it had come straight.
    pub(crate) fn ray_on_map(&self) -> Ray {
        Ray::moved(self.transform.to_map(self.ray.origin()), self.direction())
    }

    /// The transform of the image in which the ray is.
    pub(crate) fn transform(&self) -> MirrorTransform {
        self.transform
    }

    /// The number of reflections so far.
    pub(crate) fn bounces(&self) -> u32 {
        self.bounces
    }

    /// The direction of the ray on the map, after all reflections.
    fn direction(&self) -> DVec2 {
        self.transform.direction_to_map(self.ray.direction())
    }
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

    /// Whether left and right are exchanged.
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

    /// The column or row of the map for the one at `index` along the straight ray.
    fn index_on_map(self, index: i64) -> i64 {
        if self.is_mirrored { self.offset - 1 - index } else { self.offset + index }
    }

    /// The transform behind a mirror at `line`.
    fn mirrored_at(self, line: i64) -> Self {
        let moved = if self.is_mirrored { -2 * line } else { 2 * line };
        Self { is_mirrored: !self.is_mirrored, offset: self.offset + moved }
    }
}

#[cfg(test)]
mod tests;
