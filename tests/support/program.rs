//! What a run of a program leaves. The module around this one names the program, as `program`.
#![allow(dead_code, reason = "every test file uses its own share of this")]

use std::io::Write;
use std::process::{Output, Stdio};

use super::program;

/// Runs the program with this standard input.
pub(crate) fn run_with_input(arguments: &[&str], input: &[u8]) -> Output {
    let mut child = program(arguments)
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
    let output = program(arguments).output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{arguments:?}");
    assert_eq!(output.status.code(), Some(0), "{arguments:?}");
    output.stdout
}

/// The program's standard error. Asserts the exit status 2.
pub(crate) fn complaint_about(arguments: &[&str]) -> String {
    let output = program(arguments).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    assert_eq!(String::from_utf8_lossy(&output.stdout), "", "{arguments:?}");
    String::from_utf8(output.stderr).unwrap()
}
