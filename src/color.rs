//! Colours: sRGB as it is stored, the light that it stands for, palettes, and spaces in which distance is
//! difference as people see it.
//!
//! Each conversion is here once, with its source. Pictures are made of [`Rgb`]; the other modules serve code that
//! averages, compares or reduces colours. A crate for colour spaces was refused: pictures must come out the same on every
//! machine and with every version, bit for bit.

pub mod lab;
pub(crate) mod oklab;
pub mod palette;
mod rgb;
pub(crate) mod srgb;

use std::ops::{Add, Mul};

pub use rgb::{ParseColorError, Rgb};

/// The product of a matrix, row by row, and a vector.
#[inline]
fn product<T: Copy + Add<Output = T> + Mul<Output = T>>(
    rows: &[[T; 3]; 3],
    [x, y, z]: [T; 3],
) -> [T; 3] {
    rows.map(|[a, b, c]| a * x + b * y + c * z)
}
