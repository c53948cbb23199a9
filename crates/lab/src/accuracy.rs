//! Accuracy: what is compared with a truth, and what each figure of a report costs.
//!
//! [`cast`] computes in rational arithmetic, and shares only the rules in [`cellcaster::cast`] with the
//! casters. [`sets()`] returns named sets of stiff and extreme cases; [`random_ray`] and
//! [`adversarial_ray`] generate any number of other rays from a seed. [`report`] compares and times,
//! and returns [tables](Table).

mod areas;
mod features;
mod fixed_point;
mod motion;
mod pictures;
mod ray_tables;
mod rays;
mod reference;
mod report;
mod sets;
mod table;
mod trial;

pub use areas::shimmer;
pub use motion::Integrator;
pub use pictures::{Gallery, Reference};
pub use ray_tables::{RAYS, SEED, all_methods, is_measured};
pub use rays::{adversarial_ray, random_ray};
pub use reference::{Rational, Truth, cast};
pub use report::{Part, Plan, RaySource, report, set_names};
pub use sets::{Set, ordinary, plain, sets};
pub use table::{Column, Diagram, Row, Table, Timing, Value};
pub use trial::{Errors, Trial};
