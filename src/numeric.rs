//! Arithmetic for the other modules: sums and products without rounding error, a predicate with an
//! exact sign, rounding, and damped motion in closed form.
//!
//! Each algorithm exists once and names its source. Rejected: crates. The module needs about a
//! hundred lines of them, and every picture depends on each bit of the results.

pub mod damped_motion;
mod exact;
pub(crate) mod rounding;

pub(crate) use exact::{DoubleDouble, cross, sign_of_cross, two_product, two_sum};
