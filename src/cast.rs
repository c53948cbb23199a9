//! Casting: finding the cell that a ray hits in a grid.
//!
//! The rules are the same for every caster:
//!
//! - A hit is the first solid cell that the ray *enters* at `t ≥ 0`. A ray that starts inside a
//!   wall has already entered it, and hits the next one.
//! - A ray crosses grid lines in the order of their `t`. If it meets an x line and a y line at
//!   once, it crosses the y line first.
//! - A ray that starts on a line crosses that line at `t = 0`. If it runs along the line, it is in
//!   the cell to the east or to the south.
//! - The outside of the map is empty: a ray may start there and enter the map, and a ray that
//!   leaves the map escapes.
//! - Every ray ends, and no hit contains a NaN.
//!
//! [`Caster::cast_through`] also handles doors, whose leaf is in the middle of the cell,
//! transparent cubes, and shapes that do not fill their cell:
//!
//! - A ray that enters a door's cell or starts in it hits the leaf if it meets it, and otherwise
//!   goes on.
//! - A ray that enters a cube of glass, or a cube with holes, passes through it and reports the
//!   face. Adjacent cells with the same tile are one cube, without a face between them.
//! - A ray that enters the cell of a shape (a pillar or a line) or starts in it hits the shape if
//!   it meets it, and otherwise goes on. A line has no thickness, and both its ends belong to it: a
//!   ray along the line misses it, and a ray through an end hits it. A ray that starts inside a
//!   pillar leaves it without a hit.
//!
//! [`Exact`] keeps these rules for every ray. It crosses the lines in their true order, which it
//! finds with integers, or with longer integers if the first ones cannot decide. A caster without
//! its own [`Caster::cast_through`] treats all of these cells as walls.
//!
//! The renderer uses the exact traversal directly. The other casters exist to be measured.

mod exact;
mod major_axis;
mod order;
mod pillar;
mod ray;
mod segment;
mod through;
mod walk;

pub use exact::Exact;
pub(crate) use major_axis::MajorAxisTraversal;
pub(crate) use order::CommonOrder;
pub use order::{ExactOrder, Order, RoundedOrder};
pub use ray::texture_coordinate;
pub use ray::{Hit, Ray, RayError, Side};
pub(crate) use ray::{cell_before, from_left, is_from_left};
pub(crate) use segment::Segment;
pub(crate) use through::Intersection;
#[cfg(feature = "tui")]
pub(crate) use walk::Crossed;
#[cfg(feature = "tui")]
pub(crate) use walk::WalkFromInside;
pub use walk::first_line;
pub(crate) use walk::{Course, MirrorTransform, RayWalk};
pub use walk::{Crossing, Walk};

use crate::world::{Grid, World};

/// A method of finding the cell that a ray hits.
pub trait Caster {
    /// The first hit of `ray` in `grid`, or `None` if the ray escapes.
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit>;

    /// The first hit of `ray` in `world` that is not transparent, or `None` if the ray escapes.
    /// Calls `passed` with the transparent faces that the ray enters before that hit, from near to
    /// far.
    ///
    /// The default treats everything solid as a wall.
    fn cast_through(&self, world: &World, ray: &Ray, passed: &mut dyn FnMut(Hit)) -> Option<Hit> {
        _ = passed;
        self.cast(world.grid(), ray)
    }
}
