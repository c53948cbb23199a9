//! Functions that tests of the whole program share.
#![allow(dead_code, reason = "every test file uses its own share of this")]

#[path = "program.rs"]
mod results;

use std::process::Command;

use cellcaster::testing::CellGrid;

use cellcaster as program;
pub(crate) use results::*;

/// The program in an empty environment.
pub(crate) fn cellcaster(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cellcaster"));
    command.args(arguments).env_clear();
    command
}

/// The cells that the program draws.
pub(crate) fn grid_of(arguments: &[&str]) -> CellGrid {
    let output = output_of(&[arguments, &["--format", "grid"]].concat());
    CellGrid::read_from(&output[..]).unwrap()
}
