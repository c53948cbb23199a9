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
//! [`Exact`] keeps all of these rules for every ray: it crosses the lines in their true order, by integers, and by longer
//! ones where those cannot tell. A caster without a [`Caster::cast_through`] of its own takes all of these cells for walls.
//!
//! Callers are generic over the [`Caster`]. One that is picked through a pointer for each ray was
//! refused: the call would cost as much as a short ray.

mod door;
mod exact;
mod hit;
mod major_axis;
mod ray;
mod rounded;
mod shape;
mod through;
mod walk;

pub use exact::{Exact, ExactOrder};
#[cfg(feature = "lab")]
pub(crate) use hit::texture_coordinate;
pub use hit::{Hit, Side};
pub(crate) use major_axis::MajorAxisTraversal;
pub use ray::{NotARay, Ray};
pub use rounded::RoundedOrder;
pub(crate) use shape::Passage;
#[cfg(feature = "lab")]
pub(crate) use walk::first_line;
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
