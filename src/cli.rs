//! The command line: one thin file for each subcommand.
//!
//! A user error is reported in one sentence on standard error, with exit status 2. An error of the
//! system is one sentence with status 1. If a reader closes the pipe, the program ends silently. No
//! argument causes a panic.

mod accuracy;
#[cfg(all(unix, feature = "serve"))]
mod admin;
mod arguments;
mod asciicast;
mod bench;
mod cast;
mod check;
mod completions;
mod config;
mod data_folder;
mod error;
#[cfg(feature = "serve")]
mod host_store;
mod level;
mod levels;
mod manual;
mod output_file;
mod own_maps;
mod play;
mod plot;
mod recording;
mod replay;
#[cfg(feature = "serve")]
mod room_recording;
#[cfg(feature = "serve")]
mod scores;
mod script;
#[cfg(feature = "serve")]
mod serve;
mod snapshot;
mod today;
mod verify;
mod watch;
mod wire;

use std::ffi::OsString;
use std::io::{self, Write};
use std::process::ExitCode;

use arguments::Command;
pub use error::Error;

/// Runs the command that `arguments` request, and returns the exit status. The first argument is
/// the program's own name.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    match Command::parse(arguments).and_then(Command::run).and_then(|()| finish()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => error.report(),
    }
}

impl Command {
    fn run(self) -> Result<(), Error> {
        match self {
            Self::Text(text) => print(&text),
            Self::Completions(shell) => completions::run(shell),
            Self::Manual => manual::run(),
            Self::Play(options) => play::run(options),
            Self::Snapshot(options) => snapshot::run(options),
            Self::Cast(options) => cast::run(&options),
            Self::Check(options) => check::run(&options),
            Self::Config(options) => config::run(options),
            #[cfg(all(unix, feature = "serve"))]
            Self::Admin(options) => admin::run(options),
            Self::Accuracy(options) => accuracy::run(&options),
            Self::Bench(options) => bench::run(&options),
            Self::Levels(options) => levels::run(&options),
            Self::Replay(options) => replay::run(&options),
            #[cfg(feature = "serve")]
            Self::Scores(options) => scores::run(&options),
            #[cfg(feature = "serve")]
            Self::Serve(options) => serve::run(options),
            Self::Wire(options) => wire::run(&options),
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
