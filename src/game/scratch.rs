//! Reusable memory for steps.

use std::ops::{Deref, DerefMut};

/// Memory that a step fills before it reads it. Reusing it avoids an allocation in each step.
/// Comparisons ignore it: games that differ only in scratch memory are equal.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch<T>(T);

impl<T> Deref for Scratch<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T> DerefMut for Scratch<T> {
    fn deref_mut(&mut self) -> &mut T {
        &mut self.0
    }
}

impl<T> PartialEq for Scratch<T> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
