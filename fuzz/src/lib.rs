//! The fuzz targets of Cellcaster.
//!
//! Each target is a function `run` of bytes that returns for every input, or panics where something is
//! wrong. libFuzzer calls it from `fuzz_targets`, and the test `corpus` with the inputs of `corpus`.

#[cfg(fuzzing)]
pub mod checkpoint;
pub mod decoder;
pub mod encoder;
pub mod maps;
pub mod png;
#[cfg(fuzzing)]
pub mod server;
pub mod texts;

#[path = "../../tests/support/alacritty.rs"]
mod alacritty;
mod bytes;
mod faults;
mod files;
#[path = "../../tests/support/open.rs"]
mod open;
