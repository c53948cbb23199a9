//! Span mappings: where on the map the pixels of a row of floor or ceiling are.
//!
//! All pixels of such a row are at one distance, and their centres stand side by side on a straight
//! line. Each row's line is computed from the row's own index, and each pixel's place from the middle
//! of its row, in fixed point that wraps around: no error adds up anywhere, and a picture and its
//! mirror image agree bit for bit.

use std::ops::Range;

use glam::DVec2;

use crate::cast::MirrorTransform;

/// The line that a row of pixels shows of the floor or the ceiling.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpanMapping {
    /// How far it is from the camera plane; infinite for a row at the horizon.
    pub(crate) distance: f64,
    /// How large a pixel is on it, in square cells.
    pub(crate) pixel_area: f64,
    /// What the middle of the row shows.
    pub(crate) middle: DVec2,
    /// From the middle of a pixel to its right edge.
    pub(crate) half_step: DVec2,
    /// How many pixels the row has.
    pub(crate) width: u32,
}

impl SpanMapping {
    /// The same line, a hair nearer to `eye`. It tells which cell a pixel is seen in: on the line
    /// between two cells that is the one before it, at the foot of a wall the one before the wall.
    pub(crate) fn just_before(self, eye: DVec2) -> Self {
        /// As a share of the way: more than rounding can move a point, and less than shows.
        const HAIR: f64 = 1e-9;
        let middle = self.middle + (eye - self.middle) * HAIR;
        Self { middle, half_step: self.half_step * (1.0 - HAIR), ..self }
    }

    /// Where it is on the map, if what it shows is seen in mirrors.
    pub(crate) fn seen_in_mirrors(self, transform: MirrorTransform) -> Self {
        Self {
            middle: transform.to_map(self.middle),
            half_step: transform.direction_to_map(self.half_step),
            ..self
        }
    }

    /// What the centre of the pixel in column `x` shows.
    pub(crate) fn point(&self, x: usize) -> DVec2 {
        self.middle + self.half_step * self.half_steps_to(x) as f64
    }

    /// The cells that the pixels in `columns` show, each by its north-west corner, and in which of the
    /// columns.
    ///
    /// A cell costs a few divisions, and not each pixel in it a look at the map.
    pub(crate) fn cells(
        self,
        columns: Range<usize>,
    ) -> impl Iterator<Item = (DVec2, Range<usize>)> {
        let mut first = columns.start;
        std::iter::from_fn(move || {
            (first < columns.end).then(|| {
                let corner = self.point(first).floor();
                let start = first;
                first = self.end_of_cell(corner, start..columns.end);
                (corner, start..first)
            })
        })
    }

    /// The first of `columns` that does not show the cell at `corner` as the first one does; where they
    /// end if there is none.
    fn end_of_cell(&self, corner: DVec2, columns: Range<usize>) -> usize {
        let along = |from: f64, corner: f64, half_step: f64| {
            let edge = if half_step > 0.0 { corner + 1.0 } else { corner };
            (edge - from) / (2.0 * half_step)
        };
        let from = self.point(columns.start);
        let along_x = along(from.x, corner.x, self.half_step.x);
        let along_y = along(from.y, corner.y, self.half_step.y);
        // Steps of 0 never get to an edge, and make something that is no number or below 0 of it.
        let is_ahead = |&along: &f64| along >= 0.0;
        let pixels = [along_x, along_y].into_iter().filter(is_ahead).fold(f64::INFINITY, f64::min);
        let least = columns.start + 1;
        let mut end = columns.start.saturating_add(pixels as usize).clamp(least, columns.end);
        // Rounding may be off by a pixel; the pixels themselves know.
        let shows = |x: usize| self.point(x).floor() == corner;
        while end > least && !shows(end - 1) {
            end -= 1;
        }
        while end < columns.end && shows(end) {
            end += 1;
        }
        end
    }

    /// The places of the pixels from column `x` on within the repeats of something that repeats
    /// `per_cell` times in a cell, along both axes.
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

    /// From the middle of the row to the centre of a pixel.
    fn half_steps_to(&self, x: usize) -> i64 {
        2 * x as i64 + 1 - i64::from(self.width)
    }
}

/// Places within a repeat, one for each pixel, in 2⁻⁶⁴ths of it along both axes.
#[derive(Clone, Debug)]
pub(crate) struct TexelPlaces {
    x: u64,
    y: u64,
    x_step: u64,
    y_step: u64,
}

impl TexelPlaces {
    /// The first of them, along both axes.
    pub(crate) fn first(&self) -> [u64; 2] {
        [self.x, self.y]
    }

    /// From one to the next, along both axes.
    pub(crate) fn steps(&self) -> [u64; 2] {
        [self.x_step, self.y_step]
    }

    /// Goes on by `count` pixels.
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
        // Integers that wrap around lose nothing.
        self.x = self.x.wrapping_add(self.x_step);
        self.y = self.y.wrapping_add(self.y_step);
        Some(place)
    }
}

/// What is behind the decimal point of `number`, in 2⁻⁶⁴ths; 0 for what is no number.
fn fraction(number: f64) -> u64 {
    const WHOLE: f64 = 18_446_744_073_709_551_616.0;
    /// From here on doubles are whole.
    const LARGE: f64 = (1_u64 << f64::MANTISSA_DIGITS) as f64;
    let size = number.abs();
    // `f64::floor` is a call where a processor may be old.
    let rest = if size < LARGE { size - size as i64 as f64 } else { 0.0 };
    let fraction = (rest * WHOLE) as u64;
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
        fn every_pixel_is_in_the_cell_that_it_shows(
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
        fn places_are_those_of_the_points(
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
