//! `cellcaster-lab` measures what Cellcaster claims: how exact, how fast, how few bytes, how many players. Playing and
//! drawing need none of it.
//!
//! Every figure of docs/accuracy.md, docs/performance.md and docs/wire.md comes from one of its commands:
//!
//! ```text
//! cellcaster-lab accuracy    errors against run time, of rays, pictures and motion
//! cellcaster-lab bench       speed, beside the loop that tutorials teach
//! cellcaster-lab wire        bytes of frames against colour error
//! cellcaster-lab load        the cost of players on a server, over real SSH
//! ```
//!
//! # A measurement
//!
//! A measurement compares candidates with a truth that shares no code with them. For rays, the candidates are the
//! [`casters`], and the truth is rational arithmetic:
//!
//! ```
//! use cellcaster::cast::Caster;
//! use cellcaster::map::builtin;
//! use cellcaster::rng::SplitMix64;
//! use cellcaster_lab::accuracy::{cast, random_ray};
//! use cellcaster_lab::casters::Method;
//!
//! let world = builtin::LEVELS[0].world()?;
//! let grid = world.grid();
//! let wrong = |method: &str| {
//!     let caster = method.parse::<Method>().unwrap().caster();
//!     let mut random = SplitMix64::new(1);
//!     let rays = (0..1000).map(|_| random_ray(grid, &mut random));
//!     let is_wrong = |ray: &_| match (cast(grid, ray), caster.cast(grid, ray)) {
//!         (Some(truth), Some(hit)) => !truth.is_met_by(&hit),
//!         (truth, hit) => truth.is_some() || hit.is_some(),
//!     };
//!     rays.filter(is_wrong).count()
//! };
//! assert_eq!(wrong("exact"), 0);
//! assert!(wrong("table:480") > 0, "480 angles are too few");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The flow
//!
//! ```text
//! scenes, rays, scripts ─ accuracy, speed, wire ─▶ Table ─ report ─▶ Markdown, JSON, CSV, SVG
//! ```
//!
//! Every measurement is a [`report::Table`], so one writer for each format serves all. Errors and counts are the same
//! in every run, and tests compare them with the pages. Times differ, so candidates take turns and only their ratios
//! count.
//!
//! # Where to go next
//!
//! - [`casters`]: the methods of tutorials and other programs, and how to add one.
//! - [`accuracy`]: the truths, and the rays that are hard for a caster.
//! - [`speed`]: the scenes, and the loops with which drawing is compared.
//! - [`wire`]: a script through every encoder, in bytes and in colours.
//! - `load`: clients over SSH, on one server or a cluster.
//! - The folder `benches`: the price list, steps of the game with guards, and counts of instructions by Callgrind.

#![allow(missing_docs, reason = "the crate is a program, not an interface for others")]

pub mod accuracy;
pub mod casters;
pub mod cli;
#[cfg(target_os = "linux")]
mod load;
pub mod report;
pub mod speed;
pub mod wire;
