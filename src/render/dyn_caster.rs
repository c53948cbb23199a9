//! A caster of any type.
//!
//! The drawing code is compiled for each caster, and its pointer is followed once a frame. A
//! pointer that is followed for each ray was refused: the call would cost as much as a short ray.

use std::fmt::Debug;
use std::sync::Arc;

use super::{FramePlan, Picture, Threads};
use crate::cast::{Caster, Exact};

/// A caster whose type is erased: [`Exact`] by default.
#[derive(Clone, Debug)]
pub struct DynCaster(Arc<dyn Pictures>);

impl DynCaster {
    /// Erases the type of `caster`.
    pub fn new(caster: impl Caster + Debug + Send + Sync + 'static) -> Self {
        Self(Arc::new(caster))
    }

    pub(super) fn draw(&self, picture: Picture<'_>) -> (FramePlan, Threads) {
        self.0.draw(picture)
    }
}

impl Default for DynCaster {
    fn default() -> Self {
        Self::new(Exact)
    }
}

/// The function that is compiled for each caster.
trait Pictures: Debug + Send + Sync {
    fn draw(&self, picture: Picture<'_>) -> (FramePlan, Threads);
}

impl<C: Caster + Debug + Send + Sync> Pictures for C {
    fn draw(&self, picture: Picture<'_>) -> (FramePlan, Threads) {
        picture.draw(self)
    }
}
