//! Casting: a ray and a grid in, the cell it hits out.
//!
//! The rules, the same for every caster:
//!
//! - A hit is the first solid cell that the ray *enters* at `t ≥ 0`. A ray that starts inside a wall
//!   has entered it already, so it hits the next one.
//! - The lines of the grid are crossed in the order of their `t`; where the ray meets an x line and a
//!   y line at once, the y line is crossed first.
//! - A ray that starts on a line crosses that line at `t = 0`, unless it runs along it; then it is in
//!   the cell to the east or to the south of the line.
//! - There is nothing off the map: a ray may start there and enter, and a ray that leaves escapes.
//! - Every ray ends, and no hit has a NaN in it.
//!
//! | method | finds the hit by | from |
//! |---|---|---|
//! | [`Exact`] | the lines in their true order: integers, and longer ones where those can't tell | here |
//! | [`Dda`] | the lines in order, in double precision | Lode Vandevenne, "Raycasting II" |
//! | [`Dda32`] | the same in single precision | the same |
//! | [`Accumulate`] | a running sum of distances | Lode Vandevenne, "Raycasting" |
//! | [`Fixed`] | the lines in order, in fixed point | drummyfish, LRS, "Raycasting" |
//! | [`Table`] | x and y lines apart, along the nearest of so many angles | F. Permadi, "Ray-Casting Tutorial" |
//! | [`March`] | constant steps | what Lode Vandevenne warns of |
//!
//! Besides walls there are doors, whose leaf stands back in its cell, cubes that are seen through, and
//! shapes that do not fill their cell.
//! [`Caster::cast_through`] knows them:
//!
//! - A ray that is in the cell of a door, whether it has entered it or starts there, hits its leaf
//!   where it meets it, and otherwise goes on.
//! - A ray that enters a cube of glass or one with holes passes through, and is told of it. Cells of
//!   the same tile side by side are one cube: there is no face between them.
//!
//! - A ray that is in the cell of a shape, a pillar or a line, hits it where it meets it, and
//!   otherwise goes on. A line has no thickness, and both its ends belong to it: a ray along it meets
//!   nothing, one through an end does. A ray that starts inside a pillar leaves it.
//!
//! Only [`Exact`] does that; to the others all of these are walls.
//!
//! Only [`Exact`] keeps the rules for every ray; the others are here to be compared with it.
//!
//! Each method of casting is one file and one type that implements [`Caster`]; callers are generic
//! over it, and a [`Method`] picks one by name. A method picked through a pointer for each ray was
//! refused: the call would cost as much as a short ray.

mod accumulate;
mod approach;
mod cross;
mod dda;
mod dda32;
mod door;
mod double;
mod exact;
mod fixed;
mod hit;
mod march;
mod method;
mod ray;
mod shape;
mod sweep;
mod table;
mod through;
mod walk;

pub use accumulate::Accumulate;
pub use dda::{Dda, DdaOrder};
pub use dda32::Dda32;
pub(crate) use exact::ExactOnLevel;
pub use exact::{Exact, ExactOrder};
pub use fixed::Fixed;
pub use hit::{Hit, Side};
pub use march::March;
pub use method::{Method, NotAMethod, Visitor};
pub use ray::{NotARay, Ray};
pub(crate) use shape::Passage;
pub(crate) use sweep::Sweep;
pub use table::Table;
pub(crate) use walk::{Crossed, MirrorTransform, MirroredWalk};
pub use walk::{Crossing, Order, Walk};

use crate::world::{Grid, World};

/// A method of finding what a ray hits.
pub trait Caster {
    /// What `ray` hits first in `grid`, or `None` where it escapes.
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit>;

    /// Whether all rays between two, far enough apart that rounding is nothing to it, hit the same side
    /// of the same cell as both do: from one place, and as [`Caster::cast`] has it, to which all that is
    /// solid is a wall. Else each has to be cast.
    fn follows_between(&self, left: &Hit, right: &Hit) -> bool {
        _ = (left, right);
        false
    }

    /// What `ray` hits first in `world` that cannot be seen through, or `None` where it escapes. What
    /// it enters before that and is seen through, it tells to `passed`, from near to far.
    ///
    /// A method that does not know better takes everything solid for a wall.
    fn cast_through(&self, world: &World, ray: &Ray, passed: impl FnMut(Hit)) -> Option<Hit> {
        _ = passed;
        self.cast(world.grid(), ray)
    }
}
