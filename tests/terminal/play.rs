//! The whole program in a real terminal: what it shows, what keys do, and how it ends.
#![cfg(all(unix, feature = "cli"))]

mod doors;
mod ending;
mod game;
mod generated;
mod holding;
mod lagging;
mod layouts;
mod levels;
mod looking;
mod mouse;
mod moving;
mod palette;
mod recording;
mod resting;
mod settings;
mod showing;
mod watching;
