//! Parsing for programs whose arguments are described by clap's derive macro, with one sentence for each mistake.
//!
//! Rejected: clap's own messages. They include the usage, and omit the valid values of an option.

use std::error::Error as _;
use std::ffi::OsString;
use std::fmt;
use std::io::{self, Write};

use clap::Parser;
use clap::error::{ContextKind, ContextValue, ErrorKind};

use super::Error;
use crate::fault::nearest;

/// The valid values of an option, as the rest of the sentence `--option takes …`.
///
/// Parsers of values return it, so that the sentence about an invalid value says what to write instead.
#[derive(Clone, Copy, Debug)]
pub struct Takes(pub &'static str);

impl fmt::Display for Takes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "it takes {}", self.0)
    }
}

impl std::error::Error for Takes {}

/// The arguments `words`, the first of which is the program's own name. Writes the help or the version and returns `None`
/// where these are requested.
///
/// # Errors
/// One sentence about the first mistake.
pub fn parse<P: Parser>(words: impl IntoIterator<Item = OsString>) -> Result<Option<P>, Error> {
    let matches = lenient(P::command()).try_get_matches_from(words);
    match matches.and_then(|matches| P::from_arg_matches(&matches)) {
        Ok(arguments) => Ok(Some(arguments)),
        Err(error)
            if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) =>
        {
            write!(io::stdout(), "{error}").map_err(|error| Error::of_output(&error))?;
            Ok(None)
        }
        Err(error) => Err(Error::mistake(sentence::<P>(&error))),
    }
}

/// The command, and its subcommands, with options that take values such as `-1`, and of which the last one counts.
fn lenient(command: clap::Command) -> clap::Command {
    command
        .args_override_self(true)
        .arg_required_else_help(false)
        .mut_args(|argument| {
            let takes_value = argument.get_long().is_some() && argument.get_action().takes_values();
            if takes_value { argument.allow_hyphen_values(true) } else { argument }
        })
        .mut_subcommands(lenient)
}

fn sentence<P: Parser>(error: &clap::Error) -> String {
    let argument = text(error, ContextKind::InvalidArg)
        .or_else(|| text(error, ContextKind::InvalidSubcommand))
        .unwrap_or_default();
    // A known option includes its value, as in "--fov <DEG>".
    let name = argument.split_once(' ').map_or(argument, |(name, _)| name);
    let value = text(error, ContextKind::InvalidValue).unwrap_or_default();
    let help = format!("\"{} --help\" lists what there is", P::command().get_name());
    match error.kind() {
        ErrorKind::ValueValidation => match error.source() {
            Some(reason) => match reason.downcast_ref::<Takes>() {
                Some(Takes(values)) => format!("{name} takes {values}, not \"{value}\""),
                None => format!("{name} {value}: {reason}"),
            },
            None => first_line(error),
        },
        ErrorKind::InvalidValue => {
            let choices = match error.get(ContextKind::ValidValue) {
                Some(ContextValue::Strings(choices)) if !choices.is_empty() => one_of(choices),
                _ => argument.split_once(' ').map_or("a value", |(_, value)| value).to_owned(),
            };
            if value.is_empty() {
                format!("{name} takes {choices}, and nothing follows it")
            } else {
                format!("{name} takes {choices}, not \"{value}\"")
            }
        }
        ErrorKind::UnknownArgument | ErrorKind::InvalidSubcommand => {
            let names = names(&P::command());
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let end = nearest(name, &names).map_or(help, |meant| format!("did you mean {meant}?"));
            if argument.starts_with('-') {
                format!("there is no option {argument}; {end}")
            } else {
                format!("\"{argument}\" is no command, and one argument too many; {end}")
            }
        }
        ErrorKind::MissingSubcommand => match error.get(ContextKind::ValidSubcommand) {
            Some(ContextValue::Strings(names)) => {
                format!("{argument} takes one of {}", names.join(", "))
            }
            _ => format!("a command is missing; {help}"),
        },
        ErrorKind::MissingRequiredArgument => {
            let missing = match error.get(ContextKind::InvalidArg) {
                Some(ContextValue::Strings(names)) => names.join(" and "),
                _ => "a command".to_owned(),
            };
            format!("{missing} is missing; {help}")
        }
        ErrorKind::ArgumentConflict => {
            let other = match error.get(ContextKind::PriorArg) {
                Some(ContextValue::String(name)) => name.clone(),
                Some(ContextValue::Strings(names)) => names.join(" and "),
                _ => "another argument".to_owned(),
            };
            format!("{name} goes without {other}")
        }
        ErrorKind::TooManyValues => format!("{name} takes no value, and \"{value}\" is one"),
        _ => first_line(error),
    }
}

/// The choices, as in "a, b or c".
fn one_of(choices: &[String]) -> String {
    match choices {
        [first @ .., last] if !first.is_empty() => format!("{} or {last}", first.join(", ")),
        _ => choices.concat(),
    }
}

/// The options of a command and its subcommands, and the subcommands' names.
fn names(command: &clap::Command) -> Vec<String> {
    let options = command.get_arguments().filter_map(|it| it.get_long());
    let mut names: Vec<String> = options.map(|name| format!("--{name}")).collect();
    for subcommand in command.get_subcommands() {
        names.push(subcommand.get_name().to_owned());
        names.extend(self::names(subcommand));
    }
    names
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
