//! One sentence for each mistake in the arguments.
//!
//! clap's own messages were refused: they include the usage, and omit the valid values of an
//! option.

use clap::error::{ContextKind, ContextValue, ErrorKind};

use super::{Error, SUBCOMMANDS, Subcommand};
use crate::fault;

/// A sentence about the mistake in the arguments of `subcommand`.
pub(crate) fn of(error: &clap::Error, subcommand: &Subcommand) -> Error {
    if let Some(sentence) = text(error, ContextKind::Custom) {
        return Error::mistake(sentence);
    }
    let argument = text(error, ContextKind::InvalidArg)
        .or_else(|| text(error, ContextKind::InvalidSubcommand))
        .unwrap_or_default();
    // A known option includes its value, as in "--fov <DEG>".
    let known = argument.split_once(' ').map_or(argument, |(name, _)| name);
    Error::mistake(match error.kind() {
        ErrorKind::MissingRequiredArgument => subcommand.missing.to_owned(),
        ErrorKind::InvalidValue => match subcommand.option(known) {
            Some(option) => {
                let takes = option.takes().unwrap_or("no value");
                format!("{known} takes {takes}, and nothing follows it")
            }
            None => no_choice(error, subcommand),
        },
        ErrorKind::TooManyValues => {
            let value = text(error, ContextKind::InvalidValue).unwrap_or_default();
            format!("{known} takes no value, and \"{value}\" is one")
        }
        ErrorKind::UnknownArgument | ErrorKind::InvalidSubcommand | ErrorKind::ArgumentConflict => {
            unknown(argument, subcommand)
        }
        _ => first_line(error),
    })
}

fn unknown(argument: &str, subcommand: &Subcommand) -> String {
    let Subcommand { name, surplus, .. } = subcommand;
    let is_option = argument.len() > 1 && argument.starts_with('-');
    if !is_option {
        let hint = match SUBCOMMANDS.iter().find(|subcommand| subcommand.name == argument) {
            Some(_) => format!("a command goes first, as in \"cellcaster {argument} ...\""),
            None => help(Some(name)),
        };
        return format!("{name} {surplus}, and \"{argument}\" is one too many; {hint}");
    }
    let options: Vec<String> =
        subcommand.options.iter().map(|option| format!("--{}", option.name())).collect();
    let options: Vec<&str> = options.iter().map(String::as_str).chain(["--help"]).collect();
    let hint = match fault::nearest(argument, &options) {
        Some(meant) => format!("did you mean {meant}?"),
        None => help(Some(name)),
    };
    format!("{name} has no option {argument}; {hint}")
}

/// The mistake for a positional argument that is not among the choices.
fn no_choice(error: &clap::Error, subcommand: &Subcommand) -> String {
    let choices = match error.get(ContextKind::ValidValue) {
        Some(ContextValue::Strings(choices)) => choices.join(", "),
        _ => "another value".to_owned(),
    };
    let value = text(error, ContextKind::InvalidValue).unwrap_or_default();
    format!("{} takes one of {choices}, not \"{value}\"", subcommand.name)
}

/// The mistake for an unknown command.
pub(crate) fn no_command(name: &str) -> Error {
    let names: Vec<&str> = SUBCOMMANDS.iter().map(|subcommand| subcommand.name).collect();
    let hint = match fault::nearest(name, &names) {
        Some(meant) => format!("did you mean {meant}?"),
        None => help(None),
    };
    Error::mistake(format!("there is no command \"{name}\"; {hint}"))
}

/// A reference to the help.
fn help(name: Option<&str>) -> String {
    let words: Vec<&str> = ["cellcaster"].into_iter().chain(name).chain(["--help"]).collect();
    format!("\"{}\" lists what there is", words.join(" "))
}

fn text(error: &clap::Error, kind: ContextKind) -> Option<&str> {
    match error.get(kind)? {
        ContextValue::String(text) => Some(text),
        _ => None,
    }
}

/// clap's own message without the usage, for any other mistake.
fn first_line(error: &clap::Error) -> String {
    let text = error.to_string();
    let line = text.lines().next().unwrap_or_default();
    line.strip_prefix("error: ").unwrap_or(line).to_owned()
}
