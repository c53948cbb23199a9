//! The command line: one thin file for each subcommand.
//!
//! A user error prints one sentence to standard error, with exit status 2. A system error prints
//! one sentence, with exit status 1. If the reader closes the pipe, the program ends silently. No
//! argument causes a panic.

pub mod animation;
mod cast;
mod check;
mod compare;
pub mod config;
mod edit;
pub mod error;
mod export;
mod external;
mod help;
mod import;
pub mod level;
mod levels;
pub mod machine;
pub mod options;
pub mod output_file;
pub mod parse;
mod play;
mod recording;
pub mod replay;
mod screen;
mod share;
mod snapshot;
mod watch;

use std::ffi::OsString;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};

pub use error::Error;
use external::External;
pub use replay::ROOM_RECORDING;

use crate::cast::{Caster, Exact};

/// A raycaster game for the terminal, and a renderer for scripts
#[derive(Debug, Parser)]
#[command(
    name = "cellcaster",
    version = crate::VERSION,
    long_about = help::about(),
    after_help = help::WHERE_TO_READ_ON,
    after_long_help = help::more(play::EXAMPLES, &commands()),
    args_conflicts_with_subcommands = true,
    max_term_width = help::WIDTH,
)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    play: play::Play,
}

#[derive(Debug, Subcommand)]
enum Command {
    Play(play::Play),
    Snapshot(snapshot::Snapshot),
    Cast(cast::Cast),
    Check(check::Check),
    Compare(compare::Compare),
    Import(import::Import),
    Export(export::Export),
    Edit(edit::Edit),
    Levels(levels::LevelsCommand),
    Config(config::Config),
    Replay(replay::ReplayCommand),
    Share(share::ShareCommand),
    Completions(help::Completions),
    Man(help::Manual),
}

/// Runs the command in `words`, and returns the exit status. The first word is the name of this
/// program.
pub fn run(words: impl IntoIterator<Item = OsString>) -> ExitCode {
    let words: Vec<OsString> = words.into_iter().collect();
    exit_code(match External::of(&words) {
        Some(external) => external.run(),
        None => run_here(words),
    })
}

fn run_here(mut words: Vec<OsString>) -> Result<(), Error> {
    let Some(arguments) = parse::parse::<Arguments>(words.clone())? else { return Ok(()) };
    if let Some(Command::Cast(options)) = &arguments.command
        && options.caster != cast::EXACT
    {
        words.remove(0);
        return External::laboratory(words).run();
    }
    arguments.run()
}

/// Runs the command `cast` with the caster that `named` returns for the option `--caster`.
pub fn run_cast(
    words: impl IntoIterator<Item = OsString>,
    named: impl Fn(&str) -> Result<Box<dyn Caster>, Error>,
) -> ExitCode {
    exit_code(parse::parse::<Arguments>(words).and_then(|arguments| {
        match arguments.and_then(|arguments| arguments.command) {
            Some(Command::Cast(options)) => cast::run(&options, &*named(&options.caster)?),
            _ => Ok(()),
        }
    }))
}

/// Reports the error of a command or, if there is none, writes the rest of the output. Returns the
/// exit status.
pub fn exit_code(result: Result<(), Error>) -> ExitCode {
    match result.and_then(|()| finish()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => error.report(),
    }
}

impl Arguments {
    fn run(self) -> Result<(), Error> {
        match self.command.unwrap_or(Command::Play(self.play)) {
            Command::Play(options) => play::run(options),
            Command::Snapshot(options) => snapshot::run(&options),
            Command::Cast(options) => cast::run(&options, &Exact),
            Command::Check(options) => check::run(&options),
            Command::Compare(options) => compare::run(&options),
            Command::Import(options) => import::run(&options),
            Command::Export(options) => export::run(&options),
            Command::Edit(options) => edit::run(options),
            Command::Levels(options) => levels::run(&options),
            Command::Config(options) => config::run(options),
            Command::Replay(options) => replay::run(options),
            Command::Share(options) => share::run(&options),
            Command::Completions(completions) => completions.run(Self::command()),
            Command::Man(help::Manual) => help::Manual::run(Self::command()),
        }
    }
}

/// The commands of the program, for its help text.
fn commands() -> clap::Command {
    Command::augment_subcommands(clap::Command::new("cellcaster"))
}

/// Writes the rest of the output. The last line may lack a line end.
fn finish() -> Result<(), Error> {
    io::stdout().flush().map_err(|error| Error::of_output(&error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_of_commands_is_complete() {
        let mut program = Arguments::command();
        program.build();
        assert!(program.get_subcommands().map(clap::Command::get_name).eq(options::COMMANDS));
    }
}
