//! The command line, from arguments to standard output.

mod arguments;
mod art;
mod compare;
mod descents;
mod full_disk;
mod hostile;
mod recordings;
mod scores;
mod text_mode;
mod tiled;

#[path = "../support/asciicast.rs"]
mod asciicast;
#[path = "../support/looks.rs"]
mod looks;
#[allow(dead_code, reason = "this file uses a share of it")]
#[path = "../support/pilot.rs"]
mod pilot;
#[path = "../support/mod.rs"]
mod support;
#[allow(dead_code, reason = "this file uses a share of it")]
#[path = "../support/ways.rs"]
mod ways;
