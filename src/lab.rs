//! Measurements: comparison casters, accuracy, the speed of drawing, and the bytes of a game.
//!
//! Playing and drawing need none of it. The command line reports the figures, and tests and
//! benchmarks repeat them. No other module depends on this one.
//!
//! - [`casters`]: casters to compare with the exact one.
//! - [`accuracy`]: rational arithmetic as the reference, and rays that are difficult for a caster.
//! - [`speed`]: scenes, and the loops with which drawing is compared.
//! - [`wire`]: bytes and colour errors of encoders for a game's frames.

pub mod accuracy;
pub mod casters;
pub mod speed;
pub mod wire;
