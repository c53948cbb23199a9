//! Cellcaster: a raycaster whose picture is made of terminal cells.
//!
//! Data goes one way, and each stage is a module that can be called alone:
//!
//! ```text
//! maps/*.toml ─ map ─▶ World ─ game ─▶ World + Camera ─ render ─▶ Frame ─ tui ─▶ Canvas ─ terminal ─▶ bytes
//!   (text)            (what exists)   (what happens)             (pixels)       (cells)
//! ```
//!
//! # Modules
//!
//! From the bottom up; a module knows only those above its line.
//!
//! | module | is | feature |
//! |---|---|---|
//! | `numeric`, [`color`], [`rng`] | exact arithmetic and damped motion; sRGB, L\*a\*b\*, Oklab, palettes; seeded random numbers | |
//! | [`world`] | grid, tiles, things, sprites, textures, cameras | |
//! | [`fault`], [`map`] | diagnostics; the map file: read, validate, diagnose | |
//! | [`cast`] | a ray and a grid: where it hits, exactly | |
//! | [`render`] | world and camera to pixels | |
//! | [`space`] | bodies and camera to pixels, a ray for each pixel | |
//! | [`game`] | rules in fixed steps: player, collision, doors, goals | |
//! | [`generate`] | levels as a function of seed and place | |
//! | `canvas` | cells, and the trait of everything that is drawn on | `tui` |
//! | `tui` | ratatui widgets, held keys | `tui` |
//! | `terminal` | capabilities, bytes to events, cells to bytes, flow control | `terminal` |
//! | `app` | the game as a program: screens, settings, keys to intents, the loop | `terminal` |
//! | `lab` | measurements: casters compared, accuracy, speed, wire | `lab` |
//! | `cli` | the command line | `cli` |
//!
//! # Features
//!
//! They stack: `cli`, the default, needs `lab`, which needs `terminal`, which needs `tui`. Without any of them there is the
//! engine, which uses no terminal crate.

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

/// The examples of the README, compiled and run as tests.
#[cfg(all(doctest, feature = "cli"))]
#[doc = include_str!("../README.md")]
struct Readme;
