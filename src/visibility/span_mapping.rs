//! Span mappings: from the pixels of a row of floor or ceiling to points on the map.
//!
//! All pixels of such a row are at one distance, and their centres are evenly spaced on a straight line. The
//! line is computed from the row's own index. Each pixel's point is computed from the middle of its row, in
//! fixed point that wraps around. No error accumulates, and a picture and its mirror image agree bit for bit.

use std::ops::Range;

use glam::DVec2;

use crate::cast::MirrorTransform;
use crate::numeric::rounding::floor_double;

/// The line of the floor or the ceiling that a row of pixels shows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpanMapping {
    /// The distance from the camera plane; infinite for a row at the horizon.
    pub(crate) distance: f64,
    /// The area of a pixel on the plane, in square cells.
    pub(crate) pixel_area: f64,
    /// The point in the middle of the row.
    pub(crate) middle: DVec2,
    /// The vector from the middle of a pixel to its right edge.
    pub(crate) half_step: DVec2,
    /// The number of pixels of the row.
    pub(crate) width: u32,
}

impl SpanMapping {
    /// The line moved slightly towards `eye`, and the line moved slightly away from it, for looking up the
    /// cells of pixels. At a point on the border between two cells, the first line is in the nearer cell and
    /// the second in the farther one.
    pub(crate) fn before_and_behind(self, eye: DVec2) -> [Self; 2] {
        /// The shift as a fraction of the distance: more than the rounding error of a point, and too little to
        /// be visible.
        const EPSILON: f64 = 1e-9;
        [-EPSILON, EPSILON].map(|moved| Self {
            middle: self.middle + (self.middle - eye) * moved,
            half_step: self.half_step * (1.0 + moved),
            ..self
        })
    }

    /// The line on the map that is seen as this line in a mirror image.
    pub(crate) fn seen_in_mirrors(self, transform: MirrorTransform) -> Self {
        Self {
            middle: transform.to_map(self.middle),
            half_step: transform.direction_to_map(self.half_step),
            ..self
        }
    }

    /// The point at the centre of the pixel in column `x`.
    pub(crate) fn point(&self, x: usize) -> DVec2 {
        self.middle + self.half_step * self.half_steps_to(x) as f64
    }

    /// The cells that the pixels in `columns` show. Each item is the north-west corner of a cell and its
    /// columns of pixels.
    ///
    /// The cost per cell is a search for the cell's end along one axis. The pixels are not looked up on the map
    /// one by one.
    #[inline]
    pub(crate) fn cells(
        self,
        columns: Range<usize>,
    ) -> impl Iterator<Item = (DVec2, Range<usize>)> {
        let Range { mut start, end } = columns;
        let mut x = AxisCells::new(self.middle.x, self.half_step.x, self.width);
        let mut y = AxisCells::new(self.middle.y, self.half_step.y, self.width);
        x.enter(start, end);
        y.enter(start, end);
        std::iter::from_fn(move || {
            (start < end).then(|| {
                let corner = DVec2::new(x.cell, y.cell);
                let first = start;
                start = x.next.min(y.next);
                if start < end && x.next == start {
                    x.enter(start, end);
                }
                if start < end && y.next == start {
                    y.enter(start, end);
                }
                (corner, first..start)
            })
        })
    }

    /// The positions of the pixels from column `x` on, in a pattern that repeats `per_cell` times per cell
    /// along both axes.
    pub(crate) fn places(&self, x: usize, per_cell: f64) -> TexelPlaces {
        let along = |middle: f64, half_step: f64| {
            let half_step = fraction(half_step * per_cell);
            let start = half_step.wrapping_mul(self.half_steps_to(x) as u64);
            (fraction(middle * per_cell).wrapping_add(start), half_step.wrapping_mul(2))
        };
        let (x, x_step) = along(self.middle.x, self.half_step.x);
        let (y, y_step) = along(self.middle.y, self.half_step.y);
        TexelPlaces { x, y, x_step, y_step }
    }

    /// The number of half steps from the middle of the row to the centre of the pixel in column `x`.
    fn half_steps_to(&self, x: usize) -> i64 {
        2 * x as i64 + 1 - i64::from(self.width)
    }
}

/// The cells that the pixels of a row show, along one axis.
struct AxisCells {
    middle: f64,
    half_step: f64,
    width: i64,
    /// The number of half steps in a cell.
    half_steps_in_cell: f64,
    /// The current column or row of the map.
    cell: f64,
    /// The first pixel in another column or row of the map, or the end.
    next: usize,
}

impl AxisCells {
    fn new(middle: f64, half_step: f64, width: u32) -> Self {
        let width = i64::from(width);
        Self { middle, half_step, width, half_steps_in_cell: 1.0 / half_step, cell: 0.0, next: 0 }
    }

    fn at(&self, x: usize) -> f64 {
        self.middle + self.half_step * (2 * x as i64 + 1 - self.width) as f64
    }

    /// Finds the cell of the pixel in column `x`, and the first pixel before `end` in another one.
    #[inline]
    fn enter(&mut self, x: usize, end: usize) {
        let here = self.at(x);
        // The new cell is usually the neighbour of the last one.
        let beside = self.cell + if self.half_step > 0.0 { 1.0 } else { -1.0 };
        let is_beside = beside <= here && here < beside + 1.0;
        self.cell = if is_beside { beside } else { floor_double(here) };
        self.next = end;
        if self.half_step == 0.0 || !self.cell.is_finite() {
            return;
        }
        let edge = if self.half_step > 0.0 { self.cell + 1.0 } else { self.cell };
        let half_steps = (edge - self.middle) * self.half_steps_in_cell;
        let next = f64::midpoint(half_steps, (self.width - 1) as f64);
        // On old processors `f64::ceil` is a call.
        let before = next as usize;
        self.next = (before + usize::from((before as f64) < next)).clamp(x + 1, end);
    }
}

