//! Arithmetic for the other modules: sums and products without rounding error, a predicate with an
//! exact sign, and damped motion in closed form.
//!
//! Each method exists once and names its source. Crates were refused: the module needs about a
//! hundred lines of them, and every picture depends on each bit of the results.

pub mod damped_motion;
mod double_double;
mod error_free;
mod orientation;

pub(crate) use double_double::DoubleDouble;
pub(crate) use error_free::{two_product, two_sum};
pub(crate) use orientation::{cross, sign_of_cross};
