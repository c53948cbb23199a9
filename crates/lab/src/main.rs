//! The `cellcaster-lab` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    cellcaster_lab::cli::run(std::env::args_os())
}
