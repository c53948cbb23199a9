//! Colours: sRGB, linear light, palettes, and colour spaces in which distance is perceived
//! difference.
//!
//! Each conversion exists once, with its source. Pictures consist of [`Rgb`]; the other modules
//! serve code that averages, compares or reduces colours. A crate for colour spaces was refused:
//! pictures must be the same, bit for bit, on every machine and with every version.

pub mod lab;
pub mod oklab;
pub mod palette;
mod rgb;
pub mod srgb;

use std::ops::{Add, Mul};

pub use rgb::{ParseColorError, Rgb};

/// The product of a matrix, given by rows, and a vector.
#[inline]
fn product<T: Copy + Add<Output = T> + Mul<Output = T>>(
    rows: &[[T; 3]; 3],
    [x, y, z]: [T; 3],
) -> [T; 3] {
    rows.map(|[a, b, c]| a * x + b * y + c * z)
}
