//! The command line of the laboratory.

use std::ffi::OsString;
use std::process::ExitCode;

/// Runs the command that `arguments` request, and returns the exit status.
pub fn run(_: impl IntoIterator<Item = OsString>) -> ExitCode {
    ExitCode::SUCCESS
}
