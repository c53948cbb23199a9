//! Cellcaster: a raycaster whose picture is made of terminal cells.
//!
//! Data goes one way, and each stage is a module that can be called alone:
//!
//! ```text
//! maps/*.toml ─ map ─▶ World ─ game ─▶ World + Camera ─ visibility ─▶ DrawList ─ raster ─▶ Frame ─ tui ─▶ Canvas ─ terminal ─▶ bytes
//!   (text)            (what exists)   (what happens)                (what shows)         (pixels)       (cells)
//! ```
//!
//! # Where to start
//!
//! | to | start with |
//! |---|---|
//! | read a map | [`map::load`], [`map::parse`], or [`map::builtin::LEVELS`] |
//! | draw a frame | [`render::Renderer::render`], into a [`render::Frame`] |
//! | show a frame in a ratatui program | `tui::FirstPerson`, beside `tui::Minimap` |
//! | move a player | [`game::Game::step`], with the [`game::Intents`] of each step |
//! | track held keys, with or without key releases | `tui::HeldKeys` |
//! | send cells to a terminal in few bytes | `terminal::CellWriter` |
//! | cast single rays | [`cast::Exact`] and the [`cast::Caster`] trait |
//! | generate levels | [`generate::Generator`] and [`generate::Window`] |
//!
//! ```
//! use cellcaster::map::builtin;
//! use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
//! use cellcaster::world::FieldOfView;
//!
//! let world = builtin::LEVELS[0].world()?;
//! let camera = world.start_camera(FieldOfView::default());
//! let mut frame = Frame::new(FrameSize::new(160, 90).unwrap(), PixelAspect::SQUARE);
//! Renderer::new().render(&world, &camera, &mut frame);
//! println!("the pixel in the middle is {}", frame.pixel(80, 45));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ARCHITECTURE.md in the repository lists the modules from the bottom up and the invariants that
//! code may rely on.
//!
//! # Features
//!
//! Each feature needs the one before it: `tui` (the ratatui widgets), `terminal` (the terminal, and
//! the game in it) and `cli` (the command line), which is the default. Without features, the crate
//! is the engine alone, which uses no terminal crate.

#[cfg(test)]
extern crate self as cellcaster;

#[cfg(feature = "terminal")]
#[allow(
    missing_docs,
    clippy::missing_errors_doc,
    clippy::return_self_not_must_use,
    reason = "much is public for the server alone, and is what its name says"
)]
pub mod app;
pub mod cast;
#[cfg(feature = "cli")]
#[allow(clippy::missing_errors_doc, reason = "each error is a sentence for the user")]
pub mod cli;
pub mod color;
pub mod fault;
pub mod game;
pub mod generate;
pub mod map;
pub mod numeric;
mod raster;
pub mod render;
pub mod rng;
mod sort;
pub mod space;
#[cfg(feature = "terminal")]
pub mod terminal;
#[cfg(feature = "tui")]
pub mod tui;
mod visibility;
pub mod world;

/// The examples of the README, compiled and run as tests.
#[cfg(all(doctest, feature = "cli"))]
#[doc = include_str!("../README.md")]
struct Readme;
