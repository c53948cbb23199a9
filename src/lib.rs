//! Cellcaster: a raycaster whose picture is made of terminal cells.
//!
//! Data goes one way, and each stage is a module that can be called alone:
//!
//! ```text
//! maps/*.toml ─ map ─▶ World ─ game ─▶ World + Camera ─ render ─▶ Frame ─ tui ─▶ Buffer ─ terminal ─▶ bytes
//! ```

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
#[cfg(feature = "lab")]
pub mod lab;
pub mod map;
mod numeric;
pub mod render;
pub mod rng;
pub mod space;
#[cfg(feature = "terminal")]
pub mod terminal;
#[cfg(feature = "tui")]
pub mod tui;
pub mod world;
