//! The command line, from arguments to standard output.

mod arguments;
mod bench;
mod recordings;
mod replay;
mod scores;
mod wire;

#[path = "../support/asciicast.rs"]
mod asciicast;
#[path = "../support/geometry.rs"]
mod geometry;
#[path = "../support/looks.rs"]
mod looks;
#[path = "../support/mod.rs"]
mod support;
