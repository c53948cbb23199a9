//! The walk of a camera's ray from a place on the map.
//!
//! It enters the cells of [`Walk`](super::Walk) in the same order, in a third of the instructions.
//! Such a ray stays on the map until it leaves for good, and crossing a line changes the state of
//! both axes by sums, without a branch on the side.

use glam::DVec2;

use super::{Axis, Crossing, Order};
use crate::cast::{ExactOrder, Ray, Side};
use crate::world::{Cell, Grid, TileId};

/// The cells that a ray enters after its first cell, with the distance of each, as in
/// [`Hit::entering`](crate::cast::Hit::entering).
pub(crate) struct WalkFromInside<'grid> {
    tiles: &'grid [TileId],
    width: u32,
    height: u32,
    ray: Ray,
    order: ExactOrder,
    x: Position,
    y: Position,
}

/// The place of the ray along one axis.
struct Position {
    /// The column or row.
    index: u32,
    /// The step to the next column or row, modulo 2³²; 0 if the ray does not move on this axis.
    step: u32,
    /// The position of the next line; infinite if there is none.
    line: f64,
    /// The bits of the distance from line to line.
    stride: u64,
}

impl<'grid> WalkFromInside<'grid> {
    /// The walk of `ray`, and its first cell with the tile; `None` if it starts off the map.
    #[inline]
    pub(crate) fn new(grid: &'grid Grid, ray: &Ray) -> Option<(Self, Cell, TileId)> {
        let (origin, direction) = (ray.origin(), ray.direction());
        let x = Position::new(&Axis::new(origin.x, direction.x, grid.width()))?;
        let y = Position::new(&Axis::new(origin.y, direction.y, grid.height()))?;
        let cell = Cell { column: x.index, row: y.index };
        let tile = grid.tile_in(cell)?;
        let order = ExactOrder::of_camera(grid, ray);
        let (width, height) = (grid.width(), grid.height());
        Some((Self { tiles: grid.cells(), width, height, ray: *ray, order, x, y }, cell, tile))
    }
}

impl Iterator for WalkFromInside<'_> {
    type Item = (Crossing, f64);

    #[inline]
    fn next(&mut self) -> Option<(Crossing, f64)> {
        let side = self.order.next(self.x.line, self.y.line);
        // A division of two numbers takes less time than a branch on the side.
        let lines = DVec2::new(self.x.line, self.y.line);
        let distances = (lines - self.ray.origin()) / self.ray.direction();
        let distance = if side == Side::Y { distances.y } else { distances.x };
        self.x.advance_if(side == Side::X);
        self.y.advance_if(side == Side::Y);
        let cell = Cell { column: self.x.index, row: self.y.index };
        if cell.column >= self.width || cell.row >= self.height {
            return None;
        }
        let place = cell.row as usize * self.width as usize + cell.column as usize;
        let &tile = self.tiles.get(place)?;
        Some((Crossing { cell, tile, side }, distance.abs()))
    }
}

impl Position {
    /// The position of a ray at the start of `axis`; `None` off the map.
    #[inline]
    fn new(axis: &Axis) -> Option<Self> {
        let &Axis { index, line, step, stride, .. } = axis;
        Some(Self {
            index: u32::try_from(index).ok()?,
            step: step as u32,
            line,
            stride: stride.to_bits(),
        })
    }

    /// Crosses the next line if `crosses`.
    #[inline]
    fn advance_if(&mut self, crosses: bool) {
        let mask = u64::from(crosses).wrapping_neg();
        self.index = self.index.wrapping_add(self.step & mask as u32);
        self.line += f64::from_bits(self.stride & mask);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::Walk;
    use super::*;
    use crate::cast::Hit;

    proptest! {
        #[test]
        fn it_enters_the_same_cells_as_a_walk(
            origin in (-1.0..6.0, -1.0..5.0),
            on_lines in any::<[bool; 2]>(),
            direction in (-1.0..1.0, -1.0..1.0),
            along_axis in 0..4,
        ) {
            let mut origin = DVec2::from(origin);
            let mut direction = DVec2::from(direction);
            for (axis, is_on_line) in on_lines.into_iter().enumerate() {
                if is_on_line {
                    origin[axis] = f64::round(origin[axis]);
                }
            }
            if let Ok(axis @ 0..2) = usize::try_from(along_axis) {
                direction[axis] = 0.0;
            }
            let grid = Grid::sketch(&["....", "..#.", "...."]).unwrap();
            let ray = Ray::new(origin, direction);
            prop_assume!(ray.is_ok());
            let ray = ray.unwrap();
            let walk = Walk::new(&grid, &ray);
            let inside = WalkFromInside::new(&grid, &ray);
            prop_assert_eq!(inside.as_ref().map(|it| (it.1, it.2)), walk.cell());
            if let Some((inside, ..)) = inside {
                let with_distance = walk.map(|it| (it, Hit::entering(&ray, it.cell, it.side).t));
                prop_assert!(inside.eq(with_distance));
            }
        }
    }
}