/// Positions in a repeating pattern, one for each pixel, in units of 2⁻⁶⁴ of a repeat along both axes.
#[derive(Clone, Debug)]
pub(crate) struct TexelPlaces {
    x: u64,
    y: u64,
    x_step: u64,
    y_step: u64,
}

impl TexelPlaces {
    /// The first position, along both axes.
    pub(crate) fn first(&self) -> [u64; 2] {
        [self.x, self.y]
    }

    /// The step from one position to the next, along both axes.
    pub(crate) fn steps(&self) -> [u64; 2] {
        [self.x_step, self.y_step]
    }

    /// The same positions in a pattern that repeats twice as often.
    pub(crate) fn doubled(&self) -> Self {
        let Self { x, y, x_step, y_step } = *self;
        let [x, y, x_step, y_step] = [x, y, x_step, y_step].map(|it| it << 1);
        Self { x, y, x_step, y_step }
    }

    /// Advances by `count` pixels.
    pub(crate) fn skip_pixels(&mut self, count: u64) {
        self.x = self.x.wrapping_add(self.x_step.wrapping_mul(count));
        self.y = self.y.wrapping_add(self.y_step.wrapping_mul(count));
    }
}

impl Iterator for TexelPlaces {
    type Item = (u64, u64);

    #[inline]
    fn next(&mut self) -> Option<(u64, u64)> {
        let place = (self.x, self.y);
        // Integers that wrap around lose no precision.
        self.x = self.x.wrapping_add(self.x_step);
        self.y = self.y.wrapping_add(self.y_step);
        Some(place)
    }
}

/// The fractional part of `number`, in units of 2⁻⁶⁴; 0 for NaN.
///
/// The function shifts the significand, because conversions of doubles to integers saturate and take longer.
#[inline]
fn fraction(number: f64) -> u64 {
    const BITS: u32 = f64::MANTISSA_DIGITS - 1;
    /// The stored exponent of a number whose significand is in units of 2⁻⁶⁴.
    const OF_64THS: u32 = f64::MAX_EXP as u32 - 1 + BITS - u64::BITS;
    let exponent = (number.to_bits() >> BITS) as u32 & 0x7ff;
    let significand = number.to_bits() & ((1 << BITS) - 1) | 1 << BITS;
    let fraction = match exponent.checked_sub(OF_64THS) {
        Some(shift) => significand.checked_shl(shift),
        None => significand.checked_shr(OF_64THS - exponent),
    };
    let fraction = fraction.unwrap_or(0);
    if number < 0.0 { fraction.wrapping_neg() } else { fraction }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn fractions_wrap_around() {
        let quarter = 1 << 62;
        assert_eq!([0.25, 7.25, -0.75, -3.75].map(fraction), [quarter; 4]);
        assert_eq!([0.0, -0.0, 5.0, f64::NAN, f64::INFINITY].map(fraction), [0; 5]);
    }

    proptest! {
        #[test]
        fn a_fraction_is_the_rest_after_the_integer(
            number in prop_oneof![-1e4..1e4_f64, -1e-6..1e-6_f64, any::<f64>()],
        ) {
            let rest = number.abs() - number.abs().trunc();
            let rest = (rest * 2.0_f64.powi(64)) as u64;
            let expected = if number < 0.0 { rest.wrapping_neg() } else { rest };
            prop_assert_eq!(fraction(number), expected);
        }

        #[test]
        fn every_pixel_is_in_the_cell_of_its_point(
            middle in (-50.0..50.0, -50.0..50.0),
            half_step in (
                prop_oneof![Just(0.0), Just(0.25), -0.9..0.9],
                prop_oneof![Just(0.0), Just(-0.5), -0.9..0.9],
            ),
            width in 1_u32..400,
        ) {
            let (middle, half_step) = (DVec2::from(middle), DVec2::from(half_step));
            let mapping = SpanMapping { distance: 1.0, pixel_area: 1.0, middle, half_step, width };
            let mut next = 0;
            for (corner, columns) in mapping.cells(0..width as usize) {
                prop_assert_eq!(columns.start, next);
                prop_assert!(columns.clone().all(|x| mapping.point(x).floor() == corner));
                next = columns.end;
                prop_assert!(next == width as usize || mapping.point(next).floor() != corner);
            }
            prop_assert_eq!(next, width as usize);
        }

        #[test]
        fn positions_agree_with_points(
            middle in (-50.0..50.0, -50.0..50.0),
            half_step in (-0.5..0.5, -0.5..0.5),
            width in 1_u32..4096,
            per_cell in 0.1..3.0,
        ) {
            let mapping = SpanMapping {
                distance: 1.0,
                pixel_area: 1.0,
                middle: DVec2::from(middle),
                half_step: DVec2::from(half_step),
                width,
            };
            let first = width as usize / 3;
            for (x, (east, south)) in (first..width as usize).zip(mapping.places(first, per_cell)) {
                let point = mapping.point(x) * per_cell;
                for (place, expected) in [(east, point.x), (south, point.y)] {
                    let off = place as f64 / 2.0_f64.powi(64) - (expected - expected.floor());
                    prop_assert!(off.abs() < 1e-9 || (off.abs() - 1.0).abs() < 1e-9);
                }
            }
        }
    }
}
