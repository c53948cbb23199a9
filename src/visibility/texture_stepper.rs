//! The texture stepper: the texel of a face at the centre of each row of pixels.
//!
//! Texels are counted from eye height. However near a face is, the rows above the horizon therefore show the
//! part of it above the eye. Positions are in fixed point and computed from the row's own index, so no error
//! accumulates and a step is one addition. Rejected: counting in doubles. A conversion and a floor for each
//! pixel took half the time of a whole frame.

use std::ops::Range;

use crate::numeric::rounding::{ceil, floor, rounded, rounded_to_even};

/// The texels of an upright face in a picture, at any distance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FaceTexels {
    /// The number of texels per height of the texture, and the uppermost and the lowest texel on the face,
    /// counted from the top of the uppermost texture.
    count: i64,
    range: (i64, i64),
    /// The position of eye height, in fixed point.
    at_horizon: i64,
    horizon: Horizon,
    /// Half of a step at distance 1.
    half_step_at_1: f64,
}

/// The horizon of a picture, for the steppers of its faces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Horizon {
    /// The number of half rows from the horizon to the centre of row 0.
    half_rows_to_first: i64,
    /// The least size of half a step.
    least: i64,
}

/// The texel of an upright face at each row of pixels, at one distance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct TextureStepper {
    /// The position at the centre of row 0, even if the row is not on the face.
    first: i64,
    /// The step from one row to the next.
    step: i64,
    /// The uppermost and the lowest texel on the face.
    range: (i64, i64),
    count: i64,
}

impl FaceTexels {
    /// The texels of a face from `top` to `bottom`, in cells down from the top of its uppermost texture. The
    /// texture has `count` texels per cell of height, at least one. `at_eye` is the position of eye height, in
    /// cells down from the same point. At distance 1, a row of pixels covers `height_of_row` cells.
    pub(crate) fn new(
        count: usize,
        (top, bottom): (f64, f64),
        at_eye: f64,
        (horizon, height_of_row): (Horizon, f64),
    ) -> Self {
        let in_texels = |cells: f64| cells * count as f64;
        let uppermost = floor(in_texels(top));
        let lowest = (ceil(in_texels(bottom)) - 1).max(uppermost);
        Self {
            count: count as i64,
            range: (uppermost, lowest),
            at_horizon: rounded(in_texels(at_eye) * TEXEL).wrapping_add(EPSILON),
            horizon,
            half_step_at_1: in_texels(height_of_row) / 2.0 * TEXEL,
        }
    }

    /// The stepper at distance `t`.
    #[inline]
    pub(crate) fn at(&self, t: f64) -> TextureStepper {
        let &Self { count, range, at_horizon, horizon, half_step_at_1 } = self;
        let half_step = rounded_to_even((t * half_step_at_1).min(MAX_HALF_STEP));
        let half_step = half_step.max(horizon.least);
        // Positions far above or below the face wrap around, and are correct again at the face.
        let from_horizon = half_step.wrapping_mul(horizon.half_rows_to_first);
        TextureStepper {
            first: at_horizon.wrapping_add(from_horizon),
            step: 2 * half_step,
            range,
            count,
        }
    }
}

impl Horizon {
    /// The horizon `half_rows` half rows below the top of a picture.
    pub(crate) fn new(half_rows: f64) -> Self {
        // With a smaller step, `EPSILON` would move a row above the horizon to a texel below it. If the horizon
        // is far outside the picture, the least step would add up to texels beyond the face.
        let is_far = half_rows.abs() > FARTHEST_HORIZON;
        Self {
            half_rows_to_first: 1 - half_rows as i64,
            least: if is_far { 0 } else { 2 * EPSILON },
        }
    }
}

impl TextureStepper {
    /// The texel of the texture at the centre of `row`. If rounding puts the centre slightly above or below the
    /// face, it is the nearest texel of the face.
    #[inline]
    pub(crate) fn at(self, row: u32) -> usize {
        self.texel_at(self.place(row) >> TEXEL_BITS)
    }

    /// A range that contains the texels of the texture shown in `rows`, which must not be empty. It may contain
    /// other texels.
    #[inline]
    pub(crate) fn texels_of(self, rows: &Range<u32>) -> Range<usize> {
        let [first, last] = [rows.start, rows.end - 1].map(|row| self.place(row) >> TEXEL_BITS);
        let is_inside = 0 <= first && first <= last && last < self.count;
        if is_inside { first as usize..last as usize + 1 } else { 0..self.count as usize }
    }

    /// Returns true if the centres of the first and the last of `rows` are on the face even after rounding.
    #[inline]
    pub(crate) fn has_ends_of(self, rows: &Range<u32>) -> bool {
        let (uppermost, lowest) = self.range;
        let size = ((lowest + 1 - uppermost) as u64) << TEXEL_BITS;
        let first = self.place(rows.start).wrapping_sub(uppermost << TEXEL_BITS);
        let last = first.wrapping_add(self.step.wrapping_mul(i64::from(rows.end - 1 - rows.start)));
        // A position above the face is negative, and therefore greater than `size` as an unsigned number.
        (first as u64) < size && (last as u64) < size
    }

