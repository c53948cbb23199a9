//! The command line of the laboratory, from arguments to standard output.

mod bench;
mod mistakes;
mod wire;

#[path = "../support/mod.rs"]
mod support;
