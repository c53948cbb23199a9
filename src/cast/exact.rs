//! The exact order of lines: what rational arithmetic says, at the price of doubles.
//!
//! Walls are found by the [`Sweep`], which need not stop in every cell; a ray from outside the map, or on
//! a very large one, [walks](Walk). Both ask the same question of the same corners in case of doubt, so
//! which of them it was cannot be told from the answer. In rooms, among pillars and in corridors
//! (`benches/casters.rs`) a ray takes 0.6 to 0.9 times what it takes `dda`. That is why this is the
//! default.
//!
//! In the walk, the order of the next two lines is computed in double precision first, as in `dda`, and
//! believed where the two are further apart than all rounding can have moved them. Else the ray passes
//! so near to the corner where the two lines meet that only the sign of a cross product tells on which
//! side, and that one is computed without rounding. Ordinary rays never get there, and pay one
//! comparison a line.
//!
//! The bound on the rounding is computed once for each ray, from the size of the map. One for each
//! line, tighter near the start, was refused: it costs more than the exact cross products it saves.

use std::iter;

use glam::DVec2;

use super::cross::cross;
use super::{Caster, Crossing, DdaOrder, Hit, Order, Ray, Side, Sweep, Walk, through};
use crate::world::{Cell, Grid, TileId, World};

/// Casts by walking the grid in the exact order; the default.
///
/// It hits the cell and side that rational arithmetic says, for every ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exact;

impl Caster for Exact {
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        let wall = match Sweep::new(grid, ray) {
            Some(mut sweep) => sweep.next()?,
            None => walk_to_first_solid(grid, ray)?,
        };
        Some(Hit::entering(ray, wall.cell, wall.side))
    }

    /// If both hit one face, nothing is in the way of what goes between them. It would be as wide as the
    /// face and nearer, so that it would be in the way of one of the two.
    #[inline]
    fn follows_between(&self, left: &Hit, right: &Hit) -> bool {
        (left.cell, left.side) == (right.cell, right.side)
    }

    fn cast_through(&self, world: &World, ray: &Ray, passed: impl FnMut(Hit)) -> Option<Hit> {
        let grid = world.grid();
        if let Some(sweep) = Sweep::new(grid, ray) {
            return through::cast(sweep.cell(), sweep, world, ray, |_| false, passed);
        }
        let mut walk = Walk::new(grid, ray);
        let (start, solid_cells) = (walk.cell(), iter::from_fn(|| walk.first_solid()));
        through::cast(start, solid_cells, world, ray, |_| false, passed)
    }
}

/// Casts as [`Exact`] does, and ends where a ray enters what is not level: in `grid`, which has that for
/// solid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ExactOnLevel<'a> {
    pub(crate) grid: &'a Grid,
}

impl Caster for ExactOnLevel<'_> {
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        Exact.cast(grid, ray)
    }

    #[inline]
    fn follows_between(&self, left: &Hit, right: &Hit) -> bool {
        Exact.follows_between(left, right)
    }

    fn cast_through(&self, world: &World, ray: &Ray, passed: impl FnMut(Hit)) -> Option<Hit> {
        let tile_of = |cell: Cell| world.grid().tile(i64::from(cell.column), i64::from(cell.row));
        let mut walk = Walk::new(self.grid, ray);
        let start = walk.cell();
        let solid_cells = iter::from_fn(|| {
            let crossing = walk.first_solid()?;
            Some(Crossing { tile: tile_of(crossing.cell)?, ..crossing })
        });
        let ends = |tile: TileId| !world.tile(tile).is_level();
        through::cast(start, solid_cells, world, ray, ends, passed)
    }
}

/// The first solid cell of a ray that does not start well inside a cell of the map.
#[cold]
#[inline(never)]
fn walk_to_first_solid(grid: &Grid, ray: &Ray) -> Option<Crossing> {
    Walk::new(grid, ray).first_solid()
}

/// The order in which a ray meets the lines of a grid.
#[derive(Clone, Debug)]
pub struct ExactOrder {
    ray: Ray,
    rounded: DdaOrder,
    /// Two rounded distances that are further apart than this are in the right order.
    doubt: f64,
}

impl ExactOrder {
    /// The order for `ray` in `grid`.
    pub fn new(grid: &Grid, ray: &Ray) -> Self {
        Self::within(DVec2::new(f64::from(grid.width()), f64::from(grid.height())), ray)
    }

    /// The order for `ray` among lines that are no further from 0 than `size`.
    pub(super) fn within(size: DVec2, ray: &Ray) -> Self {
        let rounded = DdaOrder::new(ray);
        // No line is further than that. A distance to one is rounded once when it is taken and once
        // when it is weighed; all together, twice an epsilon is twice as much as that comes to. What
        // vanishes for being too small a double is less than the second term.
        let furthest = size + ray.origin().abs();
        let error = rounded.weight.abs() * (2.0 * f64::EPSILON) + DVec2::splat(f64::MIN_POSITIVE);
        Self { ray: *ray, rounded, doubt: furthest.dot(error) }
    }
}

/// Which of the lines at `x` and `y` the ray crosses first, without rounding.
///
/// It takes the ray by its parts, because a reference would keep the walk in memory.
#[cold]
#[inline(never)]
pub(super) fn decide(origin: DVec2, direction: DVec2, x: f64, y: f64) -> Side {
    let cross = cross(origin, direction, DVec2::new(x, y)).sign();
    // Seen from a ray to the north-east or to the south-west, left and right are swapped.
    let x_behind_y = if (direction.x > 0.0) == (direction.y > 0.0) { cross } else { -cross };
    if x_behind_y >= 0.0 { Side::Y } else { Side::X }
}

impl Order for ExactOrder {
    #[inline]
    fn next(&mut self, x: f64, y: f64) -> Side {
        // The order is taken before the doubt, so that it can be selected and need not be predicted:
        // which line is next looks random to a processor, and whether there is doubt does not.
        let (to_x, to_y) = self.rounded.distances(x, y);
        let side = if to_y <= to_x { Side::Y } else { Side::X };
        if (to_x - to_y).abs() > self.doubt {
            side
        } else {
            decide(self.ray.origin(), self.ray.direction(), x, y)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn side(rows: &[&str], origin: (f64, f64), direction: (f64, f64)) -> Option<Side> {
        let ray = Ray::new(origin.into(), direction.into()).unwrap();
        Exact.cast(&Grid::sketch(rows).unwrap(), &ray).map(|hit| hit.side)
    }

    #[test]
    fn an_ulp_beside_a_corner_counts() {
        let diagonal = ["...", ".#.", "..."];
        let enters_by = |y| side(&diagonal, (0.5, y), (1.0, 1.0));
        assert_eq!(enters_by(0.5_f64.next_down()), Some(Side::Y));
        assert_eq!(enters_by(0.5), Some(Side::X));
        assert_eq!(enters_by(0.5_f64.next_up()), Some(Side::X));
    }

    /// A component so small that it vanishes when scaled still moves a ray from afar.
    #[test]
    fn what_vanishes_is_in_the_doubt() {
        assert_eq!(side(&["#"], (-1.7e308, -6e-16), (1.0, 5e-324)), Some(Side::X));
        assert_eq!(side(&["#"], (-6e-16, -1.7e308), (5e-324, 1.0)), Some(Side::Y));
    }
}
