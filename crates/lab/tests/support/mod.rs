//! Functions that tests of the whole program share.
#![allow(dead_code, reason = "every test file uses its own share of this")]

#[path = "../../../../tests/support/program.rs"]
mod results;

use std::process::Command;

use lab as program;
pub(crate) use results::*;

/// The program in an empty environment.
pub(crate) fn lab(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cellcaster-lab"));
    command.args(arguments).env_clear().current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
    command
}
