//! Texels down a wall: which one the centre of a row of pixels is on.
//!
//! They are counted from eye height, so that however near the wall is, the upper half of the picture
//! shows its upper half; and in fixed point, by the row's own index, so that no error adds up and a
//! step is one addition. Counting in doubles was refused: a conversion and a floor for each pixel
//! took half the time of a whole frame.

use std::iter;

/// The texels of a wall, from top to bottom, by rows of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TexelsDown {
    /// Where the centre of row 0 is, even where that is not on the wall.
    first: i64,
    /// From one row to the next.
    step: i64,
    last: usize,
}

impl TexelsDown {
    /// The texels of a wall that is `count` of them high and has its middle `half_rows_to_middle`
    /// halves of a row below the top of the picture; a row covers `height_of_row` of the wall.
    pub(super) fn new(half_rows_to_middle: f64, height_of_row: f64, count: usize) -> Self {
        let texels_in_row = (height_of_row * count as f64).min(MOST_TEXELS);
        // A smaller step would not get past the hair, and a row above the middle below it.
        let half_step = ((texels_in_row / 2.0 * TEXEL).round() as i64).max(2 * HAIR);
        let middle = (count as i64) * (TEXEL as i64 / 2) + HAIR;
        // What is far above the wall wraps around, and is back where the wall begins.
        let half_rows_to_first = 1 - half_rows_to_middle as i64;
        let first = middle.wrapping_add(half_step.wrapping_mul(half_rows_to_first));
        Self { first, step: 2 * half_step, last: count - 1 }
    }

    /// Which texel the centre of `row` is on: the nearest one where it is above or below the wall by
    /// less than rounding.
    #[inline]
    pub(super) fn at(self, row: u32) -> usize {
        self.from(row).next().unwrap_or_default().min(self.last)
    }

    /// The texels of all rows from `row` on. By rounding, the last of them may be one too many.
    #[inline]
    pub(super) fn from(self, row: u32) -> impl Iterator<Item = usize> {
        let mut place = self.first.wrapping_add(self.step.wrapping_mul(i64::from(row)));
        iter::repeat_with(move || {
            // On the wall it is not negative: the hair is wider than all rounding.
            let texel = (place >> TEXEL_BITS) as usize;
            place = place.wrapping_add(self.step);
            texel
        })
    }
}

/// A texel, in fixed point.
const TEXEL: f64 = (1_u64 << TEXEL_BITS) as f64;
const TEXEL_BITS: u32 = 40;
/// The most texels from one row to the next; where there are more, only one row shows the wall.
const MOST_TEXELS: f64 = 65_536.0;
/// Where the centre of a row is on the line between two texels it is on the lower one, however the
/// step to it was rounded: 4096 rows of rounding by half a unit are half as much.
const HAIR: i64 = 1 << 12;

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn the_halves_of_the_picture_show_the_halves_of_a_wall_however_near() {
        for near in [0.0, f64::MIN_POSITIVE, 1e-30, 1e-9] {
            let texels = TexelsDown::new(90.0, near, 64);
            assert_eq!((texels.at(44), texels.at(45)), (31, 32), "{near}");
        }
    }

    #[test]
    fn a_row_between_two_texels_is_on_the_lower_one() {
        // Thirds and sevenths are not to be had in binary.
        for (rows, count) in [(3_u32, 1_u32), (7, 3), (21, 5), (63, 64), (4095, 3)] {
            let texels = TexelsDown::new(f64::from(rows), 1.0 / f64::from(rows), count as usize);
            for row in 0..rows {
                let exact = (2 * row + 1) * count / (2 * rows);
                assert_eq!(texels.at(row), exact as usize, "{row} of {rows}");
            }
        }
    }

    proptest! {
        #[test]
        fn a_row_is_on_the_texel_that_doubles_say(
            height in 1_u32..4096,
            wall in 0.01..9000.0_f64,
            count in 1_usize..4097,
        ) {
            let texels = TexelsDown::new(f64::from(height), 1.0 / wall, count);
            for row in 0..height {
                let from_middle = f64::from(2 * row + 1) / 2.0 - f64::from(height) / 2.0;
                let place = (from_middle / wall + 0.5) * count as f64;
                let is_on_wall = place >= 0.0 && place < count as f64;
                if is_on_wall && (place - place.round()).abs() > 1e-6 {
                    prop_assert_eq!(texels.at(row), place as usize);
                }
            }
        }
    }
}
