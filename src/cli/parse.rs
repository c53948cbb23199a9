//! Argument parsing for programs that use clap's derive macro, with one sentence for each user
//! error.
//!
//! Options may precede the command: `cellcaster --colors 256 snapshot` means `cellcaster snapshot
//! --colors 256`. Plain clap would make them options of the program, which every command would then
//! accept.
//!
//! Rejected: clap's own messages. They include the usage, and omit the valid values of an option.

use std::error::Error as _;
use std::ffi::OsString;
use std::fmt;
use std::io::{self, Write};

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Command, Parser};

use super::Error;
use crate::fault::nearest;

/// The valid values of an option, as the rest of the sentence `--option takes …`.
///
/// Value parsers return it as their error, so the sentence about an invalid value says what to
/// write instead.
#[derive(Clone, Copy, Debug)]
pub struct ValidValues(pub &'static str);

impl fmt::Display for ValidValues {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "it takes {}", self.0)
    }
}

impl std::error::Error for ValidValues {}

/// Parses `words`, which begin with the name of this program. If the words ask for the help or the
/// version, writes that and returns `None`.
///
/// # Errors
/// One sentence about the first error.
pub fn parse<P: Parser>(words: impl IntoIterator<Item = OsString>) -> Result<Option<P>, Error> {
    let program = lenient(P::command());
    let mut words = command_first(&program, words.into_iter().collect());
    if words.get(1).is_some_and(|word| word == "help") {
        // clap's `help` command has no help about itself.
        words.retain(|word| word != "--help" && word != "-h");
    }
    let matches = program.clone().try_get_matches_from(&words);
    match matches.and_then(|matches| P::from_arg_matches(&matches)) {
        Ok(arguments) => Ok(Some(arguments)),
        Err(error)
            if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) =>
        {
            write!(io::stdout(), "{error}").map_err(|error| Error::of_output(&error))?;
            Ok(None)
        }
        Err(error) => Err(Error::mistake(sentence(&error, &program, &words))),
    }
}

/// Makes the command and its subcommands accept option values such as `-1`. If an option is
/// repeated, the last one counts.
fn lenient(command: Command) -> Command {
    command
        .args_override_self(true)
        .arg_required_else_help(false)
        .mut_args(|argument| {
            let takes_value = argument.get_long().is_some() && argument.get_action().takes_values();
            if takes_value { argument.allow_hyphen_values(true) } else { argument }
        })
        .mut_subcommands(lenient)
}

/// Moves the command directly after the program's name, if only options precede it.
fn command_first(program: &Command, mut words: Vec<OsString>) -> Vec<OsString> {
    let mut index = 1;
    while let Some(word) = words.get(index).and_then(|word| word.to_str()) {
        if program.find_subcommand(word).is_some() {
            let name = words.remove(index);
            words.insert(1, name);
            break;
        }
        if !word.starts_with('-') || ["-", "--", "-V", "--version"].contains(&word) {
            break;
        }
        index += if takes_the_next_word(program, word) { 2 } else { 1 };
    }
    words
}

/// Returns true if `word` is an option of any command and its value is the next word.
fn takes_the_next_word(program: &Command, word: &str) -> bool {
    let mut options =
        program.get_arguments().chain(program.get_subcommands().flat_map(Command::get_arguments));
    word.strip_prefix("--").is_some_and(|name| {
        options.any(|it| it.get_long() == Some(name) && it.get_action().takes_values())
    })
}

