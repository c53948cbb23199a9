//! Casters to compare with the exact one, as tutorials and other programs have them.
//!
//! | method | finds the hit by | source |
//! |---|---|---|
//! | [`Exact`](cellcaster::cast::Exact) | lines in their true order: integers, and longer integers where those cannot decide | [`cellcaster::cast`] |
//! | [`Dda`] | lines in order, in double precision | Lode Vandevenne, "Raycasting II" |
//! | [`Dda32`] | the same in single precision | the same |
//! | [`Accumulate`] | a running sum of distances | Lode Vandevenne, "Raycasting" |
//! | [`Fixed`] | lines in order, in fixed point | drummyfish, LRS, "Raycasting" |
//! | [`Table`] | x and y lines separately, along the nearest of a fixed number of angles | F. Permadi, "Ray-Casting Tutorial" |
//! | [`March`] | constant steps | the method that Lode Vandevenne warns of |
//!
//! All but the exact caster treat doors, glass, masks and shapes as walls, and only the exact
//! caster keeps the rules of [`cellcaster::cast`] for every ray. Each method is one file and one type
//! that implements [`Caster`](cellcaster::cast::Caster); a [`Method`] is chosen by name.

mod accumulate;
mod clipped_ray;
mod dda;
mod dda32;
mod fixed;
mod march;
mod method;
mod table;

pub use accumulate::Accumulate;
pub use dda::Dda;
pub use dda32::Dda32;
pub use fixed::Fixed;
pub use march::March;
pub use method::{Method, ParseMethodError, Visitor};
pub use table::Table;
