//! The command line of the laboratory.

mod accuracy;
mod bench;
mod wire;

use std::ffi::OsString;
use std::process::ExitCode;

use cellcaster::cli::{Error, exit_code, parse, run_cast};
use clap::{Args, Parser, Subcommand};

use crate::casters::Method;
#[cfg(target_os = "linux")]
use crate::load;

/// Measurements of Cellcaster
#[derive(Debug, Parser)]
#[command(name = "cellcaster-lab", version = cellcaster::VERSION, max_term_width = 80)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Accuracy(accuracy::Accuracy),
    Bench(bench::Bench),
    Wire(wire::Wire),
    #[cfg(target_os = "linux")]
    Load(load::Load),
    /// Run the game's command of this name with any of the lab's casters
    #[command(disable_help_flag = true)]
    Cast(Forwarded),
}

/// The arguments of a command that also exists in the game.
#[derive(Args, Debug)]
struct Forwarded {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    words: Vec<OsString>,
}

/// Runs the command that `words` request, and returns the exit status. The first word is the program's own name.
pub fn run(words: impl IntoIterator<Item = OsString>) -> ExitCode {
    let command = match parse::parse::<Arguments>(words) {
        Ok(Some(arguments)) => arguments.command,
        Ok(None) => return ExitCode::SUCCESS,
        Err(error) => return exit_code(Err(error)),
    };
    exit_code(match command {
        Command::Accuracy(options) => accuracy::run(&options),
        Command::Bench(options) => bench::run(&options),
        Command::Wire(options) => wire::run(&options),
        #[cfg(target_os = "linux")]
        Command::Load(options) => load::run(&options),
        Command::Cast(forwarded) => return cast(forwarded),
    })
}

/// Runs the game's command `cast` with the casters of the laboratory.
fn cast(forwarded: Forwarded) -> ExitCode {
    let words = ["cellcaster", "cast"].into_iter().map(OsString::from).chain(forwarded.words);
    run_cast(words, |name| {
        let method: Method =
            name.parse().map_err(|error| Error::mistake(format!("--caster {name}: {error}")))?;
        Ok(method.caster())
    })
}
