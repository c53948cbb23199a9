//! The walk: the cells that a ray enters, in order.
//!
//! A walk counts columns and rows, which are integers and the same for every method. Methods differ
//! only in the line that they cross next, which an [`Order`] decides. Whatever the rounding of a
//! method, its walk goes from a cell to a neighbour, never looks up a cell off the map, and ends
//! after at most one step for each line of the map.
//!
//! Rejected: a loop for each method. Each would have to guarantee all of this again.

#[cfg(feature = "tui")]
mod from_inside;
mod mirrored;

use super::{ExactOrder, Order, Ray, Side};
use crate::world::{Cell, Grid, TileId};
#[cfg(feature = "tui")]
pub(crate) use from_inside::WalkFromInside;
#[cfg(feature = "tui")]
pub(crate) use mirrored::Crossed;
pub(crate) use mirrored::{Course, MirrorTransform, RayWalk};

/// A cell that a ray enters, and the kind of line that it crosses to enter it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crossing {
    /// The cell.
    pub cell: Cell,
    /// The tile of the cell.
    pub tile: TileId,
    /// The kind of line that the ray crosses.
    pub side: Side,
}

/// The cells of a map that a ray enters, from near to far, open ones included.
///
/// The walk ends where the ray leaves the map. [`Hit::entering`](super::Hit::entering) computes the
/// distance of a cell.
#[derive(Clone, Debug)]
pub struct Walk<'grid, O = ExactOrder> {
    grid: &'grid Grid,
    x: Axis,
    y: Axis,
    order: O,
}

impl<'grid> Walk<'grid> {
    /// The walk of `ray` through `grid`, in the exact order.
    pub fn new(grid: &'grid Grid, ray: &Ray) -> Self {
        Self::in_order(grid, ray, ExactOrder::new(grid, ray))
    }
}

impl<'grid, O: Order> Walk<'grid, O> {
    /// The walk of `ray` through `grid`, in an order made for both.
    pub fn in_order(grid: &'grid Grid, ray: &Ray, order: O) -> Self {
        let (origin, direction) = (ray.origin(), ray.direction());
        Self {
            grid,
            x: Axis::new(origin.x, direction.x, grid.width()),
            y: Axis::new(origin.y, direction.y, grid.height()),
            order,
        }
    }

    /// The order, in the state after the last step.
    pub fn order(&self) -> &O {
        &self.order
    }

    /// The cell that contains the ray; `None` off the map.
    pub(crate) fn cell(&self) -> Option<(Cell, TileId)> {
        self.grid.cell(self.x.index, self.y.index)
    }

    /// The next solid cell that the ray enters.
    #[inline]
    pub fn first_solid(&mut self) -> Option<Crossing> {
        let grid = self.grid;
        self.find(|crossing| grid.is_solid_tile(crossing.tile))
    }
}

impl<O: Order> Iterator for Walk<'_, O> {
    type Item = Crossing;

    #[inline]
    fn next(&mut self) -> Option<Crossing> {
        loop {
            let side = self.order.next(self.x.line, self.y.line);
            let axis = match side {
                Side::X => &mut self.x,
                Side::Y => &mut self.y,
            };
            axis.cross();
            if !axis.is_on_map() {
                return None;
            }
            if let Some((cell, tile)) = self.cell() {
                return Some(Crossing { cell, tile, side });
            }
        }
    }
}

/// A ray's progress along one axis of the grid.
#[derive(Clone, Debug)]
struct Axis {
    /// The column or row of the ray; off the map, any index off the map on that side.
    index: i64,
    /// The position of the next line; infinite if there is none.
    line: f64,
    /// The step to the next line: 1, −1, or 0 if the ray does not move on this axis.
    step: i64,
    /// The same as `step`, as a double.
    stride: f64,
    /// The number of columns or rows of the map.
    count: i64,
}

impl Axis {
    fn new(origin: f64, direction: f64, count: u32) -> Self {
        let line = first_line(origin, direction, count);
        let count = i64::from(count);
        let (before, step) = if direction > 0.0 {
            (line - 1.0, 1)
        } else if direction < 0.0 {
            (line, -1)
        } else {
            (origin.floor(), 0)
        };
        let index = (before as i64).clamp(-1, count);
        // Without movement no line can be crossed: an order that selects this axis ends the walk.
        let count = if step == 0 { 0 } else { count };
        Self { index, line, step, stride: step as f64, count }
    }

    /// The axis of a ray in the column or row `index`, which may be off the map.
    #[inline]
    fn resumed((direction, count): (f64, u32), index: i64) -> Self {
        let step = i64::from(direction > 0.0) - i64::from(direction < 0.0);
        let line = match step {
            1 => (index + 1) as f64,
            -1 => index as f64,
            _ => f64::INFINITY,
        };
        let count = if step == 0 { 0 } else { i64::from(count) };
        Self { index, line, step, stride: step as f64, count }
    }

    /// Advances to the column or row with this index, which must be ahead.
    #[cfg(feature = "tui")]
    fn enter(&mut self, index: u32) {
        let index = i64::from(index);
        self.index = index;
        if self.step != 0 {
            self.line = if self.step > 0 { (index + 1) as f64 } else { index as f64 };
        }
    }

    fn cross(&mut self) {
        self.index += self.step;
        self.line += self.stride;
    }

    /// Returns whether the ray is on the map along this axis. It is on the map from its first
    /// crossing of a line on this axis, at the edge or later, until it leaves the map for good.
    fn is_on_map(&self) -> bool {
        (0..self.count).contains(&self.index)
    }
}

/// The first line of a map that a ray meets along one axis; infinite if it meets none.
///
/// A ray that starts off the map starts with the edge: the empty space before it takes no steps,
/// whatever its length.
pub fn first_line(origin: f64, direction: f64, count: u32) -> f64 {
    if direction > 0.0 {
        origin.ceil().max(0.0)
    } else if direction < 0.0 {
        origin.floor().min(f64::from(count))
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;
    use proptest::prelude::*;

    use super::*;

    /// An order of random choices.
    struct Whim(u64);

    impl Order for Whim {
        fn next(&mut self, _: f64, _: f64) -> Side {
            self.0 = self.0.rotate_left(1);
            if self.0.is_multiple_of(2) { Side::X } else { Side::Y }
        }
    }

    proptest! {
        /// For any ray and order, the walk ends after at most one step for each line, and each step
        /// leads to a neighbour.
        #[test]
        fn every_walk_ends(
            origin in (any::<f64>(), any::<f64>()),
            near in (-2.0..6.0, -2.0..5.0),
            is_near in any::<bool>(),
            direction in (any::<f64>(), any::<f64>()),
            whim in any::<u64>(),
        ) {
            let grid = Grid::sketch(&["....", "....", "...."]).unwrap();
            let origin = DVec2::from(if is_near { near } else { origin });
            let ray = Ray::new(origin, DVec2::from(direction));
            prop_assume!(ray.is_ok());
            let ray = ray.unwrap();
            let exact: Vec<Crossing> = Walk::new(&grid, &ray).collect();
            let at_a_whim: Vec<Crossing> = Walk::in_order(&grid, &ray, Whim(whim)).collect();
            for entered in [exact, at_a_whim] {
                prop_assert!(entered.len() <= 7);
                for pair in entered.windows(2) {
                    let steps = pair[0].cell.column.abs_diff(pair[1].cell.column)
                        + pair[0].cell.row.abs_diff(pair[1].cell.row);
                    prop_assert_eq!(steps, 1);
                }
            }
        }
    }
}
