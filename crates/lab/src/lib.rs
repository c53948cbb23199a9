//! Measurements of Cellcaster. Playing and drawing need none of them.
//!
//! - [`casters`]: casters to compare with the exact one.
//! - [`accuracy`]: rational arithmetic as the reference, and rays that are difficult for a caster.
//! - [`speed`]: scenes, and the loops with which drawing is compared.
//! - [`wire`]: bytes and colour errors of encoders for a game's frames.
//! - [`report`]: tables of figures, and their formats.
//! - [`cli`]: the command line, which reports the figures.

#![allow(missing_docs, reason = "the crate is a program, not an interface for others")]

pub mod accuracy;
pub mod casters;
pub mod cli;
#[cfg(target_os = "linux")]
mod load;
pub mod report;
pub mod speed;
pub mod wire;
