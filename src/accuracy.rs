//! How wrong a caster is: the truth, and the rays that are hardest on it.
//!
//! [`cast`] answers in rational arithmetic and shares nothing with the casters but the rules in
//! [`crate::cast`]. [`sets`] names the stiff and extreme cases; [`random_ray`] and
//! [`adversarial_ray`] make as many more as one likes, from a seed.

mod chance;
mod rays;
mod reference;
mod sets;

pub use chance::Chance;
pub use rays::{adversarial_ray, random_ray};
pub use reference::{Rational, Truth, cast};
pub use sets::{Set, ordinary, sets};
