//! The accuracy of casters: a reference in rational arithmetic, and difficult rays.
//!
//! [`cast`] computes in rational arithmetic, and shares only the rules in [`crate::cast`] with the
//! casters. [`sets()`] returns named sets of stiff and extreme cases; [`random_ray`] and
//! [`adversarial_ray`] generate any number of other rays from a seed.

mod filters;
mod motion;
mod pictures;
mod rays;
mod reference;
mod report;
mod sets;
mod trial;

pub use filters::{FilterErrors, FilterRow, compare_filters, shimmer};
pub use motion::{Integrator, MotionCase, MotionResult, compare_motions};
pub use pictures::{Gallery, Reference};
pub use rays::{adversarial_ray, random_ray};
pub use reference::{Rational, Truth, cast};
pub use report::{PICTURES, Plan, RaySource, Report, Row, SetRow, report, set_names};
pub use sets::{Set, ordinary, sets};
pub use trial::{Errors, Timing, Trial, time_in_turns};
