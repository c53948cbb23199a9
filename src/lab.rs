//! Measurements: the casters compared, their errors, the speed of drawing, and the bytes of a game.
//!
//! Nothing here is needed to play or to draw. The command line reports the figures, and tests and benchmarks
//! repeat them; no other module knows this one.
//!
//! - [`casters`]: methods of casting besides the exact one.
//! - [`accuracy`]: rational arithmetic as the truth, and the rays that are hardest on a caster.
//! - [`speed`]: scenes, and the loops that drawing is compared with.
//! - [`wire`]: bytes against error, for ways to encode a game's frames.

pub mod accuracy;
pub mod casters;
pub mod speed;
pub mod wire;
