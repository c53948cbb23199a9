//! A caster that counts its rays, for frame stats.

use std::cell::Cell;

use super::FrameStats;
use crate::cast::{AnyCaster, Caster, Hit, MajorAxisTraversal, Ray, Walk};
use crate::world::{Grid, World};

/// Casts as another caster does, and counts the cells of the exact rays, whatever that caster's
/// method.
pub(crate) struct RayCounter<'a> {
    caster: &'a dyn AnyCaster,
    grid: &'a Grid,
    rays: Cell<u64>,
    cells: Cell<u64>,
    looks: Cell<u64>,
}

impl<'a> RayCounter<'a> {
    pub(crate) fn new(caster: &'a dyn AnyCaster, grid: &'a Grid) -> Self {
        Self { caster, grid, rays: Cell::default(), cells: Cell::default(), looks: Cell::default() }
    }

    /// Adds the counts to `stats`.
    pub(crate) fn add_to(&self, stats: &mut FrameStats) {
        stats.rays += self.rays.get();
        stats.cells += self.cells.get();
        stats.looks += self.looks.get();
    }

    fn count(&self, ray: &Ray) {
        let grid = self.grid;
        let mut entered = 0;
        for crossing in Walk::new(grid, ray) {
            entered += 1;
            if grid.is_solid_tile(crossing.tile) {
                break;
            }
        }
        let looked = MajorAxisTraversal::new(grid, ray).map_or(entered, |mut traversal| {
            traversal.next();
            traversal.lookups()
        });
        self.rays.update(|rays| rays + 1);
        self.cells.update(|cells| cells + entered);
        self.looks.update(|looks| looks + looked);
    }
}

impl Caster for RayCounter<'_> {
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        self.count(ray);
        self.caster.cast_any(grid, ray)
    }

    fn is_exact(&self) -> bool {
        self.caster.is_exact_any()
    }

    fn cast_through(&self, world: &World, ray: &Ray, mut passed: impl FnMut(Hit)) -> Option<Hit> {
        self.count(ray);
        self.caster.cast_through_any(world, ray, &mut passed)
    }
}
