//! The exact caster: the order of lines in rational arithmetic, mostly at the cost of doubles.
//!
//! [`MajorAxisTraversal`] finds the walls, without stopping in every cell. A ray that starts off
//! the map, or on a very large map, uses the [`Walk`] instead. If rounding leaves a doubt, both
//! evaluate the same exact predicate at the same corners, so their results are equal. In rooms,
//! among pillars and in corridors (`crates/lab/benches/casters.rs`), a ray takes 0.6 to 0.9 times
//! the time of `dda`, which is why this caster is the default.

use std::iter;

use super::{Caster, Crossing, Hit, MajorAxisTraversal, Ray, Walk, through};
use crate::world::{Grid, World};

/// The exact caster, and the default.
///
/// For every ray, it hits the cell and the side that are correct in rational arithmetic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exact;

impl Caster for Exact {
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        let wall = match MajorAxisTraversal::new(grid, ray) {
            Some(mut traversal) => traversal.next()?,
            None => walk_to_first_solid(grid, ray)?,
        };
        Some(Hit::entering(ray, wall.cell, wall.side))
    }

    fn cast_through(&self, world: &World, ray: &Ray, passed: &mut dyn FnMut(Hit)) -> Option<Hit> {
        let grid = world.grid();
        if let Some(traversal) = MajorAxisTraversal::new(grid, ray) {
            return through::cast(traversal.cell(), traversal, world, ray, passed);
        }
        let mut walk = Walk::new(grid, ray);
        let (start, solid_cells) = (walk.cell(), iter::from_fn(|| walk.first_solid()));
        through::cast(start, solid_cells, world, ray, passed)
    }
}

/// The first solid cell of a ray that the traversal does not support.
#[cold]
#[inline(never)]
fn walk_to_first_solid(grid: &Grid, ray: &Ray) -> Option<Crossing> {
    Walk::new(grid, ray).first_solid()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cast::Side;

    fn side(rows: &[&str], origin: (f64, f64), direction: (f64, f64)) -> Option<Side> {
        let ray = Ray::new(origin.into(), direction.into()).unwrap();
        Exact.cast(&Grid::sketch(rows).unwrap(), &ray).map(|hit| hit.side)
    }

    #[test]
    fn one_ulp_beside_a_corner_changes_the_side() {
        let diagonal = ["...", ".#.", "..."];
        let enters_by = |y| side(&diagonal, (0.5, y), (1.0, 1.0));
        assert_eq!(enters_by(0.5_f64.next_down()), Some(Side::Y));
        assert_eq!(enters_by(0.5), Some(Side::X));
        assert_eq!(enters_by(0.5_f64.next_up()), Some(Side::X));
    }

    /// A component that underflows when it is scaled still moves a ray that starts far away.
    #[test]
    fn the_uncertainty_covers_underflow() {
        assert_eq!(side(&["#"], (-1.7e308, -6e-16), (1.0, 5e-324)), Some(Side::X));
        assert_eq!(side(&["#"], (-6e-16, -1.7e308), (5e-324, 1.0)), Some(Side::Y));
    }
}
