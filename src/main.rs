//! The `cellcaster` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    cellcaster::cli::run(std::env::args_os())
}
