//! Colours: sRGB as it is stored, the amounts of light that it stands for, and spaces in which distance is
//! difference as people see it.
//!
//! Each conversion is here once, with its source. Pictures are made of [`Rgb`]; the rest serves those that
//! average, compare or reduce colours.

pub(crate) mod oklab;
pub mod palette;
mod rgb;

pub use rgb::{ParseColorError, Rgb};
