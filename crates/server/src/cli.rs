//! The command line of the server.

#[cfg(unix)]
mod admin;
mod arguments;
mod host_store;
mod replay;
mod scores;
mod serve;

use std::ffi::OsString;
use std::process::ExitCode;

use arguments::{Arguments, ServerCommand};
use cellcaster::cli::{Error, exit_code, parse};

pub use replay::games;

/// Runs the command in `words`, and returns the exit status. The first word is the program's own name.
pub fn run(words: impl IntoIterator<Item = OsString>) -> ExitCode {
    exit_code(parse::parse(words).and_then(|arguments| arguments.map_or(Ok(()), execute)))
}

fn execute(arguments: Arguments) -> Result<(), Error> {
    match arguments.command {
        None => serve::run(arguments.serve),
        #[cfg(unix)]
        Some(ServerCommand::Admin(options)) => admin::run(options),
        Some(ServerCommand::Scores(options)) => scores::run(&options),
        Some(ServerCommand::Replay(options)) => replay::run(&options),
    }
}
