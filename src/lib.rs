//! Cellcaster: a raycaster whose picture is made of terminal cells.
//!
//! Data goes one way, and each stage is a module that can be called alone:
//!
//! ```text
//! maps/*.toml ─ map ─▶ World ─ game ─▶ World + Camera ─ render ─▶ Frame ─ tui ─▶ Buffer ─ terminal ─▶ bytes
//! ```

#[cfg(feature = "accuracy")]
pub mod accuracy;
#[cfg(feature = "terminal")]
pub mod app;
#[cfg(feature = "tui")]
pub mod canvas;
pub mod cast;
#[cfg(feature = "cli")]
pub mod cli;
pub mod color;
pub mod fault;
pub mod game;
pub mod generate;
pub mod map;
mod numeric;
pub mod render;
pub mod rng;
pub mod space;
#[cfg(feature = "speed")]
pub mod speed;
#[cfg(feature = "terminal")]
pub mod terminal;
#[cfg(feature = "tui")]
pub mod tui;
#[cfg(feature = "cli")]
pub mod wire;
pub mod world;
