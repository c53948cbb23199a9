//! The arguments: words to typed options, each mistake one sentence.

mod accuracy;
mod bench;
mod cast;
mod check;
mod config;
mod generated;
mod play;
mod replay;
mod snapshot;
mod value;
mod wire;

use std::ffi::{OsStr, OsString};

use lexopt::{Arg, Parser};

pub(super) use self::accuracy::{Accuracy, ReportFormat};
pub(super) use self::bench::{Bench, BenchFormat};
pub(super) use self::cast::Cast;
pub(super) use self::config::Config;
pub(super) use self::generated::Generated;
pub(super) use self::play::Play;
pub(super) use self::replay::Replay;
pub(super) use self::snapshot::{Format, Snapshot};
pub(super) use self::wire::{Wire, WireFormat};
use super::Error;
use crate::fault;

/// What is asked for.
#[derive(Debug)]
pub(super) enum Command {
    Help,
    Version,
    Play(Play),
    Snapshot(Snapshot),
    Cast(Cast),
    Check(Vec<OsString>),
    Config(Config),
    Accuracy(Accuracy),
    Bench(Bench),
    Replay(Replay),
    Wire(Wire),
}

impl Command {
    /// What `arguments` ask for, the program's own name first.
    pub(super) fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Self, Error> {
        let arguments: Vec<OsString> = arguments.into_iter().skip(1).collect();
        let (name, rest) = match arguments.split_first() {
            Some((first, rest)) if is_command(first) => (first.to_str().unwrap_or_default(), rest),
            _ => ("play", arguments.as_slice()),
        };
        let parser = Parser::from_args(rest);
        match name {
            "snapshot" => snapshot::parse(parser),
            "cast" => cast::parse(parser),
            "check" => check::parse(parser),
            "config" => config::parse(parser),
            "accuracy" => accuracy::parse(parser),
            "bench" => bench::parse(parser),
            "replay" => replay::parse(parser),
            "wire" => wire::parse(parser),
            "help" => Ok(Self::Help),
            _ => play::parse(parser),
        }
    }
}

pub(super) const COMMANDS: [&str; 10] =
    ["play", "snapshot", "cast", "check", "config", "accuracy", "bench", "replay", "wire", "help"];

fn is_command(argument: &OsStr) -> bool {
    COMMANDS.iter().any(|&command| argument == command)
}

/// The next argument.
fn next(parser: &mut Parser) -> Result<Option<Arg<'_>>, Error> {
    // What can go wrong here is a value for an option that takes none, such as `--help=yes`.
    parser.next().map_err(|error| Error::mistake(error.to_string()))
}

/// The word after an option.
fn word(parser: &mut Parser, name: &str, takes: &str) -> Result<OsString, Error> {
    parser
        .value()
        .map_err(|_| Error::mistake(format!("{name} takes {takes}, and nothing follows it")))
}

fn unexpected(command: &str, options: &[&str], argument: Arg<'_>) -> Error {
    let help = "\"cellcaster --help\" lists what there is";
    match argument {
        Arg::Value(value) => Error::mistake(format!(
            "{command} takes one map, and \"{}\" is one too many; {help}",
            value.display()
        )),
        Arg::Short(letter) => Error::mistake(format!("{command} has no option -{letter}; {help}")),
        Arg::Long(name) => {
            let name = format!("--{name}");
            let meant = fault::nearest(&name, options);
            let hint = meant.map_or(help.to_owned(), |meant| format!("did you mean {meant}?"));
            Error::mistake(format!("{command} has no option {name}; {hint}"))
        }
    }
}