    /// The texel of the texture at `place`, a texel counted from the top of the uppermost texture.
    #[inline]
    fn texel_at(self, place: i64) -> usize {
        let (uppermost, lowest) = self.range;
        let texel = place.clamp(uppermost, lowest);
        // A test comes first, because a division takes as long as all the other operations.
        let is_first = (0..self.count).contains(&texel);
        (if is_first { texel } else { texel.rem_euclid(self.count) }) as usize
    }

    /// The position at the centre of `row` and the step to the next row. Both are shifted so that the uppermost
    /// `BITS` bits are the texel modulo 2 to the power of `BITS`.
    #[inline]
    pub(crate) fn in_uppermost<const BITS: u32>(self, row: u32) -> (u64, u64) {
        let to_the_top = u64::BITS - TEXEL_BITS - BITS;
        ((self.place(row) as u64) << to_the_top, (self.step as u64) << to_the_top)
    }

    #[inline]
    fn place(self, row: u32) -> i64 {
        self.first.wrapping_add(self.step.wrapping_mul(i64::from(row)))
    }
}

/// The size of a texel, in fixed point.
const TEXEL: f64 = (1_u64 << TEXEL_BITS) as f64;
const TEXEL_BITS: u32 = 40;
/// The greatest half step: 65 536 texels from one row to the next. With a greater step, only one row shows the
/// face.
const MAX_HALF_STEP: f64 = 32_768.0 * TEXEL;
/// The offset that moves a row's centre between two texels to the lower one, however the step was rounded. The
/// rounding errors of 4096 rows, half a unit each, add up to half the offset.
const EPSILON: i64 = 1 << 12;
/// The farthest horizon for which the least step applies, in half rows. The least step adds up to 1/32 of a
/// texel over this distance.
const FARTHEST_HORIZON: f64 = (1_u64 << 22) as f64;

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The stepper of a face with `count` texels per cell. `ends` and `at_eye` are in cells down from the top
    /// of its uppermost texture. A row of pixels covers `height_of_row` cells of it.
    fn stepper(
        count: usize,
        (ends, at_eye): ((f64, f64), f64),
        half_rows: f64,
        height_of_row: f64,
    ) -> TextureStepper {
        FaceTexels::new(count, ends, at_eye, (Horizon::new(half_rows), 1.0)).at(height_of_row)
    }

    const WALL: (f64, f64) = (0.0, 1.0);

    #[test]
    fn half_the_picture_shows_half_the_wall_at_any_distance() {
        for near in [0.0, f64::MIN_POSITIVE, 1e-30, 1e-9] {
            let texels = stepper(64, (WALL, 0.5), 90.0, near);
            assert_eq!((texels.at(44), texels.at(45)), (31, 32), "{near}");
        }
    }

    #[test]
    fn rows_stay_near_their_texels_however_far_the_horizon_is() {
        for (rows, at_eye) in (0..31).flat_map(|power| [(1_i64 << power, 0.02), (1 << power, 0.9)])
        {
            // The top row of a picture shows the end of the wall, and the horizon is `rows` rows below.
            let of_face = [0.0, f64::MIN_POSITIVE, at_eye / (rows as f64 + 0.5)];
            for height_of_row in of_face {
                let half_rows = 2.0 * rows as f64;
                let texels = stepper(1, (WALL, at_eye), half_rows, height_of_row);
                let texel = texels.place(0) >> TEXEL_BITS;
                assert!((-1..2).contains(&texel), "{rows}, {height_of_row}: {texel}");
            }
        }
    }

    #[test]
    fn a_row_between_two_texels_takes_the_lower_one() {
        // Thirds and sevenths have no finite binary fraction.
        for (rows, count) in [(3_u32, 1_u32), (7, 3), (21, 5), (63, 64), (4095, 3)] {
            let height_of_row = 1.0 / f64::from(rows);
            let texels = stepper(count as usize, (WALL, 0.5), f64::from(rows), height_of_row);
            for row in 0..rows {
                let exact = (2 * row + 1) * count / (2 * rows);
                assert_eq!(texels.at(row), exact as usize, "{row} of {rows}");
            }
        }
    }

    #[test]
    fn a_high_face_repeats_its_texture_at_each_integer_height() {
        // A face from 0.25 to 2.5, seen from 1. The top of its uppermost texture is at 3.
        let texels = stepper(4, ((0.5, 2.75), 2.0), 12.0, 0.25);
        let seen: Vec<usize> = (0..9).map(|row| texels.at(row)).collect();
        assert_eq!(seen, [2, 3, 0, 1, 2, 3, 0, 1, 2]);
    }

    proptest! {
        #[test]
        fn a_row_shows_the_texel_computed_in_doubles(
            height in 1_u32..4096,
            rows in 0.01..9000.0_f64,
            at_eye in 0.02..0.98,
            count in 1_usize..4097,
        ) {
            let texels = stepper(count, (WALL, at_eye), f64::from(height), 1.0 / rows);
            for row in 0..height {
                let from_horizon = f64::from(2 * row + 1) / 2.0 - f64::from(height) / 2.0;
                let place = (from_horizon / rows + at_eye) * count as f64;
                let is_on_wall = place >= 0.0 && place < count as f64;
                if is_on_wall && (place - place.round()).abs() > 1e-6 {
                    prop_assert_eq!(texels.at(row), place as usize);
                }
            }
        }
    }
}
