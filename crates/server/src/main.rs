//! The `cellcaster-server` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    cellcaster_server::cli::run(std::env::args_os())
}
