//! Argument parsing: from words to typed options, with one sentence for each mistake.
//!
//! Every subcommand is described once, by a [`Subcommand`]. Parsing, help, completions and the
//! manual page use this description. clap's derive macro was refused: it has no field for the text
//! about an option's valid values, which the sentences about mistakes need.

mod about;
mod cast;
mod check;
mod config;
mod generated;
mod help;
mod levels;
mod map;
mod mistake;
mod option;
mod order;
mod play;
mod replay;
mod snapshot;
mod value;

use std::ffi::OsString;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::error::ErrorKind;
use clap::{Arg, ArgAction, ArgMatches, ValueHint, value_parser};
use clap_complete::Shell;

pub(crate) use self::cast::Cast;
pub(crate) use self::check::Check;
pub(crate) use self::config::Config;
pub(crate) use self::generated::Generated;
pub(crate) use self::levels::{Levels, LevelsFormat};
pub(crate) use self::map::STANDARD_INPUT;
use self::option::OptionSpec;
pub(crate) use self::play::{FidelityChoice, Play};
pub(crate) use self::replay::Replay;
pub(crate) use self::snapshot::{Format, Snapshot};
pub(crate) use self::value::Size;
use super::Error;

/// The requested command.
#[derive(Debug)]
pub(crate) enum Command {
    /// A text to print: help, or the version.
    Text(String),
    Completions(Shell),
    Manual,
    Play(Play),
    Snapshot(Snapshot),
    Cast(Cast),
    Check(Check),
    Config(Config),
    Levels(Levels),
    Replay(Replay),
}

impl Command {
    /// The command that `arguments` request. The first argument is the program's own name.
    pub(crate) fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Self, Error> {
        let (words, subcommand) = order::subcommand_first(arguments.into_iter().collect());
        let mut program = description();
        let subcommand = subcommand.unwrap_or(&play::SUBCOMMAND);
        match program.try_get_matches_from_mut(words) {
            Ok(mut matches) => {
                let matches = match matches.remove_subcommand() {
                    Some((_, matches)) => matches,
                    None => matches,
                };
                (subcommand.read)(matches)
            }
            Err(error) => match error.kind() {
                ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
                    Ok(Self::Text(error.to_string()))
                }
                _ => Err(mistake::of(&error, subcommand)),
            },
        }
    }
}

/// The subcommands in the order of the help.
const SUBCOMMANDS: &[&Subcommand] = &[
    &play::SUBCOMMAND,
    &snapshot::SUBCOMMAND,
    &cast::SUBCOMMAND,
    &check::SUBCOMMAND,
    &levels::SUBCOMMAND,
    &config::SUBCOMMAND,
    &replay::SUBCOMMAND,
    &about::COMPLETIONS,
    &about::MAN,
    &about::HELP,
];

/// The description of a subcommand.
struct Subcommand {
    name: &'static str,
    /// The action in one line.
    about: &'static str,
    /// More for the long help; may be empty.
    details: &'static str,
    /// One command on each line.
    examples: &'static str,
    positionals: &'static [Positional],
    options: &'static [&'static dyn OptionSpec],
    /// The arguments that it takes, for the sentence about a surplus word.
    surplus: &'static str,
    /// The sentence about a missing required argument; empty if none is required.
    missing: &'static str,
    read: fn(ArgMatches) -> Result<Command, Error>,
}

/// A positional argument.
struct Positional {
    name: &'static str,
    help: &'static str,
    is_required: bool,
    action: ArgAction,
    hint: ValueHint,
    /// The possible values, if they are a fixed list.
    choices: &'static [&'static str],
}

/// The names of the subcommands.
pub(crate) fn subcommand_names() -> impl Iterator<Item = &'static str> {
    SUBCOMMANDS.iter().map(|subcommand| subcommand.name)
}

fn named(name: &str) -> Option<&'static Subcommand> {
    SUBCOMMANDS.iter().copied().find(|subcommand| subcommand.name == name)
}

/// The whole program, for clap.
pub(crate) fn description() -> clap::Command {
    let play = &play::SUBCOMMAND;
    clap::Command::new("cellcaster")
        .about("A raycaster game in the terminal, and its pictures in scripts")
        .long_about(help::about())
        .after_help(help::WHERE_TO_READ_ON)
        .after_long_help(help::more())
        .version(env!("CARGO_PKG_VERSION"))
        .args(play.arguments())
        .arg(help_flag())
        .arg(
            Arg::new("version")
                .short('V')
                .long("version")
                .help("Print the version")
                .action(ArgAction::Version),
        )
        .subcommands(SUBCOMMANDS.iter().map(|subcommand| subcommand.description()))
        .args_conflicts_with_subcommands(true)
        .args_override_self(true)
        .disable_help_flag(true)
        .disable_version_flag(true)
        .disable_help_subcommand(true)
        .max_term_width(help::WIDTH)
}

fn help_flag() -> Arg {
    Arg::new("help")
        .short('h')
        .long("help")
        .help("Explain in brief (-h), or at length (--help)")
        .action(ArgAction::Help)
}

impl Subcommand {
    fn description(&self) -> clap::Command {
        let command = clap::Command::new(self.name)
            .about(self.about)
            .args(self.arguments())
            .arg(help_flag())
            .args_override_self(true)
            .disable_help_flag(true)
            .after_long_help(help::examples(self));
        match self.details {
            "" => command,
            details => command.long_about(format!("{}\n\n{details}", self.about)),
        }
    }

    fn arguments(&self) -> impl Iterator<Item = Arg> {
        let positionals = self.positionals.iter().map(Positional::argument);
        positionals.chain(self.options.iter().map(|option| option.argument()))
    }

    /// The option of this name, with dashes.
    fn option(&self, name: &str) -> Option<&'static dyn OptionSpec> {
        let name = name.strip_prefix("--")?;
        self.options.iter().copied().find(|option| option.name() == name)
    }
}

impl Positional {
    fn argument(&self) -> Arg {
        let argument = Arg::new(self.name)
            .help(self.help)
            .required(self.is_required)
            .action(self.action.clone())
            .value_hint(self.hint);
        match self.choices {
            [] => argument.value_parser(value_parser!(OsString)),
            choices => {
                argument.value_parser(PossibleValuesParser::new(choices).map(OsString::from))
            }
        }
    }

    /// The given value.
    fn of(&self, matches: &mut ArgMatches) -> Option<OsString> {
        matches.remove_one(self.name)
    }
}
