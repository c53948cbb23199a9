//! Arithmetic that the rest builds on and that is about no raycaster: sums and products without rounding error,
//! a predicate with an exact sign, and motion in closed form.
//!
//! Each method is here once, and names its source. Crates for them were refused: what is needed is a hundred
//! lines, and every picture depends on each bit of their results.

pub(crate) mod damped_motion;
mod double_double;
mod error_free;
mod orientation;

pub(crate) use double_double::DoubleDouble;
pub(crate) use error_free::{two_product, two_sum};
pub(crate) use orientation::{cross, sign_of_cross};
