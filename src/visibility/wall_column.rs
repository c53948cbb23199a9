//! Wall columns: upright faces as wide as a pixel, one by one or in runs.

use std::ops::Range;

use super::{Column, Extent, Facing};
use crate::cast::Side;
use crate::world::{Light, Paint};

/// The visible part of an upright face that is as wide as a pixel.
#[derive(Clone, Debug)]
pub(crate) struct WallColumn {
    pub(crate) column: u32,
    pub(crate) rows: Range<u32>,
    pub(crate) facing: Facing,
    /// The approach of the ray to the face, in cells per unit of `t`.
    pub(crate) slope: f64,
    pub(crate) t: f64,
    pub(crate) u: f64,
    pub(crate) paint: Paint,
    pub(crate) light: Light,
    pub(crate) extent: Extent,
}

/// Neighbouring wall columns of a level scene that show one paint on one kind of side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WallRun<'l> {
    /// The index of the first column.
    pub(crate) first: u32,
    /// The columns, each of which has a hit.
    pub(crate) columns: &'l [Column],
    pub(crate) side: Side,
    pub(crate) paint: Paint,
}

/// A receiver of wall columns.
///
/// It is a trait and not a closure, because each loop over wall columns must inline it.
pub(crate) trait WallSink {
    /// Receives the part of `wall` in `rows`, which are not empty.
    fn take(&mut self, wall: &WallColumn, rows: Range<u32>);
}
