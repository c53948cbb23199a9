//! Functions shared by tests of the whole program.

use std::path::PathBuf;
use std::process::Command;

/// The program with an empty environment.
pub(crate) fn server(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cellcaster-server"));
    command.args(arguments).env_clear();
    command
}

/// The path of the game's program, which is built next to the server's.
pub(crate) fn game_program() -> PathBuf {
    let server = PathBuf::from(env!("CARGO_BIN_EXE_cellcaster-server"));
    server.with_file_name(format!("cellcaster{}", std::env::consts::EXE_SUFFIX))
}
