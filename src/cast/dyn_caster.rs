//! A caster whose type is erased.
//!
//! The drawing code is compiled twice: for [`Exact`], and for a caster whose pointer is followed
//! for each ray. Rejected: compiling it for each caster. Six more copies, for casters that only
//! measurements use, took a tenth of a megabyte. A call takes a few instructions of the hundreds
//! that a ray takes.

use std::fmt::Debug;
use std::sync::Arc;

use super::{Caster, Exact, Hit, Ray};
use crate::world::{Grid, World};

/// A caster whose type is erased: [`Exact`] by default.
#[derive(Clone, Debug, Default)]
pub struct DynCaster {
    /// `None` for [`Exact`].
    caster: Option<Arc<dyn OwnedCaster>>,
}

/// A caster that a [`DynCaster`] owns.
trait OwnedCaster: AnyCaster + Debug + Send + Sync {}

impl<C: Caster + Debug + Send + Sync> OwnedCaster for C {}

impl DynCaster {
    /// Erases the type of `caster`.
    pub fn new(caster: impl Caster + Debug + Send + Sync + 'static) -> Self {
        Self { caster: Some(Arc::new(caster)) }
    }

    /// Returns whether this is [`Exact`].
    pub(crate) fn is_default(&self) -> bool {
        self.caster.is_none()
    }

    fn any(&self) -> &dyn AnyCaster {
        match &self.caster {
            None => &Exact,
            Some(caster) => &**caster,
        }
    }
}

impl Caster for DynCaster {
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        self.any().cast_any(grid, ray)
    }

    fn is_exact(&self) -> bool {
        self.any().is_exact_any()
    }

    fn cast_through(&self, world: &World, ray: &Ray, mut passed: impl FnMut(Hit)) -> Option<Hit> {
        self.any().cast_through_any(world, ray, &mut passed)
    }
}

/// The functions of [`Caster`], to be called through a pointer.
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
