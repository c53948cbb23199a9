//! Cellcaster draws levels through the player's eyes, in the cells of a terminal or in pixels, and plays a stealth game
//! in them. It is a library for ratatui programs, and the program `cellcaster` is built on it.
//!
//! This page is a guide. Read it from top to bottom, and leave it where you have what you need.
//!
//! # A picture
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
//! A [`World`](world::World) is a grid of tiles and the things that stand on it. A [`Camera`](world::Camera) is a place
//! in it, a heading and a field of view. A [`Frame`](render::Frame) is the pixels. Keep the
//! [`Renderer`](render::Renderer) from frame to frame: it owns the memory of drawing, so later frames allocate nothing.
//! The same world, camera and time give the same pixels on every machine.
//!
//! # A map
//!
//! Worlds come from map files, whose grid is the floor plan. [`map::load`] reads a file, and [`map::parse_str`] text:
//!
//! ```
//! use cellcaster::map;
//!
//! let text = r#"
//! grid = '''
//! %%%%%
//! %@.X%
//! %%%%%
//! '''
//! [tiles]
//! "%" = { wall = "brick" }
//! [things]
//! "@" = { start = 0 }
//! "X" = { exit = true }
//! "#;
//! let world = map::parse_str(text).unwrap();
//! assert_eq!(world.grid().width(), 5);
//!
//! let faults = map::parse_str(&text.replace("brick", "brik")).unwrap_err();
//! assert!(faults.to_string().contains("brick"), "a fault says what to write instead");
//! ```
//!
//! A world is valid by construction: what can be wrong with a map is a fault, with its place. All faults are reported
//! at once.
//!
//! # A game
//!
//! A [`Game`](game::Game) is a world with a player in it. It goes on by steps of a sixtieth of a second, each with the
//! [`Intents`](game::Intents) of the player:
//!
//! ```
//! # use cellcaster::map::builtin;
//! use cellcaster::game::{Game, Intent};
//!
//! let mut game = Game::new(builtin::LEVELS[0].world()?);
//! let mut same = game.clone();
//! for _ in 0..60 {
//!     let intents = [Intent::Forward, Intent::TurnLeft].into_iter().collect();
//!     game.step(intents);
//!     same.step(intents);
//! }
//! assert_eq!(game.elapsed(), 1.0);
//! assert_eq!(game.checksum(), same.checksum());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A game has no clock, and no other input than the intents. So a list of intents is a recording, and a test can play a
//! level. [`Game::camera`](game::Game::camera) and [`Game::world`](game::Game::world) are what to draw.
//!
//! # In a terminal
//!
//! The feature `tui` adds [widgets](tui) for ratatui. They fill any area, in any number of colours:
//!
//! ```
//! # #[cfg(feature = "tui")] {
//! # use cellcaster::{game::Game, map::builtin, world::FieldOfView};
//! # use ratatui::layout::{Constraint, Layout};
//! use cellcaster::tui::{FirstPerson, Minimap, View};
//!
//! # let game = Game::new(builtin::LEVELS[0].world()?);
//! # let mut terminal = ratatui::Terminal::new(ratatui::backend::TestBackend::new(80, 24))?;
//! let mut view = View::default();
//! terminal.draw(|frame| {
//!     let panels = [Constraint::Fill(1), Constraint::Length(24)];
//!     let [left, right] = Layout::horizontal(panels).areas(frame.area());
//!     let (world, camera) = (game.world(), game.camera(FieldOfView::default()));
//!     frame.render_stateful_widget(FirstPerson::new(world, &camera), left, &mut view);
//!     frame.render_widget(Minimap::new(world, &camera).seen(view.distances()), right);
//! })?;
//! # }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`HeldKeys`](tui::HeldKeys) turns the keys of any terminal into intents, also where the terminal reports no
//! releases. The example `walk` in the repository is a whole program.
//!
//! # A test
//!
//! [`testing`] compares what any ratatui program draws with a file beside the test, glyphs and colours alike:
//!
//! ```no_run
//! # #[cfg(feature = "tui")] {
//! # use cellcaster::{map::builtin, tui::FirstPerson, world::FieldOfView};
//! use cellcaster::testing::{CellGrid, assert_grid};
//!
//! # let world = builtin::LEVELS[0].world().unwrap();
//! # let camera = world.start_camera(FieldOfView::default());
//! assert_grid!(CellGrid::of(FirstPerson::new(&world, &camera), 80, 24), "first_level");
//! # }
//! ```
//!
//! # Over a link
//!
//! The feature `terminal` adds what the program itself uses in place of ratatui's backend. A
//! [`CellWriter`](terminal::CellWriter) is a ratatui backend that sends fewer bytes. A [`Session`](terminal::Session)
//! detects what the terminal can do and restores it at every end; a [`Protocol`](terminal::Protocol) does the same over
//! any reader and writer, such as a channel of an SSH server.
//!
//! # The flow
//!
//! Data goes one way, and each stage is a module that can be called alone:
//!
//! ```text
//! maps/*.toml ─ map ─▶ World ─ game ─▶ World + Camera ─ render ─▶ Frame ─ tui ─▶ Canvas ─ terminal ─▶ bytes
//!   (text)            (what exists)   (what happens)             (pixels)      (cells)
//! ```
//!
//! | feature | adds |
//! |---|---|
//! | none | the engine, up to the frame, without any terminal crate |
//! | `tui` | the widgets, held keys, and [snapshot tests](testing) |
//! | `terminal` | the terminal, and the game in it ([`app`]) |
//! | `cli` (default) | the command line |
//!
//! Each feature needs the one before it.
//!
//! # Where to go next
//!
//! - Single rays: [`cast`], whose [`Exact`](cast::Exact) hits what rational arithmetic says.
//! - Levels without an end, and your own generators: [`generate`].
//! - Spheres, planes and boxes in place of a grid: [`space`].
//! - How a frame is drawn: [`render`].
//! - `docs/` in the repository has a page for each subject, and ARCHITECTURE.md the table of all modules, their
//!   invariants and a glossary.

#![cfg_attr(
    not(feature = "terminal"),
    allow(rustdoc::broken_intra_doc_links, reason = "the guide links to all features")
)]

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
pub mod testing;
#[cfg(feature = "tui")]
pub mod tui;
mod visibility;
pub mod world;

/// The version of the package, and the commit of a release build if it is known: "0.1.0 (6a2640d4f3c1)".
pub const VERSION: &str = env!("CELLCASTER_VERSION");
/// The compiler of the build, its level of optimisation, its flags and its target.
pub const BUILD: &str = env!("CELLCASTER_BUILD");

/// The examples of the README, compiled and run as tests.
#[cfg(all(doctest, feature = "cli"))]
#[doc = include_str!("../README.md")]
struct Readme;
