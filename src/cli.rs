//! The command line: one thin file for each subcommand.
//!
//! A user error is reported in one sentence on standard error, with exit status 2. An error of the
//! system is one sentence with status 1. If a reader closes the pipe, the program ends silently. No
//! argument causes a panic.

pub mod arguments;
mod asciicast;
mod cast;
mod check;
mod completions;
pub mod config;
pub mod data_folder;
pub mod error;
mod external;
pub mod level;
mod levels;
mod manual;
pub mod output_file;
mod own_maps;
pub mod parse;
mod play;
mod recording;
mod replay;
pub mod script;
pub mod snapshot;
pub mod today;
pub mod verify;
mod watch;

use std::ffi::OsString;
use std::io::{self, Write};
use std::process::ExitCode;

use arguments::Command;
pub use error::Error;
use external::External;
pub use replay::ROOM_RECORDING;

use crate::render::DynCaster;

/// Runs the command that `arguments` request, and returns the exit status. The first argument is
/// the program's own name.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let words: Vec<OsString> = arguments.into_iter().collect();
    match External::of(&words) {
        Some(external) => exit_code(external.run()),
        None => run_with_caster(words, &DynCaster::default()),
    }
}

/// As [`run`], but walls are found by `caster`, and commands of other programs are unknown.
pub fn run_with_caster(
    arguments: impl IntoIterator<Item = OsString>,
    caster: &DynCaster,
) -> ExitCode {
    exit_code(Command::parse(arguments).and_then(|command| command.run(caster)))
}

/// Reports the error of a command, if there is one, and returns the exit status. Writes what is left of the output.
pub fn exit_code(result: Result<(), Error>) -> ExitCode {
    match result.and_then(|()| finish()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => error.report(),
    }
}

impl Command {
    fn run(self, caster: &DynCaster) -> Result<(), Error> {
        match self {
            Self::Text(text) => print(&text),
            Self::Completions(shell) => completions::run(shell),
            Self::Manual => manual::run(),
            Self::Play(options) => play::run(options, caster),
            Self::Snapshot(options) => snapshot::run(options, caster),
            Self::Cast(options) => cast::run(&options, caster),
            Self::Check(options) => check::run(&options),
            Self::Config(options) => config::run(options),
            Self::Levels(options) => levels::run(&options),
            Self::Replay(options) => replay::run(&options),
        }
    }
}

/// Writes what is left of the last line of output, which may have no end.
fn finish() -> Result<(), Error> {
    io::stdout().flush().map_err(|error| Error::of_output(&error))
}

fn print(text: &str) -> Result<(), Error> {
    io::stdout().write_all(text.as_bytes()).map_err(|error| Error::of_output(&error))
}
