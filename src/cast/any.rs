//! Casters whose type is erased.

use super::{Caster, Hit, Ray};
use crate::world::{Grid, World};

/// The functions of [`Caster`], which are called by a pointer.
pub(crate) trait AnyCaster {
    /// [`Caster::cast`].
    fn cast_any(&self, grid: &Grid, ray: &Ray) -> Option<Hit>;

    /// [`Caster::is_exact`].
    fn is_exact_any(&self) -> bool;

    /// [`Caster::cast_through`].
    fn cast_through_any(
        &self,
        world: &World,
        ray: &Ray,
        passed: &mut dyn FnMut(Hit),
    ) -> Option<Hit>;
}

impl<C: Caster> AnyCaster for C {
    fn cast_any(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        self.cast(grid, ray)
    }

    fn is_exact_any(&self) -> bool {
        self.is_exact()
    }

    fn cast_through_any(
        &self,
        world: &World,
        ray: &Ray,
        passed: &mut dyn FnMut(Hit),
    ) -> Option<Hit> {
        self.cast_through(world, ray, passed)
    }
}
