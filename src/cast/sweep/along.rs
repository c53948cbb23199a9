//! Along: where a ray starts on a map, and where it goes, along one of the two axes.

use crate::world::FRACTION_BITS;

/// What a ray and a map are along one axis.
#[derive(Clone, Copy)]
pub(super) struct Along {
    /// The column or row that the ray starts in; on a line that it crosses, the one before.
    pub(super) start: i64,
    /// Where it starts, in units.
    pub(super) place: i64,
    pub(super) direction: f64,
    /// From one cell to the next in the list of all cells, and from one block to the next.
    pub(super) stride: i64,
    pub(super) block_stride: i64,
}

/// More lines than that, and units would be too coarse.
pub(super) const MOST_LINES: u32 = 1 << 16;
/// How many units a cell has.
pub(super) const UNITS: i64 = 1 << FRACTION_BITS;

impl Along {
    /// `None` where the ray does not start on the map.
    #[inline]
    pub(super) fn new(origin: f64, direction: f64, count: u32, strides: [i64; 2]) -> Option<Self> {
        /// More than is rounded away.
        const NEAR: u32 = 2;
        let place = units(origin);
        let is_near_line = (place as u32).wrapping_add(NEAR) < 2 * NEAR;
        let start =
            if is_near_line { start_near_line(origin, direction) } else { place >> FRACTION_BITS };
        let is_on_map = (start as u64) < u64::from(count) && count <= MOST_LINES;
        let [stride, block_stride] = strides;
        is_on_map.then_some(Self { start, place, direction, stride, block_stride })
    }
}

/// The column or row that a ray starts in that starts on a line, or nearly so.
#[cold]
#[inline(never)]
fn start_near_line(origin: f64, direction: f64) -> i64 {
    let start = origin.floor();
    let is_before = start == origin && direction > 0.0;
    // What is not near the map at all may be as far as there are numbers.
    (start as i64).saturating_sub(i64::from(is_before))
}

/// The units of a place, rounded. What is far off any map is far off in units.
#[inline]
pub(super) fn units(place: f64) -> i64 {
    // A double of that size has as many bits after the point, with more or less than that added to it.
    const SIZE: f64 = 1.5 * (1_u64 << (f64::MANTISSA_DIGITS - 1 - FRACTION_BITS)) as f64;
    (place + SIZE).to_bits().wrapping_sub(SIZE.to_bits()) as i64
}
