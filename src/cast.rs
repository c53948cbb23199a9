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
//! - Every ray ends, after at most one step for each line of the map.
//!
//! Each method of casting is one file and one type that implements [`Caster`]; callers are generic
//! over it. A method picked through a pointer for each ray was refused: the call would cost as much
//! as a short ray.

mod dda;

use std::fmt;

pub use dda::{Crossing, Dda, Walk};
use glam::DVec2;

use crate::world::{Cell, Grid};

/// A method of finding what a ray hits.
pub trait Caster {
    /// What `ray` hits first in `grid`, or `None` where it escapes.
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit>;
}

/// A half-line on the map: a finite origin, and a finite direction that is not zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    origin: DVec2,
    direction: DVec2,
}

impl Ray {
    /// The ray from `origin`, in cells, along `direction`, of any length but zero.
    ///
    /// # Errors
    /// Where either is not finite, or the direction is zero.
    pub fn new(origin: DVec2, direction: DVec2) -> Result<Self, NotARay> {
        if !origin.is_finite() {
            Err(NotARay::Origin)
        } else if !direction.is_finite() {
            Err(NotARay::Direction)
        } else if direction == DVec2::ZERO {
            Err(NotARay::NoDirection)
        } else {
            Ok(Self { origin, direction })
        }
    }

    /// Where it starts.
    pub fn origin(&self) -> DVec2 {
        self.origin
    }

    /// Where it goes, and the length that `t` is measured in.
    pub fn direction(&self) -> DVec2 {
        self.direction
    }

    /// The point at `t`.
    pub fn at(&self, t: f64) -> DVec2 {
        self.origin + self.direction * t
    }
}

/// The error of [`Ray::new`]: what keeps the numbers from being a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotARay {
    /// The origin is not finite.
    Origin,
    /// The direction is not finite.
    Direction,
    /// The direction is zero.
    NoDirection,
}

impl fmt::Display for NotARay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Origin => "a ray's origin must be two finite numbers",
            Self::Direction => "a ray's direction must be two finite numbers",
            Self::NoDirection => "a ray's direction must not be zero",
        })
    }
}

impl std::error::Error for NotARay {}

/// Which kind of grid line a ray crossed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// A line x = const: the west or the east face of a cell.
    X,
    /// A line y = const: the north or the south face of a cell.
    Y,
}

/// Where a ray enters a solid cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The cell.
    pub cell: Cell,
    /// The kind of line that was crossed into it.
    pub side: Side,
    /// How far along the ray, in lengths of its direction; at least 0.
    pub t: f64,
    /// How far along the face, from 0 at its left end to 1 at its right, as its viewer sees it.
    pub u: f64,
}

impl Hit {
    /// Where `ray` crosses a line of kind `side` into `cell`.
    ///
    /// The distance comes from the index of the cell, by one subtraction and one division; a sum
    /// that runs from line to line would gather an error at each of them.
    pub fn entering(ray: &Ray, cell: Cell, side: Side) -> Self {
        let (column, row) = (f64::from(cell.column), f64::from(cell.row));
        let Ray { origin, direction } = *ray;
        let (t, along, rising) = match side {
            Side::X => {
                let t = distance(origin.x, direction.x, column);
                (t, (origin.y - row) + t * direction.y, direction.x > 0.0)
            }
            Side::Y => {
                let t = distance(origin.y, direction.y, row);
                (t, (origin.x - column) + t * direction.x, direction.y < 0.0)
            }
        };
        let along = along.clamp(0.0, 1.0);
        Self { cell, side, t, u: if rising { along } else { 1.0 - along } }
    }
}

/// How far it is to the line by which a cell is entered, of the two at `index` and `index + 1`.
fn distance(origin: f64, direction: f64, index: f64) -> f64 {
    let line = if direction > 0.0 { index } else { index + 1.0 };
    ((line - origin) / direction).abs()
}
