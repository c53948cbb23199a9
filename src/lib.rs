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
//! | let a player walk | [`game::Game::step`], with the [`game::Intents`] of each step |
//! | tell which keys are held, with or without releases | `tui::HeldKeys` |
//! | send cells to a terminal in few bytes | `terminal::CellWriter` |
//! | cast single rays | [`cast::Exact`] and the [`cast::Caster`] trait |
//! | make levels | [`generate::Generator`] and [`generate::Window`] |
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
//! # Modules
//!
//! From the bottom up; a module knows only those above its line.
//!
//! | module | is | feature |
//! |---|---|---|
//! | `sort`, `numeric`, [`color`], [`rng`] | sorting; exact arithmetic and damped motion; sRGB, L\*a\*b\*, Oklab, palettes; seeded random numbers | |
//! | [`world`] | grid, tiles, things, sprites, textures, cameras | |
//! | [`fault`], [`map`] | diagnostics; the map file: read, validate, diagnose | |
//! | [`cast`] | a ray and a grid: where it hits, exactly | |
//! | `visibility`, `raster`, [`render`] | world and camera to a draw list, the list to pixels, both in turn | |
//! | [`space`] | bodies and camera to pixels, a ray for each pixel | |
//! | [`game`] | rules in fixed steps: player, collision, doors, goals | |
//! | [`generate`] | levels as a function of seed and place | |
//! | `tui` | cells, and what can be drawn on; ratatui widgets, held keys | `tui` |
//! | `terminal` | capabilities, bytes to events, cells to bytes, flow control | `terminal` |
//! | `app::store` | what a player keeps: progress, best runs, preferences | `terminal` |
//! | `app` | the game as a program: screens, settings, keys to intents, the loop | `terminal` |
//! | `lab` | measurements: casters compared, accuracy, speed, wire | `lab` |
//! | `cli` | the command line | `cli` |
//!
//! # Features
//!
//! Each feature needs the one before it: `tui`, `terminal`, `lab`, `cli`. `cli` is the default. Without features there is
//! the engine, which uses no terminal crate.

#[cfg(test)]
extern crate self as cellcaster;

#[cfg(feature = "terminal")]
#[allow(missing_docs, reason = "most fields of settings and panels are what their names say")]
pub mod app;
pub mod cast;
#[cfg(feature = "cli")]
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
pub mod sort;
pub mod space;
#[cfg(feature = "terminal")]
pub mod terminal;
#[cfg(feature = "tui")]
pub mod tui;
pub mod visibility;
pub mod world;

/// The examples of the README, compiled and run as tests.
#[cfg(all(doctest, feature = "cli"))]
#[doc = include_str!("../README.md")]
struct Readme;
