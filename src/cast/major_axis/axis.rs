//! The start and the direction of a ray along one of the two axes.

use crate::world::FRACTION_BITS;

/// A ray and a map along one axis.
#[derive(Clone, Copy)]
pub(crate) struct Axis {
    /// The column or row in which the ray starts; the one before, if it starts on a line that it crosses.
    pub(crate) start: i64,
    /// The position of the start, in units.
    pub(crate) position: i64,
    pub(crate) direction: f64,
    /// The strides of cells and of blocks in the distance field.
    pub(crate) stride: i64,
    pub(crate) block_stride: i64,
}

/// The most lines for which units are fine enough.
pub(crate) const MOST_LINES: u32 = 1 << 16;
/// The units of a cell.
pub(crate) const UNITS: i64 = 1 << FRACTION_BITS;

impl Axis {
    /// `None` if the ray does not start on the map.
    #[inline]
    pub(crate) fn new(origin: f64, direction: f64, count: u32, strides: [i64; 2]) -> Option<Self> {
        /// More than the rounding of a position.
        const NEAR: u32 = 2;
        let position = units(origin);
        let is_near_line = (position as u32).wrapping_add(NEAR) < 2 * NEAR;
        let start = if is_near_line {
            start_near_line(origin, direction)
        } else {
            position >> FRACTION_BITS
        };
        let is_on_map = (start as u64) < u64::from(count) && count <= MOST_LINES;
        let [stride, block_stride] = strides;
        is_on_map.then_some(Self { start, position, direction, stride, block_stride })
    }
}

/// The column or row in which a ray starts, where that is on a line or close to one.
#[cold]
#[inline(never)]
fn start_near_line(origin: f64, direction: f64) -> i64 {
    let start = origin.floor();
    let is_before = start == origin && direction > 0.0;
    // A start far off the map may exceed an integer.
    (start as i64).saturating_sub(i64::from(is_before))
}

/// A position in units, rounded. A position far off every map is far off in units.
#[inline]
pub(crate) fn units(position: f64) -> i64 {
    // Doubles of this size have a spacing of one unit, so that the addition rounds to units.
    const SIZE: f64 = 1.5 * (1_u64 << (f64::MANTISSA_DIGITS - 1 - FRACTION_BITS)) as f64;
    (position + SIZE).to_bits().wrapping_sub(SIZE.to_bits()) as i64
}
