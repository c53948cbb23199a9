//! A caster of any type.
//!
//! The drawing code is compiled twice: for [`Exact`], and for a caster whose pointer is followed for
//! each ray. Compiling it for each caster was refused: six more copies, for casters that measurements
//! alone use, took a tenth of a megabyte, and a call takes some instructions of the hundreds of a ray.

use std::fmt::Debug;
use std::sync::Arc;

use super::{FramePlan, Picture, Threads};
use crate::cast::{AnyCaster, Caster, Exact, Hit, Ray};
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

    pub(crate) fn draw(&self, picture: Picture<'_>) -> (FramePlan, Threads) {
        match self.caster {
            None => picture.draw(&Exact),
            Some(_) => picture.draw(self),
        }
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
