//! The whole program in a pseudo-terminal: its screens, its keys, and the ways in which it ends.
#![cfg(all(unix, feature = "cli"))]

mod campaign;
mod clock;
mod doors;
mod editing;
mod ending;
#[cfg(target_os = "linux")]
mod failures;
mod game;
mod generated;
mod holding;
mod keeping;
mod lagging;
mod layouts;
mod levels;
mod mouse;
mod palette;
mod recording;
mod replaying;
mod resting;
mod settings;
mod showing;
mod signals;
mod slow;
mod titles;
mod tmux;
mod watching;
