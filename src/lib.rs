//! Cellcaster: a raycaster whose picture is made of terminal cells.
//!
//! Data goes one way, and each stage is a module that can be called alone:
//!
//! ```text
//! maps/*.toml ─ map ─▶ World ─ game ─▶ World + Camera ─ render ─▶ Frame ─ tui ─▶ Buffer ─ terminal ─▶ bytes
//! ```

#[cfg(feature = "accuracy")]
pub mod accuracy;
pub mod cast;
#[cfg(feature = "cli")]
pub mod cli;
pub mod fault;
pub mod game;
pub mod generate;
pub mod map;
pub mod palette;
mod raster;
pub mod render;
pub mod space;
#[cfg(feature = "speed")]
pub mod speed;
#[cfg(feature = "terminal")]
pub mod terminal;
#[cfg(feature = "tui")]
pub mod tui;
mod visibility;
#[cfg(feature = "cli")]
pub mod wire;
pub mod world;
