//! Arithmetic for the other modules: sums and products without rounding error, a predicate with an
//! exact sign, and damped motion in closed form.
//!
//! Each method exists once and names its source. Crates were refused: the module needs about a
//! hundred lines of them, and every picture depends on each bit of the results.

pub mod damped_motion;
mod exact;

pub(crate) use exact::{DoubleDouble, cross, sign_of_cross, two_product, two_sum};