fn sentence(error: &clap::Error, program: &Command, words: &[OsString]) -> String {
    let (mut path, mut command) = (program.get_name().to_owned(), program);
    for name in words.iter().skip(1).filter_map(|word| word.to_str()) {
        if let Some(subcommand) = command.find_subcommand(name) {
            path = format!("{path} {name}");
            command = subcommand;
        }
    }
    let command_name = command.get_name();
    let argument = [ContextKind::InvalidArg, ContextKind::InvalidSubcommand]
        .iter()
        .find_map(|&kind| text(error, kind))
        .unwrap_or_default();
    let name = name_of(argument);
    let value = text(error, ContextKind::InvalidValue).unwrap_or_default();
    let help = format!("see \"{path} --help\"");
    let or_help = |names: &[&str]| {
        nearest(name, names).map_or(help.clone(), |meant| format!("did you mean {meant}?"))
    };
    let surplus = |argument: &str| {
        let end = match program.find_subcommand(argument) {
            Some(_) => {
                format!("a command goes first, as in \"{} {argument} ...\"", program.get_name())
            }
            None => help.clone(),
        };
        format!("\"{argument}\" is one argument too many; {end}")
    };
    match error.kind() {
        ErrorKind::ValueValidation => match error.source() {
            Some(reason) => match reason.downcast_ref::<ValidValues>() {
                Some(ValidValues(values)) => format!("{name} takes {values}, not \"{value}\""),
                None => format!("{name} {value}: {reason}"),
            },
            None => first_line(error),
        },
        ErrorKind::InvalidValue => {
            let choices = match texts(error, ContextKind::ValidValue) {
                [] => argument.split_once(' ').map_or("a value", |(_, value)| value).to_owned(),
                choices => one_of(choices),
            };
            if value.is_empty() {
                format!("{name} needs a value: {choices}")
            } else {
                format!("{name} takes {choices}, not \"{value}\"")
            }
        }
        ErrorKind::UnknownArgument if argument.len() > 1 && argument.starts_with('-') => {
            let options = command.get_arguments().filter_map(|it| it.get_long());
            let options: Vec<String> = options.map(|name| format!("--{name}")).collect();
            let options: Vec<&str> = options.iter().map(String::as_str).chain(["--help"]).collect();
            format!("unknown option {argument} for {command_name}; {}", or_help(&options))
        }
        ErrorKind::InvalidSubcommand => {
            let names: Vec<&str> = command.get_subcommands().map(Command::get_name).collect();
            format!("\"{argument}\" is not a command; {}", or_help(&names))
        }
        ErrorKind::UnknownArgument => surplus(argument),
        ErrorKind::ArgumentConflict if text(error, ContextKind::InvalidSubcommand).is_some() => {
            surplus(argument)
        }
        ErrorKind::MissingSubcommand => {
            let commands = texts(error, ContextKind::ValidSubcommand).join(", ");
            format!("{argument} takes one of {commands}")
        }
        ErrorKind::MissingRequiredArgument => {
            let missing = texts(error, ContextKind::InvalidArg).join(" and ");
            format!("{command_name} needs {missing}; {help}")
        }
        ErrorKind::ArgumentConflict => {
            let others = texts(error, ContextKind::PriorArg).iter().map(String::as_str);
            let others = others.chain(text(error, ContextKind::PriorArg)).map(name_of);
            let others = others.collect::<Vec<_>>().join(" and ");
            format!("{name} cannot be combined with {others}: leave one of them out")
        }
        ErrorKind::TooManyValues => format!("{name} takes no value: leave out \"{value}\""),
        _ => first_line(error),
    }
}

/// The name of an argument without its value, as in `--fov <DEG>`, and without brackets, as in
/// `[MAP]`.
fn name_of(argument: &str) -> &str {
    let name = argument.split_once(' ').map_or(argument, |(name, _)| name);
    name.trim_matches(['[', ']', '<', '>'])
}

/// Joins the choices, as in "a, b or c".
fn one_of(choices: &[String]) -> String {
    match choices {
        [first @ .., last] if !first.is_empty() => format!("{} or {last}", first.join(", ")),
        _ => choices.concat(),
    }
}

fn text(error: &clap::Error, kind: ContextKind) -> Option<&str> {
    match error.get(kind)? {
        ContextValue::String(text) => Some(text),
        _ => None,
    }
}

fn texts(error: &clap::Error, kind: ContextKind) -> &[String] {
    match error.get(kind) {
        Some(ContextValue::Strings(texts)) => texts,
        _ => &[],
    }
}

/// The first line of clap's own message, without the usage, for any other error.
fn first_line(error: &clap::Error) -> String {
    let text = error.to_string();
    let line = text.lines().next().unwrap_or_default();
    line.strip_prefix("error: ").unwrap_or(line).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn only_options_may_stand_before_the_command() {
        let program = crate::cli::Arguments::command();
        for (line, expected) in [
            ("c", "c"),
            ("c snapshot --fov 9", "c snapshot --fov 9"),
            ("c --fov 9 snapshot m", "c snapshot --fov 9 m"),
            ("c --fov=9 --explain snapshot", "c snapshot --fov=9 --explain"),
            ("c -h check", "c check -h"),
            ("c --record cast cast", "c cast --record cast"),
            ("c --fov snapshot", "c --fov snapshot"),
            ("c m snapshot", "c m snapshot"),
            ("c - snapshot", "c - snapshot"),
            ("c -- snapshot", "c -- snapshot"),
            ("c -V snapshot", "c -V snapshot"),
        ] {
            let words = line.split(' ').map(OsString::from).collect();
            let words: Vec<OsString> = command_first(&program, words);
            assert_eq!(words.join(" ".as_ref()), expected, "{line}");
        }
    }
}
