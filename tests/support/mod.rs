//! Functions that tests of the whole program share.
#![allow(dead_code, reason = "every test file uses its own share of this")]

use std::io::Write;
use std::process::{Command, Output, Stdio};

use cellcaster::testing::CellGrid;

/// The program in an empty environment.
pub(crate) fn cellcaster(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cellcaster"));
    command.args(arguments).env_clear();
    command
}

/// Runs the program with this standard input.
pub(crate) fn run_with_input(arguments: &[&str], input: &[u8]) -> Output {
    let mut child = cellcaster(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(input).unwrap();
    child.wait_with_output().unwrap()
}

/// The program's standard output. Asserts success and an empty standard error.
pub(crate) fn output_of(arguments: &[&str]) -> Vec<u8> {
    let output = cellcaster(arguments).output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{arguments:?}");
    assert_eq!(output.status.code(), Some(0), "{arguments:?}");
    output.stdout
}

/// The cells that the program draws.
pub(crate) fn grid_of(arguments: &[&str]) -> CellGrid {
    let output = output_of(&[arguments, &["--format", "grid"]].concat());
    CellGrid::read_from(&output[..]).unwrap()
}

/// The program's standard error. Asserts the exit status 2.
pub(crate) fn complaint_about(arguments: &[&str]) -> String {
    let output = cellcaster(arguments).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    assert_eq!(String::from_utf8_lossy(&output.stdout), "", "{arguments:?}");
    String::from_utf8(output.stderr).unwrap()
}
